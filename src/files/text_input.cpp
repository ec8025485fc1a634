#include "files/text_input.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <system_error>

#include "files/file.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::files {
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

std::string shown(std::string_view field) {
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
        return "is " + shown(field) + ", but only finite numbers can be used";
    }
    if (with_decimal_comma(std::string(field))) {
        return "is " + shown(field) + ": write a decimal point instead of the comma";
    }
    if (is_too_large(field)) {
        return "is " + shown(field) + ", too large for a number in double precision (1.8e308)";
    }
    return "is " + shown(field) + ", not a number";
}

}  // namespace dinal::files
