// Numbers and counts in sentences, with a sensible number of digits.
#pragma once

#include <fmt/format.h>
#include <string>
#include <string_view>
#include <utility>

#include "text/characters.hpp"

namespace dinal::text {

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
