// A spring whose torque is a sum of powers of theta: Duffing's, a progressive one, a double well.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "model/spring.hpp"

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

}  // namespace dinal::model::springs
