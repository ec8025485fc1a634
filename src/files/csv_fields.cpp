#include "files/csv_fields.hpp"

#include <algorithm>

#include "text/words.hpp"

namespace dinal::files {
namespace {

/// The end of the field at the front of `line`: the place of the separator, or the length of the line.
std::size_t field_end(std::string_view line, Separator separator) {
    bool inside = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"') {
            inside = !inside;
        } else if (!inside && (c == static_cast<char>(separator) || (separator == Separator::blanks && c == '\t'))) {
            return i;
        }
    }
    return line.size();
}

}  // namespace

std::optional<Separator> separator_in(std::string_view line) {
    std::string bare;
    bool inside = false;
    for (const char c : text::trimmed(line)) {
        inside = inside != (c == '"');
        if (!inside) {
            bare += c;
        }
    }
    for (const Separator candidate : {Separator::semicolon, Separator::comma, Separator::tab, Separator::blanks}) {
        if (bare.find(static_cast<char>(candidate)) != std::string::npos) {
            return candidate;
        }
    }
    return std::nullopt;
}

void split(std::string_view line, Separator separator, std::vector<std::string_view>& fields) {
    fields.clear();
    if (separator == Separator::blanks) {
        line = text::trimmed(line);
    }
    for (;;) {
        const std::size_t end = field_end(line, separator);
        fields.push_back(text::trimmed(line.substr(0, end)));
        if (end == line.size()) {
            return;
        }
        line.remove_prefix(end + 1);
        if (separator == Separator::blanks) {
            line = text::trimmed(line);  // any number of them is one
        }
    }
}

bool is_left_open(std::string_view line) {
    const std::size_t last = line.rfind('"');
    if (last == std::string_view::npos || std::count(line.begin(), line.end(), '"') % 2 == 0) return false;
    constexpr std::string_view before_fields = ",; \t";
    return last == 0 || before_fields.find(line[last - 1]) != std::string_view::npos;
}

std::string name_in(std::string_view field, std::size_t number) {
    const bool quoted = field.size() >= 2 && field.front() == '"' && field.back() == '"';
    std::string name;
    bool pending = false;
    for (const char c : quoted ? field.substr(1, field.size() - 2) : field) {
        pending = quoted && c == '"' && !pending;
        if (!pending) {
            name += c;
        }
    }
    return name.empty() ? std::to_string(number) : name;
}

}  // namespace dinal::files
