// Parses Lua's own error messages; nothing else does. Errors of dinal have their facts in text::Error and are never
// parsed.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace dinal::lua {

/// A run-time error: "attempt to call a nil value (global 'sytem')".
struct LuaMessage {
    std::string_view words;
    std::string_view type = {};  ///< type of the value at fault: "nil"
    std::string_view kind = {};  ///< kind of the variable: "global", "local", "field", "method", "for iterator" ...
    std::string_view name = {};  ///< the variable's name: "sytem"
    std::vector<std::string_view> quoted = {};  ///< all quoted parts
    bool calls = false;                         ///< "attempt to call"
    bool calculates = false;                    ///< "attempt to perform arithmetic on"
    bool misses_a_value = false;                ///< a nil without a name in the message: "(number expected, got nil)"
};
LuaMessage running_message(std::string_view words);

/// A syntax error: "'}' expected (to close '{' at line 1) near 'print'".
struct SyntaxMessage {
    std::string_view complaint;      ///< "'}' expected", "unexpected symbol"
    std::string_view expected = {};  ///< "}", if it is the only possibility
    std::string_view near = {};      ///< "print"; "<eof>" at the end
    std::string_view opened = {};    ///< "{", the bracket that is not closed, if known
    int opened_line = 0;
    std::string_view words = {};  ///< all of it
};
/// Empty for other messages.
std::optional<SyntaxMessage> syntax_message(std::string_view words);

/// Returns whether the message is about a coroutine.yield across a C++ function.
bool is_about_yield(std::string_view message);

/// Returns whether the chunk ended too early, so that more lines may complete it or a string in it.
bool is_about_end(std::string_view message);
bool is_about_unfinished_string(std::string_view message);

/// Returns whether the chunk is bytecode that is forbidden or of another Lua version.
bool is_about_forbidden_bytecode(std::string_view message);
bool is_about_foreign_bytecode(std::string_view message);

}  // namespace dinal::lua
