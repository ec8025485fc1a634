#include "motion/spectral/corner_look.hpp"

#include <algorithm>
#include <cmath>

#include "motion/interpolation.hpp"

namespace dinal::motion::spectral {

namespace {

using chebyshev::nodes;
using chebyshev::points;

constexpr std::size_t most_places = 4 * points;
/// Looked at so much before a stop, where the mass still slides.
constexpr double a_little = 1e-9;

struct Places {
    std::array<double, most_places> x{};
    std::size_t count = 0;

    /// Where a series that has these values at the nodes passes zero between them.
    template <std::size_t n>
    void add_zeros(const chebyshev::Series<n>& series, double before) {
        const auto value = [&](double at) { return chebyshev::value(series, at); };
        double left = value(nodes[0]);
        for (std::size_t j = 0; j + 1 < points; ++j) {
            const double right = value(nodes[j + 1]), sign = right > 0 ? 1 : -1;
            if (left * right < 0 && count < most_places) {
                const auto rising = [&](double at) { return sign * value(at); };
                x[count++] =
                    first_positive(rising, nodes[j], sign * left, nodes[j + 1], sign * right, a_little / 4).first -
                    before;
            }
            left = right;
        }
    }
};

}  // namespace

std::optional<double> missed_corner(const CornerLook& piece, double allowed) {
    const auto theta = chebyshev::fit(piece.theta), slip = chebyshev::fit(piece.slip),
               remainder = chebyshev::fit(piece.remainder);
    Places places;
    places.add_zeros(chebyshev::derivative(theta), a_little);
    const bool looks_at_friction = piece.system.has_friction_remainder() && !piece.slide.inside();
    if (looks_at_friction) {
        places.add_zeros(slip, a_little);
        places.add_zeros(chebyshev::derivative(slip), 0);
    }
    const double sign = piece.system.dry() ? model::sign_of(piece.way) : 0;
    std::optional<double> first;
    for (std::size_t i = 0; i < places.count; ++i) {
        const double x = places.x[i], v = chebyshev::value(slip, x);
        // Beyond a stop there is no motion that could miss anything.
        if (first ? x >= *first : sign * v < 0) continue;
        const model::State state{chebyshev::value(theta, x), v};
        const double friction = piece.slide.friction_remainder(piece.system, piece.way, state);
        const double off = friction + piece.system.spring(state.theta) - chebyshev::value(remainder, x);
        if (!(std::fabs(off) <= allowed) && sign * v >= 0) first = x;
    }
    return first;
}

double shorter_by_corner(double x) {
    constexpr double part = 0.9, least = 1.0 / 16;
    return std::clamp(part * (1 + x) / 2, least, part);
}

}  // namespace dinal::motion::spectral
