// A user's law of friction: a function of the speed, alike in both directions.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "model/friction.hpp"
#include "model/terms/scripted.hpp"
#include "text/option.hpp"

namespace dinal::model::laws {

struct UserLaw {
    std::shared_ptr<terms::UserFunction> function;  ///< function of the speed, never called below 0
    double at_zero = 0;                             ///< its value at speed 0, cached for callers without Lua
    std::optional<double> breakaway = {};           ///< Re; by default at_zero

    static constexpr bool depends_on_speed = true;
    /// NaN if the function fails or is negative.
    double sliding(Motion /*way*/, double speed) const {
        if (speed == 0) return at_zero;
        if (speed > 0) return function->value(speed, {});
        return 2 * at_zero - function->value(-speed, {});  // continues with its slope at 0
    }
    double holding(Motion /*way*/) const { return std::max(breakaway.value_or(at_zero), at_zero); }
    [[nodiscard]] std::optional<text::Error> complaint() const {
        // Tolerance for the rounding of a sum that should give Re at speed 0.
        constexpr double rounded = 16 * std::numeric_limits<double>::epsilon();
        if (breakaway && *breakaway < at_zero * (1 - rounded)) {
            return text::Error{
                .sentence = fmt::format("Re = {} must be at least the friction at speed 0, {}", *breakaway, at_zero),
                .option = "Re"};
        }
        return std::nullopt;
    }
};

inline constexpr text::Option user_law_options[] = {
    {"Re", "torque", "the friction at speed 0", text::not_negative,
     "breakaway torque, at least the friction at speed 0", text::fills<&UserLaw::breakaway>},
};
inline constexpr text::Call user_law_call{
    "friction.law", "friction.law(function(speed) return 0.3 + 0.1*speed end, { Re = 0.5 })", user_law_options, true};

}  // namespace dinal::model::laws
