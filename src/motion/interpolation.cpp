#include "motion/interpolation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dinal::motion {

namespace {

/// c0 + c1 s + c2 s^2 + c3 s^3
struct Cubic {
    double c0, c1, c2, c3;
    double operator()(double s) const { return c0 + s * (c1 + s * (c2 + s * c3)); }
};

/// The extremes of the cubic inside (0, 1) in order, followed by 1.
std::array<double, 3> monotone_ends(const Cubic& p) {
    const double a = 3 * p.c3, b = 2 * p.c2, c = p.c1;
    double s1 = 1, s2 = 1;
    const double discriminant = b * b - 4 * a * c;
    if (discriminant > 0) {
        // The stable formula avoids the difference of nearly equal numbers.
        const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
        s1 = a != 0 ? q / a : 1;
        s2 = q != 0 ? c / q : 1;
    }
    const auto inside = [](double s) { return s > 0 && s < 1 ? s : 1; };
    s1 = inside(s1), s2 = inside(s2);
    return {std::min(s1, s2), std::max(s1, s2), 1};
}

}  // namespace

std::optional<double> first_velocity_zero(double direction, double h, double v0, double a0, double v1, double a1) {
    const double rise = v1 - v0;
    const Cubic p{direction * v0, direction * h * a0, direction * (3 * rise - h * (2 * a0 + a1)),
                  direction * (h * (a0 + a1) - 2 * rise)};
    double left = 0;
    for (const double right : monotone_ends(p)) {
        // At the end use the given velocity, not the rounded sum of the coefficients.
        const double value = right == 1 ? direction * v1 : p(right);
        if (!(value > 0)) {
            if (left == 0 && !(p.c0 > 0)) return 0;
            const auto below = [&](double s) { return -p(s); };
            const double at_left = left == 0 ? -p.c0 : -p(left);
            if (!(at_left < 0)) return h * left;
            return h * first_positive(below, left, at_left, right, std::max(-value, 1e-300), 1e-15).second;
        }
        left = right;
    }
    return {};
}

}  // namespace dinal::motion
