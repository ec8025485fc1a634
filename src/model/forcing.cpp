#include "model/forcing.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dinal::model {

namespace {

/// Returns whether `common` is an integer multiple of all periods.
bool fit(const std::vector<double>& periods, double common) {
    return std::all_of(periods.begin(), periods.end(), [common](double period) {
        const double n = common / period;
        return std::fabs(n - std::round(n)) <= 1e-9 * n;
    });
}

}  // namespace

double period_from(const Excitation& excitation, double t) {
    std::vector<double> periods;
    for (const Component& c : excitation.components()) {
        if (constant_from(c) <= t) continue;
        const double period = std::visit([](const auto& term) { return terms::period_of(term); }, c.term);
        if (!(period > 0) || c.from > t || c.to < never) return 0;
        periods.push_back(period);
    }
    if (periods.empty()) return 0;
    constexpr int most_beats = 60;  // periods of the slowest term; a longer common period is of no use
    const double longest = *std::max_element(periods.begin(), periods.end());
    for (int n = 1; n <= most_beats; ++n) {
        if (fit(periods, n * longest)) return n * longest;
    }
    return 0;
}

}  // namespace dinal::model
