// excitation.samples: straight lines between points.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// Times strictly increasing, at least one point.
struct Samples {
    std::vector<double> t, M;
    std::string origin = {};  ///< where they were read, in the words of whoever read them; not used by the core
    double delay = 0;         ///< by how much `t` is later than there
};
inline constexpr text::Option samples_options[] = {
    {"t", "time units", text::needed, text::any_finite, "times, which increase", text::fills<&Samples::t>},
    {"M", "torque", text::needed, text::any_finite, "the torque at these times", text::fills<&Samples::M>},
};

/// Straight lines between the samples; the first and last value hold outside.
// Behind a shared pointer to const, so that copies of an excitation are cheap and safe.
struct Polyline {
    static const TermText about;

    std::shared_ptr<const Samples> samples;

    Polyline(std::shared_ptr<const Samples> points) : samples(std::move(points)) {}

    [[nodiscard]] double value(double t) const {
        const Samples& s = *samples;
        if (!(t >= s.t.front())) {
            return s.M.front();
        }
        if (t >= s.t.back()) {
            return s.M.back();
        }
        const std::size_t i = segment(t);
        return s.M[i] + (s.M[i + 1] - s.M[i]) * ((t - s.t[i]) / (s.t[i + 1] - s.t[i]));
    }
    [[nodiscard]] double next_break(double t) const {
        const std::vector<double>& times = samples->t;
        if (times.size() == 1 || t >= times.back()) return never;
        return t < times.front() ? times.front() : times[segment(t) + 1];
    }
    [[nodiscard]] double constant_from() const { return samples->t.size() == 1 ? -never : samples->t.back(); }
    [[nodiscard]] double most() const {
        double peak = 0;
        for (const double M : samples->M) peak = std::max(peak, std::fabs(M));
        return peak;
    }
    [[nodiscard]] double repeats_after() const { return 0; }
    [[nodiscard]] Detail detail() const { return no_detail; }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        const Samples& s = *samples;
        if (!(inside >= s.t.front()) || inside >= s.t.back()) {
            sum.add_constant(value(inside));
            return;
        }
        const std::size_t i = segment(inside);
        sum.add_line(s.t[i], s.M[i], (s.M[i + 1] - s.M[i]) / (s.t[i + 1] - s.t[i]));
    }
    void delay_by(double d) {
        Samples moved = *samples;
        for (double& t : moved.t) {
            t += d;
        }
        moved.delay += d;
        samples = std::make_shared<const Samples>(std::move(moved));
    }
    [[nodiscard]] std::optional<text::Error> complaint() const;
    [[nodiscard]] std::string formula(double gain) const {
        const Samples& s = *samples;
        return (gain == 1 ? "" : factor(gain) + "* ") + "straight lines through " + std::to_string(s.t.size()) +
               " points, t " + number(s.t.front()) + " ... " + number(s.t.back()) +
               (s.origin.empty() ? "" : ", of " + s.origin.substr(0, s.origin.find(", {")));
    }

private:
    /// The index i with t[i] <= at < t[i + 1], for times inside the table. Records are mostly sampled evenly, so the
    /// guess is mostly right.
    [[nodiscard]] std::size_t segment(double at) const {
        const std::vector<double>& t = samples->t;
        const double steps = static_cast<double>(t.size() - 1);
        const double guess = std::clamp(steps * fraction(at, t.front(), t.back()), 0.0, steps - 1);
        const auto i = static_cast<std::size_t>(guess);
        if (t[i] <= at && at < t[i + 1]) {
            return i;
        }
        return static_cast<std::size_t>(std::upper_bound(t.begin(), t.end(), at) - t.begin()) - 1;
    }
};

inline constexpr TermText Polyline::about{
    {"excitation.samples", "excitation.samples{ t = { 0, 1, 2 }, M = { 0, 3, 0 } }", samples_options},
    "Straight lines between points, from two columns of a CSV file or from two tables (or vectors). Outside, the first "
    "and the last value hold. time and value name the columns or number them; without them they are the columns t (or "
    "time) and M, else the first and the second.",
    "M = excitation.samples{ t = { 0, 1, 3 }, M = { 0, 2, 0 } }\nprint(M(0.5), M(2), M(9))  --> 1.0\t1.0\t0.0"};

}  // namespace dinal::model::terms
