// A user's spring: a function of theta.
#pragma once

#include <memory>
#include <string>

#include "model/spring.hpp"
#include "model/terms/scripted.hpp"

namespace dinal::model::springs {

struct UserSpring {
    std::shared_ptr<terms::UserFunction> function;  ///< function of theta

    /// NaN if the function fails.
    double torque(double theta) const { return function->value(theta, {}); }
    /// By quadrature to rounding; NaN if the function is too rough or fails.
    double energy(double theta) const;
    [[nodiscard]] static std::optional<text::Error> complaint() { return std::nullopt; }
    /// The symmetry of the function is unknown, so false.
    [[nodiscard]] static bool is_odd() { return false; }
    /// The function's source is known to Lua only.
    [[nodiscard]] static std::string lua_text() { return ""; }
};

}  // namespace dinal::model::springs
