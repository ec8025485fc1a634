#include "model/forcing.hpp"

#include <algorithm>
#include <cmath>

#include "model/term_bounds.hpp"
#include "model/terms.hpp"

namespace dinal::model {

namespace {

double period_of(const Harmonic& h) {
    return h.omega == 0 ? 0 : terms::two_pi / std::fabs(h.omega);
}
double period_of(const Square& s) {
    return s.period;
}
double period_of(const Sawtooth& s) {
    return s.period;
}
double period_of(const Triangle& t) {
    return t.period;
}
double period_of(const Scripted& s) {
    return s.period;
}
template <class Other>
double period_of(const Other&) {
    return 0;
}

/// Whether these are whole parts of `common`.
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
        const double settled = std::visit([](const auto& term) { return terms::constant_from(term); }, c.term);
        if (c.gain == 0 || c.to <= t || (settled <= t && c.from <= t && c.to == never)) continue;
        const double period = std::visit([](const auto& term) { return period_of(term); }, c.term);
        if (!(period > 0) || c.from > t || c.to < never) return 0;
        periods.push_back(period);
    }
    if (periods.empty()) return 0;
    constexpr int most_beats = 60;  // of the slowest term: a longer period explains nothing
    const double longest = *std::max_element(periods.begin(), periods.end());
    for (int n = 1; n <= most_beats; ++n) {
        if (fit(periods, n * longest)) return n * longest;
    }
    return 0;
}

}  // namespace dinal::model
