// Comma separated values: our own files read back exactly, those of others are read when they can be understood.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/file.hpp"
#include "files/table.hpp"
#include "text/expected.hpp"

namespace dinal::files {

/// Lines that begin with # are comments and blank lines are skipped. The separator (semicolon, comma, tab or blanks) is
/// taken from the first row of numbers. A line of names may stand before the rows; without one the names are "1", "2",
/// ... Every row must have a finite number in every column. Errors name the file and the line.
text::Expected<Table> read_csv(const std::string& path);

/// The same of a text in memory; `name` stands for the file in errors.
text::Expected<Table> parse_csv(std::string_view text, const std::string& name);

/// Comments (each line behind "# "), the line of names, the rows. read_csv gives back the same bits.
text::Expected<Written> write_csv(const std::string& path, std::span<const NamedColumn> columns,
                                  std::span<const std::string> comments = {});
text::Expected<Written> write_csv(const std::string& path, const Table& table);

}  // namespace dinal::files
