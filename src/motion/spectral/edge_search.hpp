// The time at which something has happened from then on, found by asking whether it has.
#pragma once

#include <optional>

namespace dinal::motion::spectral {

/// It has not happened at low, it has at high.
struct Edge {
    double low, high;
    [[nodiscard]] double middle() const { return low + (high - low) / 2; }
};

/// By halving, until it is known to 4 `fine`.
template <class Behind>
Edge narrowed(Edge edge, double fine, const Behind& is_behind) {
    while (edge.high - edge.low > 4 * fine) (is_behind(edge.middle()) ? edge.high : edge.low) = edge.middle();
    return edge;
}

/// Near a guess: two questions if that is right to `fine`, and some more for each digit by which it is not. None where
/// it is not between 0 and `most`.
template <class Behind>
std::optional<Edge> edge_near(double guess, double most, double fine, const Behind& is_behind) {
    constexpr double farther = 8;
    Edge edge{guess - 2 * fine, guess + 2 * fine};
    double reach = 2 * fine;
    if (!(edge.low > 0 && edge.high < most)) return {};
    if (!is_behind(edge.high)) {
        do {
            reach *= farther;
            edge = {edge.high, guess + reach};
            if (!(edge.high < most)) return {};
        } while (!is_behind(edge.high));
    } else {
        while (is_behind(edge.low)) {
            reach *= farther;
            edge = {guess - reach, edge.low};
            if (!(edge.low > 0)) return {};
        }
    }
    return narrowed(edge, fine, is_behind);
}

}  // namespace dinal::motion::spectral
