#include "plots/bands.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dinal::plots {
namespace {

constexpr double closest_turns = 3;  // places from one turn of a curve to the next
constexpr double turns_to_a_step = 4;

/// The points that are seen, from first to last.
struct Seen {
    std::size_t first = 0, last = 0, turns = 0;
};

Seen seen_of(const Curve& curve, Interval window) {
    const auto x = curve.x.values.first(curve.size()), y = curve.y.values.first(curve.size());
    Seen seen;
    seen.first = static_cast<std::size_t>(std::lower_bound(x.begin(), x.end(), window.low) - x.begin());
    seen.last = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), window.high) - x.begin());
    double direction = 0;
    for (std::size_t i = seen.first + 1; i < seen.last; ++i) {
        const double change = y[i] - y[i - 1];
        if (change * direction < 0) ++seen.turns;
        if (change != 0) direction = change;
    }
    return seen;
}

/// Steps of equal width with the lowest and the highest value in each.
Curve stepped_band(const Curve& curve, const Seen& seen, std::size_t steps) {
    const auto x = curve.x.values, y = curve.y.values;
    const double from = x[seen.first], length = x[seen.last - 1] - from;
    constexpr double none = std::numeric_limits<double>::infinity();
    std::vector<double> middle(steps), low(steps, none), high(steps, -none);
    for (std::size_t i = seen.first; i < seen.last; ++i) {
        const auto step =
            std::min(steps - 1, static_cast<std::size_t>((x[i] - from) / length * static_cast<double>(steps)));
        low[step] = std::min(low[step], y[i]);
        high[step] = std::max(high[step], y[i]);
    }
    for (std::size_t step = 0; step < steps; ++step) {
        middle[step] = from + length * (static_cast<double>(step) + 0.5) / static_cast<double>(steps);
        if (low[step] > high[step]) low[step] = high[step] = std::nan("");
    }
    middle.front() = from;
    middle.back() = from + length;
    Curve band = curve;
    band.style = Style::fill;
    band.x = Numbers::own(std::move(middle));
    band.y = Numbers::own(std::move(high));
    band.base = Numbers::own(std::move(low));
    return band;
}

}  // namespace

std::vector<Figure> with_bands(std::span<const Figure> figures, double width) {
    std::vector<Figure> all(figures.begin(), figures.end());
    for (Figure& figure : all) {
        for (Curve& curve : figure.curves) {
            const auto x = curve.x.values.first(curve.size());
            if (!curve.behind || curve.style != Style::line || !std::is_sorted(x.begin(), x.end())) continue;
            constexpr double anywhere = std::numeric_limits<double>::infinity();
            const Seen seen = seen_of(curve, figure.x.limits.value_or(Interval{-anywhere, anywhere}));
            const auto turns = static_cast<double>(seen.turns);
            if (turns * closest_turns > width) {
                const double steps = std::clamp(turns / turns_to_a_step, 2.0, width);
                curve = stepped_band(curve, seen, static_cast<std::size_t>(steps));
            }
        }
    }
    return all;
}

std::vector<std::size_t> drawing_order(const Figure& figure) {
    std::vector<std::size_t> order;
    for (const bool behind : {true, false}) {
        for (std::size_t i = 0; i < figure.curves.size(); ++i) {
            if (figure.curves[i].behind == behind) order.push_back(i);
        }
    }
    return order;
}

}  // namespace dinal::plots
