#include "model/terms/polyline.hpp"

#include <fmt/format.h>

#include "model/terms/spline.hpp"

namespace dinal::model::terms {
namespace {

/// The tolerance, as a part of the period, for a last point that repeats the first one.
constexpr double closing_tolerance = 1e-9;

bool closes_period(const Samples& s) {
    return s.t.size() > 1 && std::fabs(s.t.back() - s.t.front() - *s.period) <= closing_tolerance * *s.period;
}

double range_of(const std::vector<double>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return *high - *low;
}

/// Returns whether slopes can be computed; complaint() reports the reason if not.
bool is_well_formed(const Samples& s) {
    return !s.t.empty() && s.t.size() == s.M.size() && !text::complaint(samples_options, s) &&
           !not_increasing("t", s.t);
}

}  // namespace

std::shared_ptr<const Samples> Polyline::prepared(std::shared_ptr<const Samples> points) {
    const bool cubic = points && points->interpolation == Interpolation::cubic;
    if (!points || (!cubic && !points->period) || !points->slopes.empty() || !is_well_formed(*points)) return points;
    Samples made = *points;
    if (made.period && closes_period(made) &&
        std::fabs(made.M.back() - made.M.front()) <= closing_tolerance * range_of(made.M)) {
        made.t.pop_back();
        made.M.pop_back();
    }
    const bool ends = !made.period || made.t.back() < made.t.front() + *made.period;
    if (cubic && ends) {
        made.slopes =
            made.period ? periodic_spline_slopes(made.t, made.M, *made.period) : spline_slopes(made.t, made.M);
    }
    return std::make_shared<const Samples>(std::move(made));
}

Polyline::Piece Polyline::piece(double at) const {
    const std::vector<double>& t = samples->t;
    const double period = *samples->period;
    if (t.size() == 1) return {at, at + period, 0, 0};
    const double cycle = cycle_at(at, (at - t.front()) / period, [&](double n) { return t.front() + n * period; });
    const auto point = [&](std::size_t i) {
        return i == t.size() ? t.front() + (cycle + 1) * period : t[i] + cycle * period;
    };
    std::size_t i =
        std::min(static_cast<std::size_t>(std::max(0.0, static_cast<double>(t.size()) * ((at - point(0)) / period))),
                 t.size() - 1);
    if (!(point(i) <= at && at < point(i + 1))) {
        std::size_t low = 0, high = t.size();  // point(low) <= at < point(high)
        while (high - low > 1) {
            const std::size_t middle = low + (high - low) / 2;
            (point(middle) <= at ? low : high) = middle;
        }
        i = low;
    }
    return {point(i), point(i + 1), i, i + 1 == t.size() ? 0 : i + 1};
}

double Polyline::greatest() const {
    if (!samples) return 0;
    const Samples& s = *samples;
    double peak = 0;
    for (const double M : s.M) peak = std::max(peak, std::fabs(M));
    for (std::size_t i = 0; i < s.slopes.size(); ++i) {
        const bool last = i + 1 == s.t.size();
        if (last && !s.period) break;
        const double third = ((last ? s.t.front() + *s.period : s.t[i + 1]) - s.t[i]) / 3;
        const std::size_t next = last ? 0 : i + 1;
        peak = std::max({peak, std::fabs(s.M[i] + third * s.slopes[i]), std::fabs(s.M[next] - third * s.slopes[next])});
    }
    return peak;
}

void Polyline::delay_by(double d) {
    Samples moved = *samples;
    for (double& t : moved.t) t += d;
    moved.delay += d;
    samples = std::make_shared<const Samples>(std::move(moved));
    most_ = greatest();
}

std::string Polyline::formula(double gain) const {
    const Samples& s = *samples;
    return (gain == 1 ? "" : factor(gain) + "* ") +
           (s.interpolation == Interpolation::cubic  ? "a cubic spline through "
            : s.interpolation == Interpolation::hold ? "steps at "
                                                     : "straight lines through ") +
           std::to_string(s.t.size()) + " points, t " + number(s.t.front()) + " ... " + number(s.t.back()) +
           (s.period ? ", again every " + number(*s.period) : "") +
           (s.origin.empty() ? "" : ", of " + s.origin.substr(0, s.origin.find(", {")));
}

std::optional<text::Error> Polyline::complaint() const {
    if (!samples || samples->t.empty()) {
        return text::Error{"there are no points; give at least one time and one value"};
    }
    if (samples->t.size() != samples->M.size()) {
        return text::Error{fmt::format("t has {} values and M has {}; they must be equally long", samples->t.size(),
                                       samples->M.size())};
    }
    if (auto wrong = text::complaint(samples_options, *samples)) return wrong;
    if (auto wrong = not_increasing("t", samples->t)) return wrong;
    const Samples& s = *samples;
    if (!s.period) return std::nullopt;
    if (closes_period(s)) {
        return text::Error{.sentence = fmt::format("M = {} at t = {}, but {} one period later, at t = {}", s.M.front(),
                                                   s.t.front(), s.M.back(), s.t.back()),
                           .option = "period"};
    }
    if (s.t.back() - s.t.front() < *s.period) return std::nullopt;
    return text::Error{.sentence = fmt::format("period = {} is shorter than the points, t = {} ... {}", *s.period,
                                               s.t.front(), s.t.back()),
                       .option = "period"};
}

}  // namespace dinal::model::terms
