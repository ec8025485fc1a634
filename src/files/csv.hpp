// Comma separated values: our own files read back exactly, those of strangers are read when they can be understood.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/file.hpp"
#include "files/table.hpp"
#include "text/expected.hpp"

namespace dinal::files {

/// A column is of numbers when every field of it is one, or empty (nan), or "nan", "inf"; else of words.
struct ReadColumn {
    std::string name;
    std::vector<double> numbers;
    std::vector<std::string> words;
    bool of_words = false;
    std::string unit = {};
    std::string fault = {};  ///< about the first field that is no finite number: "run.csv:3: column 2 is empty"
};
struct ReadColumns {
    std::vector<ReadColumn> columns;  ///< of one length, each name once
    std::vector<std::string> comments;
    std::size_t cut = 0;  ///< the number of the last line, where it ends in the middle and is left out; else 0
};

/// What a user says of a file that others have written.
struct ReadOptions {
    int skip = 0;                         ///< lines before the names
    std::vector<std::string> names = {};  ///< of the columns, instead of those in the file
};

/// Lines that begin with # are comments and blank lines are skipped. The separator (semicolon, comma, tab or blanks) is
/// taken from the second line; with semicolons a decimal comma is one. The first line has the names unless it has a
/// number: then they are "1", "2", ... Where words stand under the names and numbers only in all lines below them, the
/// words are the units. A number in quotes may have a decimal comma. A last line without its end and with too few
/// fields was cut off, and is left out. Errors name the file and the line.
text::Expected<ReadColumns> read_columns(const std::string& path, const ReadOptions& options = {});

/// The same of a text in memory; `name` stands for the file in errors.
text::Expected<ReadColumns> parse_columns(std::string_view text, const std::string& name,
                                          const ReadOptions& options = {});

/// Fails where a field is no finite number.
text::Expected<Table> table_of(ReadColumns content);

/// Comments (each line behind "# "), the line of names, the rows. read_columns gives back the same bits.
text::Expected<Written> write_csv(const std::string& path, std::span<const NamedColumn> columns,
                                  std::span<const std::string> comments = {}, Gaps gaps = Gaps::refused);

// Columns of numbers as lines of text, for the writers of this folder.

/// A whole file: what `head` writes, then one line for each row, the shortest text of each number that reads back as
/// the same double, `separator` between. Fails when columns differ in length, or hold a gap that is refused.
text::Expected<Written> write_rows(const std::string& path, std::span<const NamedColumn> columns, char separator,
                                   const std::function<void(OutputFile&)>& head, Gaps gaps = Gaps::refused);

/// A word that reads back as the same word, and not as a number or a comment.
std::string field_of(std::string_view word);

}  // namespace dinal::files
