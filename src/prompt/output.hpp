// Output of the program itself: values and greetings on standard output, errors on standard error. The prompt shows
// plain numbers, quoted strings, short tables, objects as cards, and others by tostring.
#pragma once

#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"
#include "terminal/display.hpp"
#include "text/not_copied.hpp"

namespace dinal::prompt {

/// Write errors are checked once, at the end of the program (main.cpp).
void say(std::string_view text);
/// Like say(), for text from outside, such as names in a file: removes control sequences on a terminal.
void say_value(std::string_view text);
void flush_output();

/// Prints a line on standard error, after earlier output.
void say_error(std::string_view text);

/// While this object lives, the lines of say_error() are appended to this text.
class ErrorsInto : text::NotCopied {
public:
    explicit ErrorsInto(std::string& text);
    ~ErrorsInto();
};

/// The text for the value at `index`: a table on one line if it fits, otherwise on at most one screen. Reads tables
/// raw; the only user code that may run is __tostring, whose errors become part of the text. Requires call(): Ctrl-C is
/// a Lua error.
std::string show(lua_State* L, int index, const terminal::Display& screen);

/// The beginning of the text on one line of `width` columns.
std::string show_line(lua_State* L, int index, const terminal::Display& screen, std::size_t width);

}  // namespace dinal::prompt
