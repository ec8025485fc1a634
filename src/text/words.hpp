// Letters, words and lists, shared by all readers of text; numbers and counts in sentences, with a sensible number of
// digits.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "text/characters.hpp"

namespace dinal::text {

// ASCII only, in every locale.
constexpr bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
constexpr char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
/// Returns whether c may be part of a name: a letter, a digit or an underscore.
constexpr bool is_name_char(char c) {
    return is_digit(c) || (lower(c) >= 'a' && lower(c) <= 'z') || c == '_';
}

inline std::string lower(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), [](char c) { return lower(c); });
    return result;
}

/// Returns ".csv" for "Run.CSV"; empty if the name has no extension.
inline std::string ending_of(std::string_view file) {
    return lower(file.substr(std::min(file.rfind('.'), file.size())));
}

/// Returns the parts between separators; some may be empty.
inline std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0; begin <= text.size(); begin += parts.back().size() + 1) {
        parts.push_back(text.substr(begin, text.find(separator, begin) - begin));
    }
    return parts;
}

/// Returns whether an element of the list, or this part of one, has the value.
template <class List, class Value, class Part = std::identity>
[[nodiscard]] constexpr bool contains(const List& list, const Value& value, Part part = {}) {
    return std::ranges::find(list, value, part) != std::ranges::end(list);
}

/// Returns the text without these characters at its ends.
inline std::string_view trimmed(std::string_view text, std::string_view begin, std::string_view end) {
    const std::size_t first = text.find_first_not_of(begin);
    const std::size_t last = text.find_last_not_of(end);
    return first == std::string_view::npos || last == std::string_view::npos || last < first
               ? text.substr(0, 0)
               : text.substr(first, last - first + 1);
}
inline std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\r\n") {
    return trimmed(text, blanks, blanks);
}

/// A text assembled at compile time, for tables of constants. Holds at most `room` - 1 characters; a longer text does
/// not compile.
template <std::size_t room>
class FixedText {
public:
    constexpr FixedText(std::initializer_list<std::string_view> parts) {
        std::size_t n = 0;
        for (const std::string_view part : parts) {
            for (const char c : part) text_[n++] = c;
        }
        text_[n] = '\0';
    }
    constexpr const char* c_str() const { return text_; }

private:
    char text_[room] = {};
};

/// A time with a resolution of `scale` / 10^4 or better: 999.4502 for T0 = 1.
std::string time_text(double t, double scale);

/// Five digits; values within rounding of `scale` are shown as 0.
std::string number_text(double x, double scale);

/// "0.15515 <= Re = 0.167", with enough digits to show the difference; "Re = 0.5" if both are equal.
std::string against_limit(double torque, double limit);

/// "1 stop", "7 stops", "2 switches".
std::string counted(std::size_t n, std::string_view what);

/// 0.1234 -> "12.3 %".
std::string percent(double part);

/// Builds text from sentences.
class Prose {
protected:
    template <class... Values>
    void say(fmt::format_string<Values...> format, Values&&... values) {
        sentences_ += sentences_.empty() ? "" : " ";
        add(format, std::forward<Values>(values)...);
    }
    /// Continues the last sentence.
    template <class... Values>
    void add(fmt::format_string<Values...> format, Values&&... values) {
        sentences_ += fmt::format(format, std::forward<Values>(values)...);
    }
    void end_paragraph() {
        if (sentences_.empty()) return;
        text_ += (text_.empty() ? "" : "\n") + wrapped(sentences_);
        sentences_.clear();
    }

    std::string text_, sentences_;  // finished paragraphs, and the present one
};

}  // namespace dinal::text
