// Columns of numbers as lines of text, for the writers of this folder.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "files/file.hpp"
#include "files/table.hpp"

namespace dinal::files {

/// A whole file: what `head` writes, then one line for each row, the shortest text of each number that reads back as
/// the same double, `separator` between. Fails when columns differ in length, or hold a gap that is refused.
text::Expected<Written> write_rows(const std::string& path, std::span<const NamedColumn> columns, char separator,
                                   const std::function<void(OutputFile&)>& head, Gaps gaps = Gaps::refused);

/// A word that reads back as the same word, and not as a number or a comment.
std::string field_of(std::string_view word);

}  // namespace dinal::files
