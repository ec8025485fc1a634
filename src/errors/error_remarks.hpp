// Additions to an error message: the source line with a mark, a likely spelling, and the time at which M was evaluated.
// Uses the stored facts of dinal's errors, parses Lua's messages, and finds their chunk, line and statement.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lua/error_memory.hpp"
#include "lua/lua_headers.hpp"

namespace dinal::errors {

/// The parts of "lab.lua:10: what happened".
struct Message {
    std::string_view chunk;  ///< "lab.lua"
    int line = 0;
    std::string_view words;  ///< "what happened"
};
std::optional<Message> parse_message(std::string_view message);

/// Finds the innermost function on the call stack of `L` at that line of that chunk; returns false if there is none.
bool find_frame(lua_State* L, const Message& message, lua_Debug& frame);

/// Part of a chunk, whose first line has the number `first_line`.
struct SourceText {
    std::string text;
    int first_line = 1;

    /// The line of that number without its newline; empty if it does not exist.
    std::string_view line(int number) const;
    /// The text from the beginning of that line until its brackets are closed.
    std::string_view statement(int number) const;
};

/// The text of the frame's chunk, or at least of its function.
std::optional<SourceText> source_of_frame(lua_State* L, lua_Debug& frame);

std::optional<SourceText> source_of_file(const std::string& path);

/// The last text kept under that name: from -e, standard input, the prompt.
std::optional<SourceText> source_kept(lua_State* L, std::string_view chunk);

/// The text of the file of that name, provided that a function in it is running; reads no other file.
std::optional<SourceText> source_running(lua_State* L, std::string_view chunk);

/// The remarks on the error value at `index`. Call in a message handler, while the functions of the error are still on
/// the stack; afterwards parts are missing.
lua::Remarks remarks_on(lua_State* L, int index);

/// The remarks on the message at `index` about a chunk that did not compile. `file` is its name, or nullptr.
lua::Remarks remarks_on_syntax(lua_State* L, int index, const char* file);

/// The witness of errors in M, called once for each error value at `error`. For a message about a function's result,
/// `function` is the index of that function, otherwise 0.
lua::Remarks first_remarks(lua_State* L, int error, int function);

}  // namespace dinal::errors
