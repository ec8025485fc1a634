#include "files/csv.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "files/text_input.hpp"
#include "files/write_rows.hpp"

namespace dinal::files {
namespace {

/// A comment may be a whole script: every line of it needs its own sign. A NUL would make the file unreadable.
void write_comment(OutputFile& file, std::string text) {
    std::replace(text.begin(), text.end(), '\0', ' ');
    if (text.empty()) {
        file.write("#\n");
    }
    for (Lines lines(text); lines.next();) {
        file.write(lines.text().empty() ? "#" : "# ");
        file.write(lines.text());
        file.write("\n");
    }
}

bool needs_quotes(std::string_view name) {
    return name.empty() || name.find_first_of(" \t,;\"#") != std::string_view::npos || parse_number(name).has_value();
}

void write_name(OutputFile& file, std::string_view name) {
    if (!needs_quotes(name)) {
        file.write(name);
        return;
    }
    file.write("\"");
    for (const char c : name) {
        file.write(c == '"' ? std::string_view("\"\"") : std::string_view(&c, 1));
    }
    file.write("\"");
}

std::optional<text::Error> unwritable_name(std::span<const NamedColumn> columns) {
    using namespace std::string_view_literals;
    for (const NamedColumn& column : columns) {
        if (column.name.find_first_of("\r\n\0"sv) != std::string_view::npos) {
            return text::Error{"the name of a column cannot hold a line end or a NUL byte"};
        }
    }
    return std::nullopt;
}

}  // namespace

text::Expected<Written> write_csv(const std::string& path, std::span<const NamedColumn> columns,
                                  std::span<const std::string> comments) {
    if (std::optional<text::Error> fault = unwritable_name(columns)) {
        return *fault;
    }
    return write_rows(path, columns, ',', [&](OutputFile& file) {
        for (const std::string& comment : comments) {
            write_comment(file, comment);
        }
        for (std::size_t i = 0; i < columns.size(); ++i) {
            file.write(i == 0 ? "" : ",");
            write_name(file, columns[i].name);
        }
        file.write("\n");
    });
}

text::Expected<Written> write_csv(const std::string& path, const Table& table) {
    return write_csv(path, named_columns(table.names, table.values), table.comments);
}

}  // namespace dinal::files
