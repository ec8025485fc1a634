// Columns of numbers as lines of text, for the writers of this folder.
#pragma once

#include <optional>
#include <span>

#include "files/file.hpp"
#include "files/table.hpp"

namespace dinal::files {

/// One line for each row: the shortest text of each number that reads back as the same double, `separator` between.
/// Fails when columns differ in length or hold a nan or an infinity, which no reader of ours would take back.
std::optional<text::Error> write_rows(OutputFile& file, std::span<const NamedColumn> columns, char separator);

}  // namespace dinal::files
