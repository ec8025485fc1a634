#include <algorithm>

#include "files/csv.hpp"
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

}  // namespace

text::Expected<Written> write_csv(const std::string& path, std::span<const NamedColumn> columns,
                                  std::span<const std::string> comments, Gaps gaps) {
    const auto head = [&](OutputFile& file) {
        for (const std::string& comment : comments) write_comment(file, comment);
        for (std::size_t i = 0; i < columns.size(); ++i) {
            file.write((i == 0 ? "" : ",") + field_of(columns[i].name));
        }
        file.write("\n");
    };
    return write_rows(path, columns, ',', head, gaps);
}

}  // namespace dinal::files
