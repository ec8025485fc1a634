// Output of the program itself: values and greetings on standard output, errors on standard error.
#pragma once

#include <string>
#include <string_view>

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

}  // namespace dinal::prompt
