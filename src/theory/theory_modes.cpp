#include "theory/theory_modes.hpp"

#include <cmath>

namespace dinal::theory {

namespace {

// Above this k the two exponentials are computed separately; below it, as sum and difference, which have a limit.
constexpr double apart = 0.5;

}  // namespace

Modes::Modes(double zeta) : zeta_(zeta), rate_(std::sqrt(std::fabs(1 - zeta)) * std::sqrt(1 + zeta)) {}

double Modes::damped_cosine(double x) const {
    if (swings()) return std::exp(-zeta_ * x) * std::cos(rate_ * x);
    return (std::exp(-slow_root() * x) + std::exp(-fast_root() * x)) / 2;
}

double Modes::pushed(double x) const {
    if (rate_ == 0) return x * std::exp(-x);
    if (swings()) return std::exp(-zeta_ * x) * std::sin(rate_ * x) / rate_;
    return -std::exp(-slow_root() * x) * std::expm1(-2 * rate_ * x) / (2 * rate_);
}

Modes::Answers Modes::after(double x) const {
    const double g = pushed(x);
    if (swings() || rate_ < apart) {
        const double cosine = damped_cosine(x);
        return {cosine + zeta_ * g, g, cosine - zeta_ * g};
    }
    const double slow = std::exp(-slow_root() * x), fast = std::exp(-fast_root() * x), between = 2 * rate_;
    return {(fast_root() * slow - slow_root() * fast) / between, g,
            (fast_root() * fast - slow_root() * slow) / between};
}

}  // namespace dinal::theory
