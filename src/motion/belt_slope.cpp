#include "motion/belt_slope.hpp"

#include <limits>

#include "motion/chebyshev.hpp"

namespace dinal::motion {

double belt_from(const model::Excitation& belt, double t) {
    const bool breaks = belt.next_break(std::nextafter(t, -model::never)) == t;
    return breaks ? belt.value_after(t) : belt.value(t);
}

BeltSlope belt_slope(const model::Excitation& belt, double t, double stretch) {
    constexpr double rounding = std::numeric_limits<double>::epsilon();
    using namespace chebyshev;
    if (belt.constant_from() <= t) return {0, 0};
    constexpr double smooth = 1e-9, noise = 1e-5, shorter = 0.25;
    constexpr double clearly_worse = 8;  // a jump multiplies the doubt by 16 in two more steps
    constexpr int most_looks = 23;       // samples intervals down to 1e-14 of `stretch`
    constexpr double roundings = 256;    // factor of rounding in the slope at the end of a polynomial of this degree
    const double next = belt.next_break(t);
    BeltSlope best{0, model::never};
    // An interval that contains an undeclared jump is halved, so that the jump does not enter the slope before it.
    double h = std::min(stretch, (next - t) / 2);
    for (int look = 0; look < most_looks; ++look) {
        Samples values{};
        for (std::size_t j = 0; j < points; ++j) {
            const double at = t + h * (1 + nodes[j]);
            values[j] = j == 0 ? belt_from(belt, t) : at >= next ? belt.value_before(next) : belt.value(at);
        }
        double greatest = 0;
        for (const double v : values) greatest = std::max(greatest, std::fabs(v));
        const Series<points> curve = fit(values);
        const double all = size(curve), rough = tail(curve), slope = value(derivative(curve), -1) / h;
        if (!(rough > smooth * all)) return {slope, roundings * rounding * greatest / h};
        const double doubt = roundings * rough / h;
        if (rough <= noise * all && doubt > clearly_worse * best.doubt) break;
        if (doubt < best.doubt) best = {slope, doubt};
        h *= shorter;
    }
    return best.doubt < model::never ? best : BeltSlope{0, 0};
}

}  // namespace dinal::motion
