// Numbers and counts in sentences, with a sensible number of digits.
#pragma once

#include <string>
#include <string_view>

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

}  // namespace dinal::text
