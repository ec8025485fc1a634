// Lines and numbers of a text file, for the readers of this folder.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "text/expected.hpp"

namespace dinal::files {

/// Walks over the lines of a text: line ends are LF, CRLF or a lone CR, and a UTF-8 byte order mark is skipped.
class Lines {
public:
    explicit Lines(std::string_view text);

    /// Goes to the next line; false at the end of the text, and when shall_stop() says so.
    bool next();
    [[nodiscard]] std::string_view text() const { return line_; }
    [[nodiscard]] std::size_t number() const { return number_; }

private:
    std::string_view rest_;
    std::string_view line_;
    std::size_t number_ = 0;
    bool has_lone_cr_;
};

/// The error at a place of a file: "run.csv:7: ...".
text::Error error_at(const std::string& file, std::size_t line, const std::string& what);

/// Why this cannot be a text file: the line of its first NUL byte (UTF-16 is full of them).
std::optional<text::Error> binary_fault(std::string_view text, const std::string& file);

/// A finite number that is all of the field, without blanks around; a leading + is allowed, nan and inf are not.
std::optional<double> parse_number(std::string_view field);

/// The same as Fortran writes it: 1.5D+00, 1.5d0, 1.5+300 too.
std::optional<double> parse_fortran_number(std::string_view field);

/// What is a number in a table of strangers: as parse_number, or double precision of Fortran with its decimal point and
/// its D (1.5D+00; 1-2 and 3d are none), or empty or "nan" (nan), or "inf"; with `decimal_comma` 1,5 is one, too.
std::optional<double> parse_field(std::string_view field, bool decimal_comma);

/// A field in quotes as it can stand in a sentence: short and printable.
std::string shown(std::string_view field);

/// What is wrong with a field that parse_number refused: "'abc' is not a number", "is empty", ...
std::string number_fault(std::string_view field);

}  // namespace dinal::files
