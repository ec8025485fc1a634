#include "files/csv.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "files/file.hpp"
#include "text/characters.hpp"
#include "text/suggest.hpp"
#include "text/words.hpp"

namespace dinal::files {

namespace {

/// "t, theta, M"; a long list is cut to fit in a sentence.
std::string list_of(std::span<const std::string> names) {
    constexpr std::size_t most = 12;
    std::string list;
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i) {
        list += (i == 0 ? "" : ", ") + names[i];
    }
    return names.size() > most ? list + ", ... (" + std::to_string(names.size()) + " in all)" : list;
}

}  // namespace

std::vector<NamedColumn> named_columns(const std::vector<std::string>& names,
                                       const Eigen::Ref<const Eigen::MatrixXd>& values) {
    std::vector<NamedColumn> columns;
    const auto count = std::min(static_cast<Eigen::Index>(names.size()), values.cols());
    for (Eigen::Index i = 0; i < count; ++i) {
        const std::span<const double> numbers(values.data() + i * values.outerStride(),
                                              static_cast<std::size_t>(values.rows()));
        columns.push_back({names[static_cast<std::size_t>(i)], numbers});
    }
    return columns;
}

std::optional<std::size_t> place_without_unit(std::span<const std::string> names, std::string_view name) {
    const auto fits = [name](const std::string& whole) {
        const std::string_view rest = std::string_view(whole).substr(std::min(name.size(), whole.size()));
        return whole.starts_with(name) &&
               ((rest.starts_with(" (") && rest.ends_with(')')) || (rest.starts_with(" [") && rest.ends_with(']')));
    };
    if (std::ranges::count_if(names, fits) != 1) return std::nullopt;
    return static_cast<std::size_t>(std::ranges::find_if(names, fits) - names.begin());
}

text::Expected<Eigen::Index> find_column(std::span<const std::string> names, std::string_view name) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) {
        if (const auto place = place_without_unit(names, name)) return static_cast<Eigen::Index>(*place);
        return text::Error{.sentence = "there is no column '" + std::string(name) + "' among " + list_of(names),
                           .culprit = std::string(name),
                           .cure = text::did_you_mean(name, names)};
    }
    return static_cast<Eigen::Index>(found - names.begin());
}

text::Expected<Eigen::Index> find_column(std::span<const std::string> names, std::int64_t number) {
    if (number < 1 || number > static_cast<std::int64_t>(names.size())) {
        return text::Error{"there is no column " + std::to_string(number) + ": they are numbered 1 to " +
                           std::to_string(names.size()) + " (" + list_of(names) + ")"};
    }
    return static_cast<Eigen::Index>(number - 1);
}

namespace {

enum class Separator : char { comma = ',', semicolon = ';', tab = '\t', blanks = ' ' };

/// The index of the end of the first field of `line`: the next separator, or the length of the line.
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

/// Returns whether each comma is between two digits, as in "0,1\t0,25".
bool has_decimal_commas_only(std::string_view line) {
    for (std::size_t at = line.find(','); at != std::string_view::npos; at = line.find(',', at + 1)) {
        if (at == 0 || at + 1 == line.size() || !text::is_digit(line[at - 1]) || !text::is_digit(line[at + 1]))
            return false;
    }
    return true;
}

/// The first kind of separator outside of quotes in the line; none for a single field.
std::optional<Separator> separator_in(std::string_view line) {
    std::string bare;
    bool inside = false;
    for (const char c : text::trimmed(line)) {
        inside = inside != (c == '"');
        if (!inside) {
            bare += c;
        }
    }
    if (bare.find(';') == std::string::npos && bare.find('\t') != std::string::npos && has_decimal_commas_only(bare))
        return Separator::tab;
    for (const Separator candidate : {Separator::semicolon, Separator::comma, Separator::tab, Separator::blanks}) {
        if (bare.find(static_cast<char>(candidate)) != std::string::npos) {
            return candidate;
        }
    }
    return std::nullopt;
}

/// The fields of a line, without surrounding blanks; quotes stay.
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
            line = text::trimmed(line);  // several blanks are one separator
        }
    }
}

/// Returns whether a field begins with a quote that the line does not close. (A quote within a word means inches.)
bool is_left_open(std::string_view line) {
    const std::size_t last = line.rfind('"');
    if (last == std::string_view::npos || std::ranges::count(line, '"') % 2 == 0) return false;
    constexpr std::string_view before_fields = ",; \t";
    return last == 0 || before_fields.find(line[last - 1]) != std::string_view::npos;
}

/// Returns the word in a field, without its quotes and with doubled quotes made single; for an empty field, the number
/// of the column.
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

bool is_gap(std::string_view field) {
    return field.empty() || field == "\"\"";
}

std::string word_in(std::string_view field) {
    return is_gap(field) ? std::string() : name_in(field, 0);
}

class ColumnReader {
public:
    ColumnReader(std::string_view text, const std::string& file, const ReadOptions& options)
        : lines_(text), file_(file), options_(options), is_open_(!text.empty() && text.back() != '\n') {}

    text::Expected<ReadColumns> read() {
        if (auto fault = collect_rows()) return *fault;
        const bool says_separator = take_separator_line();
        if (rows_.empty()) {
            const char* what = options_.skip > 0 ? ": nothing follows the lines that are skipped"
                                                 : ": the file is empty, it has neither names nor numbers";
            return text::Error{file_ + what};
        }
        if (!says_separator) {
            const auto separator = separator_in(rows_[rows_.size() > 1 ? 1 : 0].text);
            separator_ = separator ? *separator : separator_in(rows_.front().text).value_or(Separator::blanks);
        }
        has_points_ = separator_ == Separator::tab && has_decimal_points();
        has_quoted_commas_ = has_decimal_commas_in_quotes();
        all_in_quotes_ = are_all_in_quotes();
        split(rows_.front().text, separator_, fields_);
        result_.columns.resize(fields_.size());
        if (!options_.names.empty() && options_.names.size() != fields_.size()) {
            return error_at(file_, rows_.front().number,
                            "found " + std::to_string(fields_.size()) + " columns, and names has " +
                                std::to_string(options_.names.size()));
        }
        const bool named = std::ranges::none_of(fields_, [this](auto field) { return is_number(field); }) ||
                           is_word_above_numbers(fields_.front());
        std::optional<text::Error> fault = take_names(named);
        if (named) rows_.erase(rows_.begin());
        if (named && !rows_.empty() && may_be_units()) {
            take_units();
            rows_.erase(rows_.begin());
        }
        leave_out_cut_line();
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

    /// Collects all lines that are neither blank nor comments.
    std::optional<text::Error> collect_rows() {
        while (lines_.next()) {
            if (lines_.number() <= static_cast<std::size_t>(options_.skip)) continue;
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

    /// Handles "sep=;", a line for Excel.
    bool take_separator_line() {
        if (rows_.empty()) return false;
        constexpr std::string_view key = "sep=";
        const std::string_view line = rows_.front().text;
        constexpr std::string_view marks = ";,\t";
        if (!line.starts_with(key) || line.size() != key.size() + 1 ||
            marks.find(line.back()) == std::string_view::npos)
            return false;
        separator_ = static_cast<Separator>(line.back());
        rows_.erase(rows_.begin());
        return true;
    }

    /// Returns whether commas are decimal: also with tabs, unless there are decimal points, when 1,5 is an error.
    bool decimal_comma() const {
        return separator_ == Separator::semicolon || (separator_ == Separator::tab && !has_points_);
    }

    bool has_decimal_points() const {
        return std::ranges::any_of(rows_, [](const Row& row) {
            for (std::size_t at = row.text.find('.'); at != std::string_view::npos; at = row.text.find('.', at + 1)) {
                if (at > 0 && at + 1 < row.text.size() && text::is_digit(row.text[at - 1]) &&
                    text::is_digit(row.text[at + 1]))
                    return true;
            }
            return false;
        });
    }

    /// Returns whether commas in quoted numbers such as "0,5" are decimal. Three digits after a comma may mean
    /// thousands, so other values decide.
    [[nodiscard]] bool has_decimal_commas_in_quotes() {
        bool tells = false;
        for (const Row& row : rows_) {
            if (row.text.find('"') == std::string_view::npos) continue;
            split(row.text, separator_, fields_);
            for (const std::string_view field : fields_) {
                const std::string_view inside = in_quotes(field);
                const std::size_t comma = inside.find(',');
                if (comma == std::string_view::npos || !parse_field(inside, true)) continue;
                constexpr std::size_t thousands = 4;
                tells = tells || inside.size() - comma != thousands;
            }
        }
        return tells;
    }

    /// Returns whether each field, those of names included, is in quotes: then quotes do not mean words.
    [[nodiscard]] bool are_all_in_quotes() {
        return rows_.size() > 1 && std::ranges::all_of(rows_, [this](const Row& row) {
                   split(row.text, separator_, fields_);
                   return std::ranges::all_of(fields_, [](std::string_view field) {
                       return field.size() >= 2 && field.front() == '"' && field.back() == '"';
                   });
               });
    }

    static std::string_view in_quotes(std::string_view field) {
        const bool quoted = field.size() > 2 && field.front() == '"' && field.back() == '"';
        return quoted ? text::trimmed(field.substr(1, field.size() - 2)) : std::string_view();
    }

    std::optional<double> number_in(std::string_view field) const {
        if (all_in_quotes_) return parse_field(in_quotes(field), has_quoted_commas_ || decimal_comma());
        if (has_quoted_commas_ && field.starts_with('"')) {
            if (const std::string_view inside = in_quotes(field); !inside.empty()) return parse_field(inside, true);
        }
        return parse_field(field, decimal_comma());
    }

    bool is_number(std::string_view field) const { return !field.empty() && number_in(field).has_value(); }

    /// Drops the last line if a logger was switched off while writing it.
    void leave_out_cut_line() {
        if (!is_open_ || rows_.size() < 2) return;
        split(rows_.back().text, separator_, fields_);
        if (fields_.size() >= result_.columns.size()) return;
        result_.cut = rows_.back().number;
        rows_.pop_back();
    }

    /// Returns whether "t,100,200" is a line of names: the first column has numbers in all other rows.
    bool is_word_above_numbers(std::string_view first) const {
        if (rows_.size() < 2 || first.empty() || is_number(first)) return false;
        std::vector<std::string_view> fields;
        return std::all_of(rows_.begin() + 1, rows_.end(), [&](const Row& row) {
            split(row.text, separator_, fields);
            return is_number(fields.front());
        });
    }

    std::optional<text::Error> take_names(bool named) {
        std::set<std::string_view> names;
        for (std::size_t i = 0; i < fields_.size(); ++i) {
            std::string& name = result_.columns[i].name;
            name = !options_.names.empty() ? options_.names[i]
                   : named                 ? name_in(fields_[i], i + 1)
                                           : std::to_string(i + 1);
            if (!names.insert(name).second) {
                return error_at(file_, rows_.front().number,
                                "the name " + quoted_for_message(name) + " belongs to two columns");
            }
        }
        return std::nullopt;
    }

    /// Returns whether the second line may contain units: it has words and gaps, and each word has only numbers below
    /// it.
    bool may_be_units() const {
        std::vector<std::string_view> units, fields;
        split(rows_.front().text, separator_, units);
        if (units.size() != result_.columns.size() ||
            std::ranges::any_of(units, [this](auto field) { return is_number(field); }))
            return false;
        bool has_numbers = false;
        for (std::size_t row = 1; row < rows_.size(); ++row) {
            split(rows_[row].text, separator_, fields);
            for (std::size_t i = 0; i < std::min(units.size(), fields.size()); ++i) {
                if (is_gap(units[i]) || fields[i].empty()) continue;
                if (!is_number(fields[i])) return false;
                has_numbers = true;
            }
        }
        return has_numbers;
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

    /// Parses a row of plain numbers in place. Returns false if some field needs a closer look.
    bool take_plain(std::string_view line) {
        const char *at = line.data(), *const last = at + line.size();
        const char mark = static_cast<char>(separator_);
        const auto skip_blanks = [&] {
            while (at != last && (*at == ' ' || (*at == '\t' && mark != '\t'))) ++at;
        };
        plain_.clear();
        for (std::size_t i = 1; i <= result_.columns.size(); ++i) {
            skip_blanks();
            double& value = plain_.emplace_back();
            const auto [end, fault] = std::from_chars(at, last, value);
            const char* const after = at = end;
            skip_blanks();
            const bool parted = i == result_.columns.size()       ? at == last
                                : separator_ == Separator::blanks ? at != after
                                                                  : at != last && *at++ == mark;
            if (fault != std::errc() || !std::isfinite(value) || !parted) return false;
        }
        for (std::size_t i = 0; i < plain_.size(); ++i) result_.columns[i].numbers.push_back(plain_[i]);
        return true;
    }

    std::optional<text::Error> take_numbers(const Row& row) {
        if (take_plain(row.text)) return std::nullopt;
        split(row.text, separator_, fields_);
        if (fields_.size() != result_.columns.size()) {
            return error_at(file_, row.number,
                            "found " + std::to_string(fields_.size()) + (fields_.size() == 1 ? " field" : " fields") +
                                ", expected " + std::to_string(result_.columns.size()) +
                                " as in the first line; put # before lines that are no columns");
        }
        for (std::size_t i = 0; i < fields_.size(); ++i) {
            ReadColumn& column = result_.columns[i];
            if (column.of_words) continue;
            const auto number = number_in(fields_[i]);
            if (column.fault.empty() && !(number && std::isfinite(*number))) {
                std::string name = std::to_string(i + 1);
                if (column.name != name) name += " (" + column.name + ")";
                column.fault = error_at(file_, row.number, "column " + name + " " + number_fault(fields_[i])).sentence;
            }
            column.of_words = !number;
            column.numbers.push_back(number.value_or(0));
        }
        return std::nullopt;
    }

    /// Reads word columns again, as they are recognised only at the end.
    void take_words() {
        std::vector<ReadColumn>& columns = result_.columns;
        if (std::ranges::none_of(columns, [](const ReadColumn& c) { return c.of_words; })) return;
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
    const ReadOptions& options_;
    bool is_open_;  // whether the last line has no newline
    Separator separator_ = Separator::blanks;
    bool has_points_ = false, has_quoted_commas_ = false, all_in_quotes_ = false;
    std::vector<Row> rows_;
    std::vector<std::string_view> fields_;
    std::vector<double> plain_;
    ReadColumns result_;
};

}  // namespace

text::Expected<ReadColumns> parse_columns(std::string_view text, const std::string& name, const ReadOptions& options) {
    if (std::optional<text::Error> fault = binary_fault(text, name)) return *fault;
    return ColumnReader(text, name, options).read();
}

text::Expected<ReadColumns> read_columns(const std::string& path, const ReadOptions& options) {
    const text::Expected<std::string> text = read_file(path);
    return text ? parse_columns(*text, path, options) : text::Expected<ReadColumns>(text.error());
}

text::Expected<Table> table_of(ReadColumns content) {
    Table table{.names = {}, .values = {}, .comments = std::move(content.comments)};
    const auto rows = content.columns.empty() ? 0 : static_cast<Eigen::Index>(content.columns[0].numbers.size());
    table.values.resize(rows, static_cast<Eigen::Index>(content.columns.size()));
    for (ReadColumn& column : content.columns) {
        if (!column.fault.empty()) return text::Error{column.fault};
        std::ranges::copy(column.numbers, table.values.col(static_cast<Eigen::Index>(table.names.size())).data());
        table.names.push_back(std::move(column.name));
    }
    return table;
}

namespace {

/// Writes a comment, possibly a whole script: each line needs its sign. A NUL would make the file unreadable.
void write_comment(OutputFile& file, std::string text) {
    std::ranges::replace(text, '\0', ' ');
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

namespace {

constexpr std::size_t cell_size = 32;  // -2.2250738585072014e-308 and a separator take 25 bytes; 32 are copied fast

/// The last value of a column with its text. Friction, pulses or a stuck mass repeat values over many rows.
struct Cell {
    std::uint64_t bits = 0;  // the value above; as bits, because 0 and -0 compare equal
    std::size_t length = 0;  // length of the cached text; 0 until a value occurs twice
    char terminator = '\n';
    std::string_view gap = {};  // replaces nan
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

/// Writes the text of a value; returns its end, or null for a gap that is refused.
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
    std::memcpy(place, cell.text.data(), cell_size);  // a copy of fixed size takes two instructions
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
    if (columns.size() == 1) cells.front().gap = "nan";  // an empty line would not be a row
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

// Lines and numbers of a text file.

namespace {

/// The field without its leading +, unless another sign follows.
std::string_view without_plus(std::string_view field) {
    const bool plus = field.size() > 1 && field[0] == '+' && (text::is_digit(field[1]) || field[1] == '.');
    return plus ? field.substr(1) : field;
}

/// std::from_chars reports overflow and underflow alike. Underflow is rounded to zero, with its sign.
std::optional<double> rounded_underflow(std::string_view field) {
    const double value = std::strtod(std::string(field).c_str(), nullptr);
    return std::fabs(value) < 1 ? std::optional(value) : std::nullopt;
}

bool is_nan_or_inf(std::string_view field) {
    double value = 0;
    field = without_plus(field);
    const auto [end, fault] = std::from_chars(field.data(), field.data() + field.size(), value);
    return fault == std::errc() && end == field.data() + field.size() && !std::isfinite(value);
}

bool is_too_large(std::string_view field) {
    double value = 0;
    field = without_plus(field);
    return std::from_chars(field.data(), field.data() + field.size(), value).ec == std::errc::result_out_of_range;
}

/// Parses 1,5 but not 1,2,3.
std::optional<double> with_decimal_comma(std::string field) {
    const std::size_t comma = field.find(',');
    if (comma == std::string::npos) return std::nullopt;
    field[comma] = '.';
    return parse_number(field);
}

}  // namespace

Lines::Lines(std::string_view text) : rest_(text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (rest_.starts_with(byte_order_mark)) {
        rest_.remove_prefix(byte_order_mark.size());
    }
    // Decided once: searching each line for both kinds of line end would scan the whole rest for the absent one.
    has_lone_cr_ = rest_.find('\n') == std::string_view::npos || rest_.find('\r') != std::string_view::npos;
}

bool Lines::next() {
    constexpr std::size_t lines_between_questions = 4096;
    const bool stops = number_ % lines_between_questions == lines_between_questions - 1 && shall_stop();
    if (rest_.empty() || stops) {
        return false;
    }
    ++number_;
    const std::size_t end = std::min(has_lone_cr_ ? rest_.find_first_of("\r\n") : rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    const std::size_t length_of_end = rest_.substr(end).starts_with("\r\n") ? 2 : 1;
    rest_.remove_prefix(std::min(end + length_of_end, rest_.size()));
    return true;
}

text::Error error_at(const std::string& file, std::size_t line, const std::string& what) {
    return {file + ":" + std::to_string(line) + ": " + what};
}

std::optional<text::Error> binary_fault(std::string_view text, const std::string& file) {
    const std::size_t place = text.find('\0');
    if (place == std::string_view::npos) {
        return std::nullopt;
    }
    std::size_t line = 1;
    for (Lines lines(text.substr(0, place + 1)); lines.next();) {
        line = lines.number();
    }
    return error_at(file, line, "there is a NUL byte, so this is not plain text: save it as text in UTF-8");
}

std::optional<double> parse_number(std::string_view field) {
    field = without_plus(field);
    const char* const last = field.data() + field.size();
    double value = 0;
    const auto [end, fault] = std::from_chars(field.data(), last, value);
    if (end != last || field.empty()) {
        return std::nullopt;
    }
    if (fault == std::errc::result_out_of_range) {
        return rounded_underflow(field);
    }
    return fault == std::errc() && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<double> parse_fortran_number(std::string_view field) {
    if (const std::optional<double> plain = parse_number(field)) {
        return plain;
    }
    std::array<char, 64> text{};
    std::size_t length = 0;
    bool has_exponent = false;
    for (const char c : field) {
        if (length + 2 > text.size()) {
            return std::nullopt;
        }
        const bool is_letter = c == 'D' || c == 'd' || c == 'Q' || c == 'q' || c == 'E' || c == 'e';
        // Three-digit exponents displace their letter: 1.5+300.
        const bool lost_its_letter = (c == '+' || c == '-') && length > 0 && !has_exponent;
        const bool begins_exponent = !has_exponent && (is_letter || lost_its_letter);
        if (begins_exponent) {
            text[length++] = 'e';
            has_exponent = true;
        }
        if (!begins_exponent || lost_its_letter) {
            text[length++] = c;
        }
    }
    return parse_number({text.data(), length});
}

std::optional<double> parse_field(std::string_view field, bool decimal_comma) {
    if (const std::optional<double> plain = parse_number(field)) return plain;
    const std::size_t point = field.find('.'), letter = field.find_first_of("dD");
    const bool of_fortran = point != std::string_view::npos && letter != std::string_view::npos && point < letter;
    if (of_fortran) {
        if (const std::optional<double> number = parse_fortran_number(field)) return number;
    }
    const std::string word = text::lower(field);
    if (word.empty() || word == "nan" || word == "-nan" || word == "na") {
        return std::numeric_limits<double>::quiet_NaN();
    }
    if (word == "inf" || word == "+inf" || word == "-inf") {
        return word.front() == '-' ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
    }
    return decimal_comma ? with_decimal_comma(word) : std::nullopt;
}

std::string quoted_for_message(std::string_view field) {
    constexpr std::size_t most = 40;
    const std::string text = text::displayable(field);
    const std::string_view beginning = text::cut_to_columns(text, most);
    return "'" + std::string(beginning) + (beginning.size() < text.size() ? "...'" : "'");
}

std::string number_fault(std::string_view field) {
    if (field.empty()) {
        return "is empty";
    }
    if (is_nan_or_inf(field)) {
        return "is " + quoted_for_message(field) + ", but only finite numbers can be used";
    }
    if (with_decimal_comma(std::string(field))) {
        return "is " + quoted_for_message(field) + ": write a decimal point instead of the comma";
    }
    if (is_too_large(field)) {
        return "is " + quoted_for_message(field) + ", too large for a number in double precision (1.8e308)";
    }
    return "is " + quoted_for_message(field) + ", not a number";
}

}  // namespace dinal::files
