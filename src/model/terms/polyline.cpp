#include "model/terms/polyline.hpp"

#include <fmt/format.h>

namespace dinal::model::terms {
namespace {

/// The tolerance, as a part of the period, for a last point that repeats the first one.
constexpr double closing_tolerance = 1e-9;

bool closes_period(const Samples& s) {
    return s.t.size() > 1 && std::fabs(s.t.back() - s.t.front() - *s.period) <= closing_tolerance * *s.period;
}

double range_of(const std::vector<double>& values) {
    const auto [low, high] = std::ranges::minmax_element(values);
    return *high - *low;
}

/// Returns whether slopes can be computed; complaint() reports the reason if not.
bool is_well_formed(const Samples& s) {
    return !s.t.empty() && s.t.size() == s.M.size() && !text::complaint(samples_options, s) &&
           !not_increasing("t", s.t);
}

/// Solves below[i] x[i - 1] + here[i] x[i] + above[i] x[i + 1] = right[i] in place of `right`. A spline's equations
/// need no pivoting.
void solve_tridiagonal(const std::vector<double>& below, std::vector<double> here, const std::vector<double>& above,
                       std::vector<double>& right) {
    const std::size_t n = here.size();
    for (std::size_t i = 1; i < n; ++i) {
        const double factor = below[i] / here[i - 1];
        here[i] -= factor * above[i - 1];
        right[i] -= factor * right[i - 1];
    }
    right[n - 1] /= here[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) right[i] = (right[i] - above[i] * right[i + 1]) / here[i];
}

}  // namespace

std::vector<double> spline_slopes(std::span<const double> t, std::span<const double> values) {
    const std::size_t n = t.size();
    if (n < 2) return std::vector<double>(n, 0.0);
    std::vector<double> h(n - 1), rise(n - 1);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        h[i] = t[i + 1] - t[i];
        rise[i] = (values[i + 1] - values[i]) / h[i];
    }
    if (n == 2) return {rise[0], rise[0]};
    if (n == 3) {
        const double bend = (rise[1] - rise[0]) / (h[0] + h[1]);
        return {rise[0] - bend * h[0], rise[0] + bend * h[0], rise[1] + bend * h[1]};
    }
    std::vector<double> below(n, 0.0), here(n), above(n, 0.0), right(n);
    const double first = h[0] + h[1], last = h[n - 2] + h[n - 3];
    here[0] = h[1], above[0] = first;
    right[0] = ((h[0] + 2 * first) * h[1] * rise[0] + h[0] * h[0] * rise[1]) / first;
    for (std::size_t i = 1; i + 1 < n; ++i) {
        below[i] = h[i], here[i] = 2 * (h[i - 1] + h[i]), above[i] = h[i - 1];
        right[i] = 3 * (h[i] * rise[i - 1] + h[i - 1] * rise[i]);
    }
    below[n - 1] = last, here[n - 1] = h[n - 3];
    right[n - 1] = (h[n - 2] * h[n - 2] * rise[n - 3] + (2 * last + h[n - 2]) * h[n - 3] * rise[n - 2]) / last;
    solve_tridiagonal(below, here, above, right);
    return right;
}

std::vector<double> periodic_spline_slopes(std::span<const double> t, std::span<const double> values, double period) {
    const std::size_t n = t.size();
    std::vector<double> h(n), rise(n);
    for (std::size_t i = 0; i < n; ++i) {
        const bool ends = i + 1 == n;
        h[i] = (ends ? t[0] + period : t[i + 1]) - t[i];
        rise[i] = ((ends ? values[0] : values[i + 1]) - values[i]) / h[i];
    }
    std::vector<double> below(n), here(n), above(n), right(n);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t before = (i + n - 1) % n;
        below[i] = h[i], here[i] = 2 * (h[before] + h[i]), above[i] = h[before];
        right[i] = 3 * (h[i] * rise[before] + h[before] * rise[i]);
    }
    // The corners of the matrix are a rank-one correction (Sherman and Morrison).
    const double corner = -here[0], ratio = below[0] / corner;
    std::vector<double> border(n, 0.0), diagonal = here;
    border[0] = corner, border[n - 1] = above[n - 1];
    diagonal[0] -= corner;
    diagonal[n - 1] -= above[n - 1] * ratio;
    solve_tridiagonal(below, diagonal, above, right);
    solve_tridiagonal(below, diagonal, above, border);
    const double part = (right[0] + ratio * right[n - 1]) / (1 + border[0] + ratio * border[n - 1]);
    for (std::size_t i = 0; i < n; ++i) right[i] -= part * border[i];
    return right;
}

std::shared_ptr<const Samples> Polyline::prepared(std::shared_ptr<const Samples> points) {
    const bool cubic = points && points->interpolation == Interpolation::cubic;
    if (!points || (!cubic && !points->period) || !points->slopes.empty() || !is_well_formed(*points)) return points;
    Samples made = *points;
    if (made.period && closes_period(made) &&
        std::fabs(made.M.back() - made.M.front()) <= closing_tolerance * range_of(made.M)) {
        made.t.pop_back();
        made.M.pop_back();
    }
    if (made.t.size() == 1) made.period.reset();  // it is constant
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
        return text::error("t has {} values and M has {}; they must be equally long", samples->t.size(),
                           samples->M.size());
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
