#include "files/csv_columns.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "files/csv_fields.hpp"
#include "files/text_input.hpp"
#include "text/words.hpp"

namespace dinal::files {
namespace {

/// A field that may be empty, nan or infinite; `decimal_comma`: 1,5 is a number, too.
std::optional<double> lenient_number(std::string_view field, bool decimal_comma) {
    if (const auto plain = parse_field(field)) return plain;
    const std::string word = text::lower(field);
    if (word.empty() || word == "nan" || word == "-nan" || word == "na") {
        return std::numeric_limits<double>::quiet_NaN();
    }
    if (word == "inf" || word == "+inf" || word == "-inf") {
        return word.front() == '-' ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
    }
    if (decimal_comma && std::count(word.begin(), word.end(), ',') == 1) {
        std::string point = word;
        std::replace(point.begin(), point.end(), ',', '.');
        return parse_number(point);
    }
    return std::nullopt;
}

std::string word_in(std::string_view field) {
    return field.empty() || field == "\"\"" ? std::string() : name_in(field, 0);
}

class ColumnReader {
public:
    ColumnReader(std::string_view text, const std::string& file) : lines_(text), file_(file) {}

    text::Expected<ReadColumns> read() {
        if (auto fault = collect_rows()) return *fault;
        if (rows_.empty()) {
            return text::Error{file_ + ": the file is empty, it has neither names nor numbers"};
        }
        const auto separator = separator_in(rows_[rows_.size() > 1 ? 1 : 0].text);
        separator_ = separator ? *separator : separator_in(rows_.front().text).value_or(Separator::blanks);
        split(rows_.front().text, separator_, fields_);
        result_.columns.resize(fields_.size());
        const bool named =
            std::none_of(fields_.begin(), fields_.end(), [this](auto field) { return is_number(field); }) ||
            is_word_above_numbers(fields_.front());
        std::optional<text::Error> fault = take_names(named);
        if (named) rows_.erase(rows_.begin());
        if (named && may_be_units()) {
            take_units();
            rows_.erase(rows_.begin());
        }
        for (std::size_t i = 0; i < rows_.size() && !fault; ++i) fault = take_numbers(rows_[i]);
        if (fault) return *fault;
        take_words();
        return std::move(result_);
    }

private:
    struct Row {
        std::string_view text;
        std::size_t number;
    };

    /// All lines that are neither blank nor a comment.
    std::optional<text::Error> collect_rows() {
        while (lines_.next()) {
            const std::string_view line = text::trimmed(lines_.text());
            if (line.starts_with('#')) {
                const std::string_view comment = line.substr(1);
                result_.comments.emplace_back(comment.starts_with(' ') ? comment.substr(1) : comment);
            } else if (!line.empty()) {
                if (is_left_open(line)) {
                    return error_at(file_, lines_.number(),
                                    "a double quote is opened and not closed: a name or a word must end in its line");
                }
                rows_.push_back({lines_.text(), lines_.number()});
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] bool decimal_comma() const { return separator_ == Separator::semicolon; }

    [[nodiscard]] bool is_number(std::string_view field) const {
        return !field.empty() && lenient_number(field, decimal_comma()).has_value();
    }

    /// "t,100,200" is a line of names: in all other rows the first column has numbers.
    [[nodiscard]] bool is_word_above_numbers(std::string_view first) const {
        if (rows_.size() < 2 || first.empty() || is_number(first)) return false;
        std::vector<std::string_view> fields;
        return std::all_of(rows_.begin() + 1, rows_.end(), [&](const Row& row) {
            split(row.text, separator_, fields);
            return is_number(fields.front());
        });
    }

    std::optional<text::Error> take_names(bool named) {
        std::vector<ReadColumn>& columns = result_.columns;
        for (std::size_t i = 0; i < columns.size(); ++i) {
            columns[i].name = named ? name_in(fields_[i], i + 1) : std::to_string(i + 1);
            for (std::size_t j = 0; j < i; ++j) {
                if (columns[j].name == columns[i].name) {
                    return error_at(file_, rows_.front().number,
                                    "the name " + shown(columns[i].name) + " belongs to two columns");
                }
            }
        }
        return std::nullopt;
    }

    /// A line of words, and numbers in all lines under it.
    [[nodiscard]] bool may_be_units() const {
        if (rows_.size() < 2) return false;
        std::vector<std::string_view> fields;
        const auto number = [&](std::string_view field) { return is_number(field); };
        const auto number_or_gap = [&](std::string_view field) { return field.empty() || is_number(field); };
        split(rows_.front().text, separator_, fields);
        if (fields.size() != result_.columns.size() || std::any_of(fields.begin(), fields.end(), number)) return false;
        if (std::all_of(fields.begin(), fields.end(), [](std::string_view field) { return field.empty(); }))
            return false;
        return std::all_of(rows_.begin() + 1, rows_.end(), [&](const Row& row) {
            split(row.text, separator_, fields);
            return std::all_of(fields.begin(), fields.end(), number_or_gap);
        });
    }

    void take_units() {
        split(rows_.front().text, separator_, fields_);
        for (std::size_t i = 0; i < fields_.size(); ++i) {
            std::string unit = word_in(fields_[i]);
            const bool in_brackets = unit.size() > 2 && ((unit.front() == '(' && unit.back() == ')') ||
                                                         (unit.front() == '[' && unit.back() == ']'));
            result_.columns[i].unit = in_brackets ? unit.substr(1, unit.size() - 2) : unit;
        }
    }

    std::optional<text::Error> take_numbers(const Row& row) {
        split(row.text, separator_, fields_);
        if (fields_.size() != result_.columns.size()) {
            return error_at(file_, row.number,
                            "found " + std::to_string(fields_.size()) + (fields_.size() == 1 ? " field" : " fields") +
                                ", expected " + std::to_string(result_.columns.size()) + " as in the first line");
        }
        for (std::size_t i = 0; i < fields_.size(); ++i) {
            ReadColumn& column = result_.columns[i];
            if (column.of_words) continue;
            const auto number = lenient_number(fields_[i], decimal_comma());
            column.of_words = !number;
            column.numbers.push_back(number.value_or(0));
        }
        return std::nullopt;
    }

    /// A column is known to be of words when all of it was seen, so these are read again.
    void take_words() {
        std::vector<ReadColumn>& columns = result_.columns;
        if (std::none_of(columns.begin(), columns.end(), [](const ReadColumn& c) { return c.of_words; })) return;
        for (const Row& row : rows_) {
            split(row.text, separator_, fields_);
            for (std::size_t i = 0; i < columns.size(); ++i) {
                if (columns[i].of_words) columns[i].words.push_back(word_in(fields_[i]));
            }
        }
        for (ReadColumn& column : columns) {
            if (column.of_words) column.numbers.clear();
        }
    }

    Lines lines_;
    const std::string& file_;
    Separator separator_ = Separator::blanks;
    std::vector<Row> rows_;
    std::vector<std::string_view> fields_;
    ReadColumns result_;
};

/// A word that reads back as the same word, and not as a number or a comment.
std::string field_of(std::string_view word) {
    const bool plain = word.find_first_of(" \t,;\"#\r\n") == std::string_view::npos && !lenient_number(word, true);
    if (plain) return std::string(word);
    std::string field = "\"";
    for (const char c : word) {
        field += c == '"' ? "\"\"" : std::string(1, c == '\n' || c == '\r' ? ' ' : c);
    }
    return field + "\"";
}

void write_number(OutputFile& file, double x) {
    if (std::isnan(x)) return;
    std::array<char, 32> text{};
    char* const end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
    file.write({text.data(), static_cast<std::size_t>(end - text.data())});
}

}  // namespace

text::Expected<ReadColumns> parse_columns(std::string_view text, const std::string& name) {
    if (std::optional<text::Error> fault = binary_fault(text, name)) return *fault;
    return ColumnReader(text, name).read();
}

text::Expected<ReadColumns> read_columns(const std::string& path) {
    const text::Expected<std::string> text = read_file(path);
    return text ? parse_columns(*text, path) : text::Expected<ReadColumns>(text.error());
}

text::Expected<Written> write_columns(const std::string& path, std::span<const WordsOrNumbers> columns,
                                      std::string_view comment) {
    text::Expected<OutputFile> opened = OutputFile::create(path);
    if (!opened) return opened.error();
    OutputFile file = std::move(opened).value();
    if (!comment.empty()) file.write("# " + std::string(comment) + "\n");
    std::size_t rows = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        file.write((i == 0 ? "" : ",") + field_of(columns[i].name));
        rows = std::max(columns[i].numbers.size(), columns[i].words.size());
    }
    file.write("\n");
    for (std::size_t row = 0; row < rows && !file.failed(); ++row) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (i > 0) file.write(",");
            if (!columns[i].words.empty()) {
                file.write(field_of(columns[i].words[row]));
            } else if (columns.size() == 1 && std::isnan(columns[i].numbers[row])) {
                file.write("nan");  // an empty line would be no row
            } else {
                write_number(file, columns[i].numbers[row]);
            }
        }
        file.write("\n");
    }
    return file.commit();
}

}  // namespace dinal::files
