#include "motion/engine/unseen.hpp"

#include <cmath>
#include <queue>

namespace dinal::motion::engine {

namespace {

using model::bounds::Disc;
using model::bounds::Interval;

// A disc with three times the radius of a stretch contains a Bernstein ellipse with foci at both ends and half axes
// that add up to rho. If a function differs there from its value in the middle by at most r, it differs on the stretch
// from its polynomial of degree n by at most 4 r rho^-n / (rho - 1) (Trefethen, Approximation Theory and Approximation
// Practice, theorem 8.2).
constexpr double rho = 5.82842712474619, greatest_power = 6.16227766016838;  // 3 + sqrt(3^2 - 1) and 3 + sqrt(3^2 + 1)

constexpr double power(double x, std::size_t n) {
    return n == 0 ? 1 : x * power(x, n - 1);
}
constexpr double decay_of_error(std::size_t n) {
    return 4 / (power(rho, n) * (rho - 1));
}

/// The maximum of |Tk(z) - Tk(0)| in that disc, at z = 3 i.
constexpr Series growth = [] {
    Series most{};
    for (std::size_t k = 1; k < node_count; ++k) {
        const double e = power(greatest_power, k);
        most[k] = k % 2 == 0 ? (e + 1 / e) / 2 - 1 : (e - 1 / e) / 2;
    }
    return most;
}();

/// A bound of how far a polynomial deviates in the disc from its value in the middle. Trailing terms that may be
/// rounding are dropped, as they would grow.
double deviation_in_disc(const Series& series) {
    const double noise = 4 * rounding * cheb::size(series);
    std::size_t last = node_count - 1;
    while (last > 0 && std::fabs(series[last]) <= noise) --last;
    double sum = 0;
    for (std::size_t k = 1; k <= last; ++k) sum += std::fabs(series[k]) * growth[k];
    return sum;
}

Interval range(const Series& series) {
    const double way = cheb::size(series) - std::fabs(series[0]);
    return {series[0] - way, series[0] + way};
}

/// The series on a part of the stretch; exactly the same for all of it.
Series on_part(const Series& series, double middle, double half) {
    if (half == 1) return series;
    Nodes values;
    for (std::size_t j = 0; j < node_count; ++j) values[j] = cheb::value(series, middle + half * cheb::nodes[j]);
    return cheb::fit(values);
}

}  // namespace

bool Unseen::is_told(double allowed, double part) {
    constexpr double close = 1e-9;
    const bool ranges = piece_ == nullptr && formula_->has_conditions_of_motion();  // others change at breaks only
    walk_.begin(*formula_, piece_, ranges);
    for (const Input& input : inputs_) {
        walk_.set(input.place, {cheb::value(input.series, 0), deviation_in_disc(input.series)},
                  ranges ? range(input.series) : Interval{});
    }
    const auto enclosure = walk_.run();
    return decay_of_error(cheb::degree) * enclosure.disc.r <= std::max(allowed, part * std::fabs(enclosure.disc.c)) &&
           enclosure.apart <= allowed && decay_of_error(cheb::degree) * walk_.greatest_relative_radius() <= close;
}

double Unseen::value(double x) {
    for (const Input& input : inputs_) walk_.set(input.place, cheb::value(input.series, x));
    return walk_.run(condition_).disc.c;
}

void Unseen::sample() {
    walk_.begin(*formula_, piece_, true);
    Nodes values;
    for (std::size_t j = 0; j < node_count; ++j) values[j] = value(cheb::nodes[j]);
    series_ = cheb::fit(values);
}

/// Returns a bound of the deviation in this part, 0 if it is allowed; sets `place` if a sample deviates by more.
double Unseen::deviation_on(const Part& part, double allowed, std::optional<double>& place) {
    const auto deviates_at = [&](double x, double found) {
        const bool deviates = std::fabs(found - cheb::value(series_, x)) > allowed;
        if (deviates) place = x;
        return deviates;
    };
    for (const Input& input : inputs_) {
        const Series own = on_part(input.series, part.middle, part.half);
        walk_.set(input.place, {cheb::value(own, 0), deviation_in_disc(own)}, range(own));
    }
    const auto enclosure = walk_.run(condition_);
    const bool decided = enclosure.disc.c == enclosure.disc.c;
    if (deviates_at(part.middle, decided ? enclosure.disc.c : value(part.middle))) return model::never;
    const Series own = on_part(series_, part.middle, part.half);
    const Interval known = range(own);
    const double off = std::max(enclosure.range.hi - known.lo, known.hi - enclosure.range.lo);
    if (off <= allowed) return 0;
    const bool whole = part.half == 1;
    const double r = enclosure.disc.r + (whole ? 0 : deviation_in_disc(own));
    for (const std::size_t n : {std::size_t{4}, std::size_t{8}, std::size_t{16}}) {
        if ((whole && n < cheb::degree) || !(decay_of_error(n) * r <= allowed && enclosure.apart <= allowed)) continue;
        for (std::size_t j = 0; j < node_count && !whole; j += cheb::degree / n) {
            const double x = part.middle + part.half * cheb::nodes[j];
            if (deviates_at(x, value(x))) return model::never;
        }
        return 0;
    }
    return std::min(off, enclosure.apart + decay_of_error(cheb::degree) * r);
}

Unseen::Found Unseen::search(double allowed, int budget) {
    constexpr double finest = 1e-14;
    Found found{.proven = true};
    std::priority_queue<Part> open;
    int looks = 0;
    const auto add = [&](double middle, double half) {
        if (found.place) return;
        Part part{middle, half, 0};
        ++looks;
        part.off = deviation_on(part, allowed, found.place);
        if (part.off > 0) open.push(part);
    };
    add(0, 1);
    while (!open.empty() && !found.place) {
        const Part part = open.top();
        if (looks >= budget || part.half < finest) break;
        open.pop();
        add(part.middle - part.half / 2, part.half / 2);
        add(part.middle + part.half / 2, part.half / 2);
    }
    found.proven = open.empty() && !found.place;
    return found;
}

}  // namespace dinal::motion::engine
