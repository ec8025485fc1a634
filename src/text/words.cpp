#include "text/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dinal::text {

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
    return fmt::format("Re = {:.5g}{}", limit, torque == limit ? "" : " to rounding");
}

std::string counted(std::size_t n, std::string_view what) {
    if (n != 1 && what.ends_with("body")) return fmt::format("{} {}ies", n, what.substr(0, what.size() - 1));
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : what.ends_with("ch") ? "es" : "s");
}

std::string percent(double part) {
    return fmt::format("{:.3g} %", 100 * part);
}

}  // namespace dinal::text
