// Lines and numbers of a text file, for the readers of this folder.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "text/expected.hpp"

namespace dinal::files {

/// Iterates over the lines of a text: line ends are LF, CRLF or a lone CR, and a UTF-8 byte order mark is skipped.
class Lines {
public:
    explicit Lines(std::string_view text);

    /// Goes to the next line; returns false at the end of the text, and if shall_stop() returns true.
    bool next();
    std::string_view text() const { return line_; }
    std::size_t number() const { return number_; }

private:
    std::string_view rest_;
    std::string_view line_;
    std::size_t number_ = 0;
    bool has_lone_cr_;
};

/// The error at a place of a file: "run.csv:7: ...".
text::Error error_at(const std::string& file, std::size_t line, const std::string& what);

/// An error if this is not a text file: the line of its first NUL byte (UTF-16 has many).
std::optional<text::Error> binary_fault(std::string_view text, const std::string& file);

/// Parses a finite number that fills the field, without blanks; accepts a leading +, not nan or inf.
std::optional<double> parse_number(std::string_view field);

/// The same in Fortran's notation: also 1.5D+00, 1.5d0, 1.5+300.
std::optional<double> parse_fortran_number(std::string_view field);

/// Parses a field of a foreign table: as parse_number, or Fortran double precision with decimal point and D (1.5D+00,
/// but not 1-2 or 3d), or empty or "nan" (nan), or "inf"; with `decimal_comma` also 1,5.
std::optional<double> parse_field(std::string_view field, bool decimal_comma);

/// A field in quotes for a sentence: short and printable.
std::string shown(std::string_view field);

/// The fault of a field refused by parse_number: "'abc' is not a number", "is empty", ...
std::string number_fault(std::string_view field);

}  // namespace dinal::files
