#include "files/record1989.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include "files/csv.hpp"
#include "text/words.hpp"

namespace dinal::files {
namespace {

constexpr std::size_t width = 6;

text::Expected<Written> write_columns(const std::string& path, std::span<const NamedColumn> columns) {
    return write_rows(path, columns, ' ', [columns](OutputFile& file) {
        file.write(std::to_string(columns.front().values.size()) + "\n");
    });
}

template <class Integer>
std::optional<Integer> parse_integer(std::string_view text) {
    Integer value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, fault] = std::from_chars(text.data(), last, value);
    return fault == std::errc() && end == last ? std::optional(value) : std::nullopt;
}

/// Takes the next value off the line: values are separated by blanks or a comma. Empty at the end.
std::string_view take_value(std::string_view& line) {
    line = text::trimmed(line);
    const std::size_t end = std::min(line.find_first_of(" \t,"), line.size());
    const std::string_view value = line.substr(0, end);
    line = text::trimmed(line.substr(end));
    if (line.starts_with(',')) {
        line.remove_prefix(1);
    }
    return value;
}

class RecordReader {
public:
    RecordReader(std::string_view text, const std::string& file) : lines_(text), file_(file) {}

    text::Expected<Table> read() {
        std::optional<text::Error> fault = take_count();
        while (!fault && lines_.next()) {
            fault = take_line();
        }
        if (fault) {
            return *fault;
        }
        const std::size_t left = numbers_.size() % width;
        if (left != 0) {
            return error_at(file_, row_begin_, "the last row has " + std::to_string(left) + " of its six numbers");
        }
        const std::size_t rows = numbers_.size() / width;
        if (rows != promised_) {
            return text::Error{file_ + ": NPUNT in the first line is " + std::to_string(promised_) +
                               ", but there are " + std::to_string(rows) + " rows; correct NPUNT if none is missing"};
        }
        Table table;
        table.names = record1989_names();
        using Rows = Eigen::Matrix<double, Eigen::Dynamic, width, Eigen::RowMajor>;
        table.values = Eigen::Map<const Rows>(numbers_.data(), static_cast<Eigen::Index>(rows), width);
        return table;
    }

private:
    /// Reads NPUNT, alone in the first line that is not blank.
    std::optional<text::Error> take_count() {
        while (lines_.next()) {
            const std::string_view line = text::trimmed(lines_.text());
            if (line.empty()) {
                continue;
            }
            const std::optional<std::uint64_t> count = parse_integer<std::uint64_t>(line);
            if (!count) {
                return error_at(file_, lines_.number(),
                                "NPUNT, the number of rows, should stand here alone instead of " +
                                    quoted_for_message(line) +
                                    "; a table with or without names is read when it is called .csv");
            }
            promised_ = *count;
            return std::nullopt;
        }
        return text::Error{file_ + ": the file is empty, it should begin with NPUNT, the number of rows"};
    }

    /// Reads all values of a line. A row begins on a new line, like every Fortran READ, and may continue on further
    /// lines.
    std::optional<text::Error> take_line() {
        std::string_view rest = lines_.text();
        if (text::trimmed(rest).empty()) {
            return std::nullopt;
        }
        if (numbers_.size() % width == 0) {
            row_begin_ = lines_.number();
        }
        const std::size_t full = (numbers_.size() / width + 1) * width;
        while (!text::trimmed(rest).empty()) {
            if (std::optional<text::Error> fault = take(take_value(rest), full)) {
                return fault;
            }
        }
        return std::nullopt;
    }

    /// Reads one value, which may be repeated: 3*0.0 is three zeros. `full` is the number of values in a row.
    std::optional<text::Error> take(std::string_view value, std::size_t full) {
        std::size_t repeats = 1;
        if (const std::size_t star = value.find('*'); star != std::string_view::npos) {
            const std::optional<std::size_t> count = parse_integer<std::size_t>(value.substr(0, star));
            if (count && *count > 0) {  // stars without a count mark a number too wide for its field
                repeats = *count;
                value.remove_prefix(star + 1);
            }
        }
        const std::optional<double> number = parse_fortran_number(value);
        if (!number) {
            const std::size_t column = numbers_.size() % width;
            return error_at(file_, lines_.number(), record1989_names()[column] + " " + number_fault(value));
        }
        if (repeats > full - numbers_.size()) {
            const std::string begin =
                row_begin_ == lines_.number() ? "" : ", which begins in line " + std::to_string(row_begin_);
            return error_at(file_, lines_.number(), "there are more than six numbers in this row" + begin);
        }
        numbers_.insert(numbers_.end(), repeats, *number);
        return std::nullopt;
    }

    Lines lines_;
    const std::string& file_;
    std::uint64_t promised_ = 0;
    std::size_t row_begin_ = 0;    // line in which the latest row begins
    std::vector<double> numbers_;  // row after row
};

}  // namespace

const std::vector<std::string>& record1989_names() {
    static const std::vector<std::string> names = {"t",        "theta",           "velocity_over_omega0",
                                                   "M_over_k", "friction_over_k", "damping_over_k"};
    return names;
}

text::Expected<Written> write_record1989(const std::string& path, const motion::Run& run,
                                         const model::Oscillator& system) {
    if (!system.has_spring()) {
        return text::Error{"cannot write '" + path +
                           "': the record of 1989 divides by k and omega0, and this system has k = 0; save it as .csv"};
    }
    const double w0 = system.natural_frequency();
    const double k = system.stiffness();
    const std::array<std::pair<std::string_view, double>, width> sources = {
        {{"t", 1.0}, {"theta", 1.0}, {"velocity", w0}, {"M", k}, {"friction", k}, {"damping", k}}};
    Eigen::MatrixXd values(run.rows.rows(), static_cast<Eigen::Index>(width));
    for (std::size_t i = 0; i < width; ++i) {
        const auto& [name, unit] = sources[i];
        const text::Expected<Eigen::Index> column = find_column(run.names(), name);
        if (!column) {
            return text::Error{"cannot write '" + path + "': the record of 1989 needs six columns and " +
                               column.error().message()};
        }
        values.col(static_cast<Eigen::Index>(i)) = run.rows.col(*column) / unit;
    }
    return write_columns(path, named_columns(record1989_names(), values));
}

text::Expected<Written> write_record1989(const std::string& path,
                                         const Eigen::Ref<const Eigen::MatrixXd>& six_columns) {
    if (six_columns.cols() != static_cast<Eigen::Index>(width)) {
        return text::Error{"cannot write '" + path + "': the record of 1989 has six columns, here are " +
                           std::to_string(six_columns.cols())};
    }
    return write_columns(path, named_columns(record1989_names(), six_columns));
}

text::Expected<Table> parse_record1989(std::string_view text, const std::string& name) {
    if (std::optional<text::Error> fault = binary_fault(text, name)) {
        return *fault;
    }
    return RecordReader(text, name).read();
}

text::Expected<Table> read_record1989(const std::string& path) {
    const text::Expected<std::string> text = read_file(path);
    return text ? parse_record1989(*text, path) : text::Expected<Table>(text.error());
}

}  // namespace dinal::files
