// Comma separated values of strangers as columns of numbers or of words, with gaps; and such columns written.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/file.hpp"
#include "text/expected.hpp"

namespace dinal::files {

/// A column is of numbers when every field of it is one, or empty (nan), or "nan", "inf"; else of words.
struct ReadColumn {
    std::string name;
    std::vector<double> numbers;
    std::vector<std::string> words;
    bool of_words = false;
    std::string unit = {};
};
struct ReadColumns {
    std::vector<ReadColumn> columns;  ///< of one length, each name once
    std::vector<std::string> comments;
};

/// Lines that begin with # are comments and blank lines are skipped. The separator (semicolon, comma, tab or blanks) is
/// taken from the second line; with semicolons a decimal comma is one. The first line has the names unless it has a
/// number: then they are "1", "2", ... Where words stand under the names and numbers only in all lines below them, the
/// words are the units. Errors name the file and the line.
text::Expected<ReadColumns> read_columns(const std::string& path);

/// The same of a text in memory; `name` stands for the file in errors.
text::Expected<ReadColumns> parse_columns(std::string_view text, const std::string& name);

/// A column to be written: its words, or else its numbers. A nan is an empty field.
struct WordsOrNumbers {
    std::string_view name;
    std::span<const double> numbers = {};
    std::span<const std::string> words = {};
};

/// A line of names, and the columns, of one length. read_columns gives back the same. `comment` stands above them.
text::Expected<Written> write_columns(const std::string& path, std::span<const WordsOrNumbers> columns,
                                      std::string_view comment = "");

}  // namespace dinal::files
