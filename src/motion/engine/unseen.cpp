#include "motion/engine/unseen.hpp"

#include <cmath>
#include <queue>

namespace dinal::motion::engine {

namespace {

using model::bounds::Disc;
using model::bounds::Interval;

// A disc about a stretch, three times as wide, holds an ellipse of Bernstein's with foci at both ends, the sum of whose
// half axes is rho. A function that differs there from its value in the middle by r at most differs on the stretch from
// its polynomial of degree n by 4 r rho^-n / (rho - 1) at most (Trefethen, Approximation Theory and Approximation
// Practice, theorem 8.2).
constexpr double rho = 5.82842712474619, greatest_power = 6.16227766016838;  // 3 + sqrt(3^2 - 1) and 3 + sqrt(3^2 + 1)

constexpr double power(double x, std::size_t n) {
    return n == 0 ? 1 : x * power(x, n - 1);
}
constexpr double falls(std::size_t n) {
    return 4 / (power(rho, n) * (rho - 1));
}

/// |Tk(z) - Tk(0)| at most for all z in that disc, where z = 3 i is worst.
constexpr Series growth = [] {
    Series most{};
    for (std::size_t k = 1; k < node_count; ++k) {
        const double e = power(greatest_power, k);
        most[k] = k % 2 == 0 ? (e + 1 / e) / 2 - 1 : (e - 1 / e) / 2;
    }
    return most;
}();

/// How far a polynomial strays in the disc from its value in the middle. Its last terms may be roundings, which would
/// grow.
double strays(const Series& series) {
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

/// The same on a part of the stretch; exactly where that is all of it.
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
        walk_.set(input.place, {cheb::value(input.series, 0), strays(input.series)},
                  ranges ? range(input.series) : Interval{});
    }
    const auto told = walk_.run();
    return falls(cheb::degree) * told.disc.r <= std::max(allowed, part * std::fabs(told.disc.c)) &&
           told.apart <= allowed && falls(cheb::degree) * walk_.loosest() <= close;
}

/// Discs grow by the roundings of each step.
double Unseen::rounded() {
    walk_.begin(*formula_, piece_, false);
    for (const Input& input : inputs_) walk_.set(input.place, {cheb::value(input.series, 0), 0}, Interval{});
    return walk_.run().disc.r / model::bounds::roundings_of_a_step;
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

/// By how much it may stray in this part, 0 where that is allowed; or where it does.
double Unseen::look(const Part& part, double allowed, std::optional<double>& place) {
    const auto strays_at = [&](double x, double found) {
        const bool strays = std::fabs(found - cheb::value(series_, x)) > allowed;
        if (strays) place = x;
        return strays;
    };
    for (const Input& input : inputs_) {
        const Series own = on_part(input.series, part.middle, part.half);
        walk_.set(input.place, {cheb::value(own, 0), strays(own)}, range(own));
    }
    const auto told = walk_.run(condition_);
    const bool decided = told.disc.c == told.disc.c;
    if (strays_at(part.middle, decided ? told.disc.c : value(part.middle))) return model::never;
    const Series own = on_part(series_, part.middle, part.half);
    const Interval known = range(own);
    const double off = std::max(told.range.hi - known.lo, known.hi - told.range.lo);
    if (off <= allowed) return 0;
    const bool whole = part.half == 1;
    const double r = told.disc.r + (whole ? 0 : strays(own));
    for (const std::size_t n : {std::size_t{4}, std::size_t{8}, std::size_t{16}}) {
        if ((whole && n < cheb::degree) || !(falls(n) * r <= allowed && told.apart <= allowed)) continue;
        for (std::size_t j = 0; j < node_count && !whole; j += cheb::degree / n) {
            const double x = part.middle + part.half * cheb::nodes[j];
            if (strays_at(x, value(x))) return model::never;
        }
        return 0;
    }
    return std::min(off, told.apart + falls(cheb::degree) * r);
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
        part.off = look(part, allowed, found.place);
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
