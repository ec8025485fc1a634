#include "api/response_companions.hpp"

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

DataCompanion jumps_of(const analysis::ResponseCurve& curve, const VariedColumn& column) {
    const auto made = [jumps = curve.jumps, column] {
        std::vector<double> varied, from, to;
        std::vector<std::string> sweep, status;
        for (const analysis::MotionJump& jump : jumps) {
            varied.push_back(jump.parameter);
            sweep.emplace_back(jump.rising ? "up" : "down");
            from.push_back(jump.from);
            to.push_back(jump.to);
            status.emplace_back(analysis::name(jump.landed.status));
        }
        return Data{.columns = {column_of(column.name, std::move(varied), column.unit),
                                column_of("sweep", std::move(sweep)), column_of("from", std::move(from), column.theta),
                                column_of("to", std::move(to), column.theta), column_of("status", std::move(status))}};
    };
    const auto drawn = [jumps = curve.jumps, column] {
        std::vector<double> varied, amplitude;
        for (const analysis::MotionJump& jump : jumps) {
            varied.insert(varied.end(), {jump.parameter, jump.parameter, no_number});
            amplitude.insert(amplitude.end(), {jump.from, jump.to, no_number});
        }
        return Data{.columns = {column_of(column.name, std::move(varied), column.unit),
                                column_of("amplitude", std::move(amplitude), column.theta)}};
    };
    return {"jumps", made, drawn};
}

DataCompanion points_of(const analysis::ResponseCurve& curve, const VariedColumn& column) {
    std::vector<double> varied, amplitude, period, branch;
    std::vector<std::string> kind;
    for (std::size_t i = 0; i < curve.branches.size(); ++i) {
        for (const analysis::BranchPoint& point : curve.branches[i]) {
            if (point.kind == analysis::BranchKind::point) continue;
            varied.push_back(point.parameter);
            kind.emplace_back(analysis::name(point.kind));
            amplitude.push_back(point.motion.amplitude);
            period.push_back(point.motion.period > 0 ? point.motion.period : no_number);
            branch.push_back(static_cast<double>(i + 1));
        }
    }
    const Data points{.columns = {column_of(column.name, std::move(varied), column.unit),
                                  column_of("kind", std::move(kind)),
                                  column_of("amplitude", std::move(amplitude), column.theta),
                                  column_of("period", std::move(period)), column_of("branch", std::move(branch))}};
    return {"points", [points] { return Data(points); }};
}

}  // namespace dinal::api
