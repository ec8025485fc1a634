#include "files/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include "files/csv_fields.hpp"
#include "files/text_input.hpp"
#include "text/words.hpp"

namespace dinal::files {
namespace {

class CsvReader {
public:
    CsvReader(std::string_view text, const std::string& file) : lines_(text), file_(file), size_(text.size()) {}

    text::Expected<Table> read() {
        if (!next_line()) {
            return text::Error{file_ + ": the file is empty, it has neither names nor numbers"};
        }
        std::optional<text::Error> fault = head();
        // As many rows as there would be if all were as long as the first.
        if (!fault && more_) numbers_.reserve((size_ / (lines_.text().size() + 1) + 1) * table_.names.size());
        while (!fault && more_) {
            fault = row();
        }
        if (fault) {
            return *fault;
        }
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        const auto columns = static_cast<Eigen::Index>(table_.names.size());
        table_.values =
            Eigen::Map<const RowMajor>(numbers_.data(), static_cast<Eigen::Index>(numbers_.size()) / columns, columns);
        return std::move(table_);
    }

private:
    /// Goes to the next line that is neither blank nor a comment.
    bool next_line() {
        more_ = false;
        while (!more_ && lines_.next()) {
            const std::string_view line = text::trimmed(lines_.text());
            if (line.starts_with('#')) {
                keep_comment(lines_.text());
            } else {
                more_ = !line.empty();
            }
        }
        return more_;
    }

    void keep_comment(std::string_view line) {
        line.remove_prefix(line.find('#') + 1);
        table_.comments.emplace_back(line.starts_with(' ') ? line.substr(1) : line);
    }

    /// Takes the line of names when the first line is one; else makes names and leaves the line for row().
    std::optional<text::Error> head() {
        const std::string_view first = lines_.text();
        const std::size_t number = lines_.number();
        const std::optional<Separator> of_first = separator_in(first);
        separator_ = of_first.value_or(Separator::blanks);
        split(first, separator_, fields_);
        const auto is_number = [](std::string_view field) { return parse_field(field).has_value(); };
        const auto numeric = std::count_if(fields_.begin(), fields_.end(), is_number);
        if (numeric == 0) {
            if (next_line()) {
                separator_ = separator_in(lines_.text()).value_or(separator_);
            }
            split(first, separator_, fields_);
            width_source_ = "as in the line of names";
            for (const std::string_view field : fields_) {
                table_.names.push_back(name_in(field, table_.names.size() + 1));
            }
            return std::nullopt;
        }
        if (numeric < static_cast<std::ptrdiff_t>(fields_.size())) {
            const auto bad = std::find_if_not(fields_.begin(), fields_.end(), is_number);
            return error_at(file_, number,
                            "column " + std::to_string(bad - fields_.begin() + 1) + " " + number_fault(*bad) +
                                ", but the line also has numbers (in a line of names they must be in double quotes)");
        }
        width_source_ = "as in the first row";
        for (std::size_t i = 1; i <= fields_.size(); ++i) {
            table_.names.push_back(std::to_string(i));
        }
        return std::nullopt;
    }

    /// A row of plain numbers, read where they stand. False when something in it wants a closer look.
    bool plain_row() {
        const std::string_view line = lines_.text();
        const char *at = line.data(), *const last = at + line.size();
        const char mark = static_cast<char>(separator_);
        const auto skip_blanks = [&] {
            while (at != last && (*at == ' ' || (*at == '\t' && mark != '\t'))) ++at;
        };
        const std::size_t before = numbers_.size(), columns = table_.names.size();
        for (std::size_t i = 0; i < columns; ++i) {
            skip_blanks();
            double value = 0;
            const auto [end, fault] = std::from_chars(at, last, value);
            const char* const after = at = end;
            skip_blanks();
            const bool ends = i + 1 == columns;
            const bool parted = ends                              ? at == last
                                : separator_ == Separator::blanks ? at != after
                                                                  : at != last && *at == mark;
            if (fault != std::errc() || !std::isfinite(value) || !parted) {
                numbers_.resize(before);
                return false;
            }
            if (!ends && separator_ != Separator::blanks) ++at;
            numbers_.push_back(value);
        }
        return true;
    }

    std::optional<text::Error> row() {
        if (plain_row()) {
            next_line();
            return std::nullopt;
        }
        split(lines_.text(), separator_, fields_);
        if (fields_.size() != table_.names.size()) {
            return error_at(file_, lines_.number(),
                            "found " + std::to_string(fields_.size()) + (fields_.size() == 1 ? " field" : " fields") +
                                ", expected " + std::to_string(table_.names.size()) + " " + width_source_);
        }
        for (std::size_t i = 0; i < fields_.size(); ++i) {
            const std::optional<double> number = parse_field(fields_[i]);
            if (!number) {
                std::string column = std::to_string(i + 1);
                if (table_.names[i] != column) {
                    column += " (" + table_.names[i] + ")";
                }
                return error_at(file_, lines_.number(), "column " + column + " " + number_fault(fields_[i]));
            }
            numbers_.push_back(*number);
        }
        next_line();
        return std::nullopt;
    }

    Lines lines_;
    const std::string& file_;
    std::size_t size_;  // of all the text
    Table table_;
    Separator separator_ = Separator::blanks;
    std::string width_source_;
    bool more_ = false;
    std::vector<std::string_view> fields_;
    std::vector<double> numbers_;  // row after row
};

}  // namespace

text::Expected<Table> parse_csv(std::string_view text, const std::string& name) {
    if (std::optional<text::Error> fault = binary_fault(text, name)) {
        return *fault;
    }
    return CsvReader(text, name).read();
}

text::Expected<Table> read_csv(const std::string& path) {
    const text::Expected<std::string> text = read_file(path);
    return text ? parse_csv(*text, path) : text::Expected<Table>(text.error());
}

}  // namespace dinal::files
