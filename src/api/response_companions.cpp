#include "api/response_companions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/lowered.hpp"
#include "theory/den_hartog.hpp"
#include "theory/theory_forced.hpp"

namespace dinal::api {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t curve_points = 400;

/// A curve of theory at one point: amplitude in units of M0/k and lag in rad.
using ClosedCurve = std::optional<theory::Harmonic_motion> (*)(double r, double zeta, double gamma, double breakaway);

std::optional<theory::Harmonic_motion> linearised_at(double r, double zeta, double gamma, double) {
    return theory::linearised_friction(r, zeta, gamma);
}

std::optional<theory::Harmonic_motion> den_hartog_at(double r, double zeta, double gamma, double breakaway) {
    if (!(r >= theory::DenHartog::slowest) || r > theory::DenHartog::fastest) return {};
    const auto motion = theory::DenHartog(r, zeta).motion(gamma, breakaway);
    if (!motion) return {};
    return theory::Harmonic_motion{motion->amplitude, motion->fundamental_lag};
}

Data closed_curve(const HarmonicSweep& sweep, ClosedCurve curve) {
    const model::Oscillator& system = sweep.system;
    const double Rd = system.friction().sliding(model::Motion::forward, 0);
    const double Re = system.friction().holding(model::Motion::forward);
    std::vector<double> varied, amplitude, lag;
    for (std::size_t i = 0; i < curve_points; ++i) {
        const double x = sweep.low + (sweep.high - sweep.low) * static_cast<double>(i) / (curve_points - 1);
        const double M0 = std::fabs(sweep.frequency ? x : sweep.amplitude);
        const double r = sweep.frequency.value_or(x) * system.natural_period();
        const auto motion = M0 > 0 ? curve(r, system.damping_ratio(), Rd / M0, Re / M0) : std::nullopt;
        varied.push_back(x);
        amplitude.push_back(motion ? motion->amplitude * M0 / system.stiffness() : no_number);
        lag.push_back(motion ? motion->lag : no_number);
    }
    return {.columns = {column_of(sweep.column.name, std::move(varied), sweep.column.unit),
                        column_of("amplitude", std::move(amplitude), sweep.column.theta),
                        column_of("lag", std::move(lag), "rad")}};
}

struct LocatedPoint {
    double beside = 0, branch = 0;
    analysis::BranchPoint at = {};
    double curve = 0;
};

/// Numbers the curves that the points form. A point goes on the curve of the nearest point of its kind at the value of
/// the first parameter before, if that is near and has no nearer one. `points` are in the order of these values.
void number_curves(std::vector<LocatedPoint>& points, double range) {
    constexpr double near = 0.5;  // of the range, and of the amplitude
    const auto distance = [range](const LocatedPoint& a, const LocatedPoint& b) {
        const double larger = std::max({a.at.motion.amplitude, b.at.motion.amplitude, 1e-300});
        return a.at.kind != b.at.kind ? std::numeric_limits<double>::infinity()
                                      : std::fabs(a.at.parameter - b.at.parameter) / range +
                                            std::fabs(a.at.motion.amplitude - b.at.motion.amplitude) / larger;
    };
    const auto nearest = [&](const LocatedPoint& to, auto from, auto until) {
        return std::min_element(from, until,
                                [&](const auto& a, const auto& b) { return distance(to, a) < distance(to, b); });
    };
    double curves = 0;
    for (auto begin = points.begin(), before = begin; begin != points.end();) {
        const auto end = std::find_if(begin, points.end(), [&](const auto& p) { return p.beside != begin->beside; });
        for (auto point = begin; point != end; ++point) {
            const auto last = nearest(*point, before, begin);
            const bool goes_on = last != begin && distance(*point, *last) < near && nearest(*last, begin, end) == point;
            point->curve = goes_on ? last->curve : ++curves;
        }
        before = begin;
        begin = end;
    }
}

}  // namespace

std::vector<DataCompanion> closed_curves(const HarmonicSweep& sweep) {
    const model::Oscillator& system = sweep.system;
    const model::Lowered lowered(system);
    const bool even = lowered.braking(model::Motion::forward) == -lowered.braking(model::Motion::backward) &&
                      lowered.holding(model::Motion::forward) == lowered.holding(model::Motion::backward);
    if (!system.has_linear_spring() || lowered.has_remainder() || system.walls() || !even) return {};
    return {{"linearised", [sweep] { return closed_curve(sweep, linearised_at); }},
            {"den_hartog", [sweep] { return closed_curve(sweep, den_hartog_at); }}};
}

DataCompanion jumps_of(const std::vector<ResponsePart>& parts, const std::vector<VariedColumn>& over) {
    const VariedColumn& column = over.back();
    std::vector<double> beside, varied, from, to;
    std::vector<std::string> sweep, status;
    for (const ResponsePart& part : parts) {
        for (const analysis::MotionJump& jump : part.curve.jumps) {
            beside.push_back(part.beside);
            varied.push_back(jump.parameter);
            sweep.emplace_back(jump.rising ? "up" : "down");
            from.push_back(jump.from);
            to.push_back(jump.to);
            status.emplace_back(analysis::name(jump.landed.status));
        }
    }
    Data jumps{.columns = {column_of(column.name, varied, column.unit), column_of("sweep", std::move(sweep)),
                           column_of("from", from, column.theta), column_of("to", to, column.theta),
                           column_of("status", std::move(status))}};
    if (over.size() > 1) {
        jumps.columns.insert(jumps.columns.begin(), column_of(over.front().name, std::move(beside), over.front().unit));
    }
    const auto drawn = [varied, from, to, column = column] {
        std::vector<double> x, amplitude;
        for (std::size_t i = 0; i < varied.size(); ++i) {
            x.insert(x.end(), {varied[i], varied[i], no_number});
            amplitude.insert(amplitude.end(), {from[i], to[i], no_number});
        }
        return Data{.columns = {column_of(column.name, std::move(x), column.unit),
                                column_of("amplitude", std::move(amplitude), column.theta)}};
    };
    return {"jumps", [jumps] { return Data(jumps); }, drawn};
}

DataCompanion points_of(const std::vector<ResponsePart>& parts, const std::vector<VariedColumn>& over) {
    std::vector<LocatedPoint> located;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const ResponsePart& part : parts) {
        for (std::size_t i = 0; i < part.curve.branches.size(); ++i) {
            for (const analysis::BranchPoint& point : part.curve.branches[i]) {
                low = std::min(low, point.parameter), high = std::max(high, point.parameter);
                if (point.kind == analysis::BranchKind::point) continue;
                located.push_back({part.beside, static_cast<double>(part.branches_before + i + 1), point});
            }
        }
    }
    const bool is_plane = over.size() > 1;
    if (is_plane) {
        number_curves(located, high - low);
        std::stable_sort(located.begin(), located.end(),
                         [](const LocatedPoint& a, const LocatedPoint& b) { return a.curve < b.curve; });
    }
    std::vector<double> beside, varied, amplitude, period, branch, curve;
    std::vector<std::string> kind;
    for (const LocatedPoint& point : located) {
        const analysis::SteadyMotion& motion = point.at.motion;
        beside.push_back(point.beside);
        varied.push_back(point.at.parameter);
        kind.emplace_back(analysis::name(point.at.kind));
        amplitude.push_back(motion.amplitude);
        period.push_back(motion.period > 0 ? motion.period : no_number);
        branch.push_back(point.branch);
        curve.push_back(point.curve);
    }
    const VariedColumn& column = over.back();
    Data points{.columns = {column_of(column.name, varied, column.unit), column_of("kind", std::move(kind)),
                            column_of("amplitude", std::move(amplitude), column.theta),
                            column_of("period", std::move(period)), column_of("branch", std::move(branch))}};
    if (!is_plane) return {"points", [points] { return Data(points); }};
    points.columns.insert(points.columns.begin(), column_of(over.front().name, beside, over.front().unit));
    points.columns.push_back(column_of("curve", curve));
    points.pieces_of = "curve";
    const auto drawn = [over, beside, varied, curve] {
        std::vector<double> x, y;
        for (std::size_t i = 0; i < varied.size(); ++i) {
            if (i > 0 && curve[i] != curve[i - 1]) x.push_back(no_number), y.push_back(no_number);
            x.push_back(beside[i]);
            y.push_back(varied[i]);
        }
        return Data{.columns = {column_of(over.front().name, std::move(x)), column_of(over.back().name, std::move(y))}};
    };
    return {"points", [points] { return Data(points); }, drawn};
}

}  // namespace dinal::api
