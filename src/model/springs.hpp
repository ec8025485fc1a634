// The springs that a system may have besides k: a sum of powers of theta (Duffing's, a progressive one, a double well),
// and a user's function.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/spring.hpp"
#include "model/terms/scripted.hpp"

namespace dinal::model::springs {

/// The sum of c theta^n.
struct PolynomialSpring {
    std::vector<std::pair<int, double>> terms;  ///< n and c (torque per rad^n), n increasing from 1 to highest_power

    static constexpr int highest_power = 31;

    double torque(double theta) const;
    /// The sum of c theta^(n + 1)/(n + 1).
    double energy(double theta) const;
    [[nodiscard]] std::optional<text::Error> complaint() const;
    bool is_odd() const;
    std::string lua_text() const;
};

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
