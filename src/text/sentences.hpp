// Numbers and counts for people: as many digits as say something.
#pragma once

#include <string>
#include <string_view>

namespace dinal::text {

/// A time to a ten-thousandth of `scale` at least: 999.4502 where T0 = 1.
std::string time_text(double t, double scale);

/// Five digits; what is rounding beside `scale` is 0.
std::string number_text(double x, double scale);

/// "0.15515 <= Re = 0.167", with as many digits as it takes to see it; "Re = 0.5" when they are equal.
std::string against_limit(double torque, double limit);

/// "1 stop", "7 stops", "2 switches".
std::string counted(std::size_t n, std::string_view what);

/// 0.1234 -> "12.3 %".
std::string percent(double part);

}  // namespace dinal::text
