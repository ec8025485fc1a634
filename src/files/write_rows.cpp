#include "files/write_rows.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

namespace dinal::files {
namespace {

constexpr std::size_t cell_size = 32;  // -2.2250738585072014e-308 and a separator take 25; a power of two copies fast

/// A column on its way down. Friction, a pulse or a stuck mass repeat a value over many rows: its text is kept then.
struct Cell {
    std::uint64_t bits = 0;  // of the value above; bits, because 0 and -0 are equal but not the same
    std::size_t length = 0;  // of the kept text; 0 until the value is met a second time
    char terminator = '\n';
    std::array<char, cell_size> text{};
};

std::optional<text::Error> unequal_lengths(std::span<const NamedColumn> columns) {
    for (const NamedColumn& column : columns) {
        if (column.values.size() != columns.front().values.size()) {
            return text::Error{"column '" + std::string(column.name) + "' has " + std::to_string(column.values.size()) +
                               " values, but '" + std::string(columns.front().name) + "' has " +
                               std::to_string(columns.front().values.size())};
        }
    }
    return std::nullopt;
}

char* format(char* place, double value, char terminator) {
    char* end = std::to_chars(place, place + cell_size, value).ptr;
    *end++ = terminator;
    return end;
}

/// Puts the text of a value; returns its end, or null when the value is not finite.
char* put(char* place, double value, Cell& cell) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    if (bits != cell.bits) {
        cell.bits = bits;
        cell.length = 0;
        return std::isfinite(value) ? format(place, value, cell.terminator) : nullptr;
    }
    if (cell.length == 0) {
        cell.length = static_cast<std::size_t>(format(cell.text.data(), value, cell.terminator) - cell.text.data());
    }
    std::memcpy(place, cell.text.data(), cell_size);  // all of it: a fixed size is two instructions
    return place + cell.length;
}

std::optional<text::Error> write_lines(OutputFile& file, std::span<const NamedColumn> columns, char separator) {
    if (columns.empty()) {
        return text::Error{"there are no columns to write"};
    }
    if (std::optional<text::Error> fault = unequal_lengths(columns)) {
        return fault;
    }
    const std::size_t rows = columns.front().values.size();
    std::vector<Cell> cells(columns.size());
    for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
        cells[i].terminator = separator;
    }
    for (std::size_t row = 0; row < rows && !file.failed(); ++row) {
        char* place = file.room((columns.size() + 1) * cell_size);
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const double value = columns[i].values[row];
            place = put(place, value, cells[i]);
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
                                   const std::function<void(OutputFile&)>& head) {
    text::Expected<OutputFile> opened = OutputFile::create(path);
    if (!opened) {
        return opened.error();
    }
    OutputFile file = std::move(opened).value();
    head(file);
    if (std::optional<text::Error> fault = write_lines(file, columns, separator)) {
        return text::Error{.sentence = "cannot write '" + path + "': " + fault->sentence, .culprit = path};
    }
    return file.commit();
}

}  // namespace dinal::files
