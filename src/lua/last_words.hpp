// What is still said and done when a limit was reached: nobody may be there to read it.
#pragma once

#include <string_view>

namespace dinal::lua {

/// Writes on standard error as much as somebody takes in time.
void write_error_in_time(std::string_view text);

/// The end of the program: the files of the script are written to their ends, standard output if somebody takes it.
[[noreturn]] void exit_in_time(int code);

}  // namespace dinal::lua
