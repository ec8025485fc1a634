// What the program itself says: values and greetings on standard output, errors on standard error.
#pragma once

#include <string>
#include <string_view>

namespace dinal::prompt {

/// Whether it arrives is asked once, at the end of the program (main.cpp).
void say(std::string_view text);
/// The same for what others have written, such as names in a file: on a terminal nothing in it steers that.
void say_value(std::string_view text);
void flush_output();

/// A line on standard error, after all that was said before.
void say_error(std::string_view text);

/// While it lives, what say_error() says goes into this text, as lines.
class ErrorsInto {
public:
    explicit ErrorsInto(std::string& text);
    ~ErrorsInto();
    ErrorsInto(const ErrorsInto&) = delete;
    ErrorsInto& operator=(const ErrorsInto&) = delete;
};

}  // namespace dinal::prompt
