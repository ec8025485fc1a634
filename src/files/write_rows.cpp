#include "files/write_rows.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "files/text_input.hpp"

namespace dinal::files {
namespace {

constexpr std::size_t cell_size = 32;  // -2.2250738585072014e-308 and a separator take 25; a power of two copies fast

/// A column on its way down. Friction, a pulse or a stuck mass repeat a value over many rows: its text is kept then.
struct Cell {
    std::uint64_t bits = 0;  // of the value above; bits, because 0 and -0 are equal but not the same
    std::size_t length = 0;  // of the kept text; 0 until the value is met a second time
    char terminator = '\n';
    std::string_view gap = {};  // stands for a nan
    std::array<char, cell_size> text{};
};

std::size_t length_of(const NamedColumn& column) {
    return column.words.empty() ? column.values.size() : column.words.size();
}

std::optional<text::Error> unequal_lengths(std::span<const NamedColumn> columns) {
    for (const NamedColumn& column : columns) {
        if (length_of(column) != length_of(columns.front())) {
            return text::Error{"column '" + std::string(column.name) + "' has " + std::to_string(length_of(column)) +
                               " values, but '" + std::string(columns.front().name) + "' has " +
                               std::to_string(length_of(columns.front()))};
        }
    }
    return std::nullopt;
}

char* format(char* place, double value, const Cell& cell) {
    char* end = std::isnan(value) ? std::copy(cell.gap.begin(), cell.gap.end(), place)
                                  : std::to_chars(place, place + cell_size, value).ptr;
    *end++ = cell.terminator;
    return end;
}

/// Puts the text of a value; returns its end, or null when it is a gap that is refused.
char* put(char* place, double value, Cell& cell, Gaps gaps) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    if (bits != cell.bits) {
        cell.bits = bits;
        cell.length = 0;
        return std::isfinite(value) || gaps == Gaps::written ? format(place, value, cell) : nullptr;
    }
    if (cell.length == 0) {
        cell.length = static_cast<std::size_t>(format(cell.text.data(), value, cell) - cell.text.data());
    }
    std::memcpy(place, cell.text.data(), cell_size);  // all of it: a fixed size is two instructions
    return place + cell.length;
}

std::optional<text::Error> write_lines(OutputFile& file, std::span<const NamedColumn> columns, char separator,
                                       Gaps gaps) {
    if (columns.empty()) {
        return text::Error{"there are no columns to write"};
    }
    if (std::optional<text::Error> fault = unequal_lengths(columns)) {
        return fault;
    }
    const std::size_t rows = length_of(columns.front());
    std::vector<Cell> cells(columns.size());
    if (columns.size() == 1) cells.front().gap = "nan";  // an empty line would be no row
    for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
        cells[i].terminator = separator;
    }
    for (std::size_t row = 0; row < rows && !file.failed(); ++row) {
        char* place = file.room((columns.size() + 1) * cell_size);
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (!columns[i].words.empty()) {
                file.used(place);
                file.write(field_of(columns[i].words[row]) + cells[i].terminator);
                place = file.room((columns.size() + 1) * cell_size);
                continue;
            }
            const double value = columns[i].values[row];
            place = put(place, value, cells[i], gaps);
            if (place == nullptr) {
                return text::Error{"row " + std::to_string(row + 1) + " of column '" + std::string(columns[i].name) +
                                   "' is " + (std::isnan(value) ? "nan" : "infinite") +
                                   "; only finite numbers can be saved"};
            }
        }
        file.used(place);
    }
    return std::nullopt;
}

}  // namespace

text::Expected<Written> write_rows(const std::string& path, std::span<const NamedColumn> columns, char separator,
                                   const std::function<void(OutputFile&)>& head, Gaps gaps) {
    text::Expected<OutputFile> opened = OutputFile::create(path);
    if (!opened) {
        return opened.error();
    }
    OutputFile file = std::move(opened).value();
    head(file);
    if (std::optional<text::Error> fault = write_lines(file, columns, separator, gaps)) {
        return text::Error{.sentence = "cannot write '" + path + "': " + fault->sentence, .culprit = path};
    }
    return file.commit();
}

std::string field_of(std::string_view word) {
    using namespace std::string_view_literals;
    const bool plain = word.find_first_of(" \t,;\"#\r\n\0"sv) == std::string_view::npos && !parse_field(word, true);
    if (plain) return std::string(word);
    std::string field = "\"";
    for (const char c : word) {
        field += c == '"' ? "\"\"" : std::string(1, "\r\n\0"sv.find(c) == std::string_view::npos ? c : ' ');
    }
    return field + "\"";
}

}  // namespace dinal::files
