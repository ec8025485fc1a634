// What Lua's own error messages say. They are Lua's words and bring no facts, so they are taken apart: here, and
// nowhere else. What dinal says itself has its facts beside it (text::Error) and is never looked into.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace dinal::lua {

/// About a chunk that ran: "attempt to call a nil value (global 'sytem')".
struct LuaMessage {
    std::string_view words;
    std::string_view type = {};  ///< of the value that stood in the way: "nil"
    std::string_view kind =
        {};  ///< of the variable that had it: "global", "local", "field", "method", "for iterator" ...
    std::string_view name = {};                 ///< and its name: "sytem"
    std::vector<std::string_view> quoted = {};  ///< all that stands in quotes
    bool calls = false;                         ///< "attempt to call"
    bool calculates = false;                    ///< "attempt to perform arithmetic on"
    bool adds_texts = false;                    ///< "attempt to add a 'string' with a 'number'"
    bool misses_a_value = false;                ///< some nil that has no name here: "(number expected, got nil)"
};
LuaMessage running_message(std::string_view words);

/// About a chunk that does not compile: "'}' expected (to close '{' at line 1) near 'print'".
struct SyntaxMessage {
    std::string_view complaint;      ///< "'}' expected", "unexpected symbol"
    std::string_view expected = {};  ///< "}", when that alone may go on there
    std::string_view near = {};      ///< "print"; "<eof>" at the end
    std::string_view opened = {};    ///< "{", when the message says what is to be closed
    int opened_line = 0;
};
/// None for other words.
std::optional<SyntaxMessage> syntax_message(std::string_view words);

/// A coroutine.yield where there is a C++ function between it and its resume.
bool is_about_yield(std::string_view message);

/// The chunk ended too early: more lines may complete it, or those of a string in it.
bool is_about_end(std::string_view message);
bool is_about_unfinished_string(std::string_view message);

/// The chunk is bytecode, and that is not allowed, or of another Lua.
bool is_about_forbidden_bytecode(std::string_view message);
bool is_about_foreign_bytecode(std::string_view message);

}  // namespace dinal::lua
