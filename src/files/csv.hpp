// Named columns of numbers, and their files of comma-separated values: own files are read back exactly, others as far
// as they can be understood.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/file.hpp"
#include "text/expected.hpp"

namespace dinal::files {

struct Table {
    std::vector<std::string> names;     ///< one for each column of `values`
    Eigen::MatrixXd values;             ///< column-major: a column is contiguous
    std::vector<std::string> comments;  ///< lines without comment signs
};

/// A view of a column to be written: its words, or otherwise its numbers.
struct NamedColumn {
    std::string_view name;
    std::span<const double> values = {};
    std::span<const std::string> words = {};
};

/// The treatment of nan (an empty field) and infinity.
enum class Gaps { refused, written };

/// All columns of a matrix in order, from which the caller may select.
std::vector<NamedColumn> named_columns(const std::vector<std::string>& names,
                                       const Eigen::Ref<const Eigen::MatrixXd>& values);

/// The index of the only name that is this one followed by a unit in brackets: "t (s)" or "t [s]" for "t".
std::optional<std::size_t> place_without_unit(std::span<const std::string> names, std::string_view name);

/// The index (from 0) of the column with that name, with or without its unit, or number (from 1).
/// Fails with the list of columns, and a suggestion if one has a similar name.
text::Expected<Eigen::Index> find_column(std::span<const std::string> names, std::string_view name);
text::Expected<Eigen::Index> find_column(std::span<const std::string> names, std::int64_t number);

/// A column is numeric if every field is a number, empty (nan), "nan" or "inf"; otherwise it has words.
struct ReadColumn {
    std::string name;
    std::vector<double> numbers;
    std::vector<std::string> words;
    bool of_words = false;
    std::string unit = {};
    std::string fault = {};  ///< describes the first field that is not a finite number: "run.csv:3: column 2 is empty"
};
struct ReadColumns {
    std::vector<ReadColumn> columns;  ///< of equal length, with unique names
    std::vector<std::string> comments;
    std::size_t cut = 0;  ///< number of an incomplete last line that was dropped; otherwise 0
};

/// A user's instructions for reading a foreign file.
struct ReadOptions {
    int skip = 0;                         ///< lines to skip before the names
    std::vector<std::string> names = {};  ///< column names that replace those in the file
};

/// Lines beginning with # are comments; blank lines are skipped. The second line determines the separator (semicolon,
/// comma, tab or blanks); with semicolons, commas are decimal. The first line has the names unless it contains a
/// number: then they are "1", "2", ... Words under the names are units if all lines below have numbers only. A quoted
/// number may have a decimal comma. An incomplete last line with too few fields is dropped. Errors name the file and
/// the line.
text::Expected<ReadColumns> read_columns(const std::string& path, const ReadOptions& options = {});

/// The same for text in memory; errors use `name` as the file.
text::Expected<ReadColumns> parse_columns(std::string_view text, const std::string& name,
                                          const ReadOptions& options = {});

/// Fails if a field is not a finite number.
text::Expected<Table> table_of(ReadColumns content);

/// Writes comments (each line after "# "), the line of names, and the rows. read_columns restores the same bits.
text::Expected<Written> write_csv(const std::string& path, std::span<const NamedColumn> columns,
                                  std::span<const std::string> comments = {}, Gaps gaps = Gaps::refused);

// Columns of numbers as text, for the writers of this folder.

/// Writes a whole file: the output of `head`, followed by a line for each row with the shortest texts that read back
/// exactly, joined by `separator`. Fails if columns differ in length or contain a refused gap.
text::Expected<Written> write_rows(const std::string& path, std::span<const NamedColumn> columns, char separator,
                                   const std::function<void(OutputFile&)>& head, Gaps gaps = Gaps::refused);

/// A word as a field that reads back as the same word, rather than as a number or comment.
std::string field_of(std::string_view word);

// Lines and numbers of a text file, for the readers of this folder.

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
std::string quoted_for_message(std::string_view field);

/// The fault of a field refused by parse_number: "'abc' is not a number", "is empty", ...
std::string number_fault(std::string_view field);

}  // namespace dinal::files
