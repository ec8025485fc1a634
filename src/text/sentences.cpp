#include "text/sentences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dinal::text {

namespace {
constexpr std::size_t line_width = 79;

/// A sign between the sides of a formula, or a factor.
bool binds(std::string_view word) {
    return word == "=" || word == "<=" || word == ">" || word == "-" || word == "+" || word == "k";
}

}  // namespace

std::string time_text(double t, double scale) {
    const double wanted = t == 0 ? 0 : std::ceil(std::log10(std::fabs(t) / scale)) + 4;
    return fmt::format("{:.{}g}", t, static_cast<int>(std::clamp(wanted, 5.0, 15.0)));
}

std::string number_text(double x, double scale) {
    return fmt::format("{:.5g}", std::fabs(x) <= 1e-11 * scale ? 0.0 : x);
}

std::string against_limit(double torque, double limit) {
    if (torque <= 1e-14 * limit) torque = 0;
    for (int digits = 5; digits <= 12; ++digits) {
        const std::string shown = fmt::format("{:.{}g}", torque, digits), bound = fmt::format("{:.{}g}", limit, digits);
        if (shown != bound) return fmt::format("{} {} Re = {}", shown, torque > limit ? ">" : "<=", bound);
    }
    return fmt::format("Re = {:.5g}{}", limit, torque == limit ? "" : " but for rounding");
}

std::string counted(std::size_t n, std::string_view what) {
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

std::string percent(double part) {
    return fmt::format("{:.3g} %", 100 * part);
}

std::string wrapped_lines(std::string_view text) {
    std::string result;
    std::size_t column = 0;
    while (!text.empty()) {
        // A formula stays on its line: "theta = 0.155" is broken nowhere.
        std::size_t end = std::min(text.find(' '), text.size());
        std::string_view word = text.substr(0, end);
        while (end < text.size()) {
            const std::size_t next = std::min(text.find(' ', end + 1), text.size());
            const std::string_view after = text.substr(end + 1, next - end - 1);
            if (!binds(word) && !binds(after) && after != "%") break;
            word = after;
            end = next;
        }
        if (column > 0) {
            const bool fits = column + 1 + end <= line_width;
            result += fits ? ' ' : '\n';
            column = fits ? column + 1 : 0;
        }
        result += text.substr(0, end);
        column += end;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return result;
}

}  // namespace dinal::text
