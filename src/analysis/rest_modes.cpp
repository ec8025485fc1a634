#include "analysis/rest_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "algebra/decompositions.hpp"
#include "analysis/returns.hpp"

namespace dinal::analysis {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// A place that a short run leads back to.
struct RestPlace {
    VectorXd at;
    HeldMode mode;
};

/// Newton's method on the map of a short run: it finds a rest that is not stable, too.
std::optional<RestPlace> rest_from(Returns& map, VectorXd at) {
    constexpr int most_steps = 30;
    constexpr double rounding = 1e-13;
    for (int i = 0; i < most_steps; ++i) {
        const Returns::Return back = map(at, {});
        if (!back.finished || !back.mode) return {};
        const VectorXd off = back.to - at;
        if (size_of_step(off) <= rounding * std::max(1.0, size_of_step(at))) return RestPlace{at, *back.mode};
        const auto slope = map.derivative(at, *back.mode, 1, 2);
        if (!slope) return {};
        const Index n = at.size();
        at -= algebra::solve_shortest(slope->by_place - Eigen::MatrixXd::Identity(n, n), off);
        if (!at.allFinite()) return {};
    }
    return {};
}

}  // namespace

text::Expected<std::vector<RestMode>> modes_beside_rest(const SteadyQuestion& asked, const motion::Monitor& monitor) {
    const text::Error none{
        "no rest and no even sliding was found from this start: give theta0 nearer to one, or see sys:steady"};
    const SteadyQuestion question = for_returns(asked);
    Runs runs(question, monitor);
    const Index n = runs.bodies();
    // A quarter of the fastest natural period, in which no mode turns so far that its logarithm would be another one.
    const double natural = runs.system().shortest_natural_period();
    const double length = std::isfinite(natural) ? natural / 4 : 1;
    const auto map_in = [&](const Chart& chart, const VectorXd& there) {
        return Returns(runs, chart, question.repeats.start, length, {}, VectorXd::Ones(there.size()), there);
    };
    VectorXd there = runs.first().y;
    Chart chart(std::vector<Index>(static_cast<std::size_t>(n), -1));
    Returns map = map_in(chart, there);
    std::optional<RestPlace> rest = rest_from(map, map.place(there));
    if (!rest) {  // a motion that ends, or goes round evenly
        const SteadyMotion motion = whole_motion(question, monitor);
        const bool even = motion.is_found() && motion.period == 0 && motion.begun != nullptr;
        if (!even) return none;
        SteadyQuestion there_asked = question;
        there_asked.drive = *motion.begun;
        there = Runs(there_asked, monitor).first().y;
        chart = chart_of(runs);
        Returns again = map_in(chart, there);
        rest = rest_from(again, again.place(there));
        if (!rest) return none;
    }
    Returns found = map_in(chart, there);
    const auto slope = found.derivative(rest->at, rest->mode, 1, 4);
    if (!slope) return text::Error{"the motion is not smooth beside this rest: a contact, a wall or a switch is at it"};
    const Index held = there.size() - runs.allowed(rest->mode, there.size()).cols();
    const algebra::Eigenpairs pairs = algebra::eigenpairs(slope->by_place);
    // What is held does not move at all: so many of the values are 0, the least.
    std::vector<Index> order;
    for (Index k = 0; k < pairs.values.size(); ++k) order.push_back(k);
    std::sort(order.begin(), order.end(),
              [&](Index a, Index b) { return std::abs(pairs.values[a]) > std::abs(pairs.values[b]); });
    order.resize(order.size() - static_cast<std::size_t>(std::min<Index>(held, pairs.values.size())));
    std::vector<RestMode> modes;
    for (const Index k : order) {
        const std::complex<double> value = std::log(pairs.values[k]) / length;
        if (value.imag() < 0) continue;
        RestMode mode{.value = value, .angles = std::vector<std::complex<double>>(static_cast<std::size_t>(n))};
        std::complex<double> greatest = 0;
        for (std::size_t own = 0; own < found.own().size(); ++own) {
            if (found.own()[own] >= n) continue;
            const std::complex<double> angle = pairs.vectors(static_cast<Index>(own), k);
            mode.angles[static_cast<std::size_t>(found.own()[own])] = angle;
            if (std::abs(angle) > std::abs(greatest) * (1 + 1e-9)) greatest = angle;
        }
        for (auto& angle : mode.angles) angle = greatest == 0.0 ? 0.0 : angle / greatest;
        modes.push_back(std::move(mode));
    }
    std::stable_sort(modes.begin(), modes.end(), [](const RestMode& a, const RestMode& b) {
        return std::abs(a.value.imag()) < std::abs(b.value.imag());
    });
    return modes;
}

}  // namespace dinal::analysis
