// The text around an error: which chunk it was in, which line, which statement.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"

namespace dinal::errors {

/// "lab.lua:10: what happened", taken apart.
struct Message {
    std::string_view chunk;  ///< "lab.lua"
    int line = 0;
    std::string_view words;  ///< "what happened"
};
std::optional<Message> parse_message(std::string_view message);

/// The function of the call stack of `L` that was at that line of that chunk, innermost first; false when none was.
bool find_frame(lua_State* L, const Message& message, lua_Debug& frame);

/// A piece of a chunk. Its first line has the number `first_line`.
struct SourceText {
    std::string text;
    int first_line = 1;

    /// The line of that number, without its newline; empty when it is not there.
    [[nodiscard]] std::string_view line(int number) const;
    /// From the beginning of that line to where its brackets are closed again.
    [[nodiscard]] std::string_view statement(int number) const;
};

/// The text of the chunk in which the frame runs, or at least of its function.
std::optional<SourceText> source_of_frame(lua_State* L, lua_Debug& frame);

std::optional<SourceText> source_of_file(const std::string& path);

/// The text that was kept last under that name: of -e, standard input, the prompt.
std::optional<SourceText> source_kept(lua_State* L, std::string_view chunk);

/// The text of the file of that name, if a function in it is running: no other is looked at.
std::optional<SourceText> source_running(lua_State* L, std::string_view chunk);

}  // namespace dinal::errors
