#include "motion/rk4/rk4.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include "model/functions.hpp"
#include "model/springs.hpp"
#include "motion/engine/part.hpp"
#include "motion/rk4/rk4_engine.hpp"

namespace dinal::motion::rk4 {

namespace {

/// Evaluates the motion by repeating steps from the previous checkpoint, bit for bit as in the run.
class Replay final : public Course {
public:
    Replay(const Problem& problem, const Rk4& method)
        : Course(problem.system), drive_(problem.drive), method_(method), window_(problem.window) {}

    text::Expected<model::State> at(double t) const override;

    Checkpoints<Rk4Checkpoint> checkpoints{0};

private:
    model::Drive drive_;
    Rk4 method_;
    Window window_;
};

/// Also checks that the next checkpoint is reproduced to the last bit, which fails if a script in M has changed since.
text::Expected<model::State> Replay::at(double t) const {
    const auto grid = Grid::at({t}).within(window_);
    if (!grid) return grid.error();
    const Monitor monitor;
    const Limits limits;
    const Problem problem{system(), drive_, window_, *grid, monitor, limits};
    Run run;
    RowWriter rows(system(), *grid, run);
    Rk4Engine engine(problem, method_, rows, nullptr, nullptr);

    const std::size_t step = engine.steps().at(t);
    const Rk4Checkpoint* next = checkpoints.after(step);
    // If no later checkpoint exists, the replay goes only to the end of the step.
    const std::size_t last = next != nullptr ? next->step : std::min(step + 1, engine.steps().count);
    engine.run(checkpoints.before(step), last);
    if (run.size() > 0 && rows.next_row() == 0) {
        return text::error("M failed between the rows near t = {:.6g}: it no longer returns a number there", t);
    }
    if (next != nullptr) {
        const Rk4Checkpoint here = engine.here(last);
        if (here.state.theta != next->state.theta || here.state.velocity != next->state.velocity) {
            return text::Error{"M has changed since the run: simulate again to evaluate it between the rows"};
        }
    }
    return model::State{run.rows(0, 1), run.rows(0, 2)};
}

}  // namespace

Run Rk4::run(const Problem& problem) const {
    if (problem.more) return engine::run(problem, cut());
    Run run;
    RowWriter rows(problem.system, problem.rows, run);
    std::shared_ptr<Replay> replay;
    if (problem.limits.dense) replay = std::make_shared<Replay>(problem, *this);
    std::vector<model::Event> events;
    Rk4Engine engine(problem, *this, rows, &events, replay ? &replay->checkpoints : nullptr);
    if (replay) replay->checkpoints = Checkpoints<Rk4Checkpoint>(engine.steps().count);

    run_whole(engine, problem, rows, events, std::move(replay), run);
    // This engine only samples M, so the mass cannot rest on a jump of it; in the general engine it can.
    if (run.outcome == model::Outcome::chattering && problem.drive.M().has_feedback())
        return engine::run(problem, cut());
    const bool samples = problem.drive.M().has_script() || problem.system.spring().as<model::springs::UserSpring>() ||
                         model::user_law(problem.system.friction());
    if (samples) run.gap = run.unproven = engine.steps().h / 2;
    return run;
}

namespace {

/// |R(z)| - 1 for RK4's R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24, accurate for small z: |R|^2 - 1 = 2 Re(w) + |w|^2 with w
/// = R - 1.
double amplification_excess(std::complex<double> z) {
    const std::complex<double> w = z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)));
    return 2 * w.real() + std::norm(w);
}

/// The boundary of RK4's stability region in the direction of `lambda` (a unit vector, left half-plane).
double stable_radius(std::complex<double> lambda) {
    if (lambda.real() == 0) return 2 * std::numbers::sqrt2;  // on this axis the excess is r^6 (r^2/8 - 1)/72
    double inside = 0;
    double outside = 4;  // the region ends before |z| = 3.4 in every direction
    // The region is star-shaped about 0 in the left half-plane, so bisection finds the only boundary.
    for (int i = 0; i < 60; ++i) {
        const double r = (inside + outside) / 2;
        (amplification_excess(r * lambda) <= 0 ? inside : outside) = r;
    }
    return inside;
}

}  // namespace

double stability_limit(const model::Oscillator& system) {
    if (!system.has_spring()) return stable_radius({-1, 0}) / (system.damping() / system.inertia());
    const double w0 = system.natural_frequency();
    const double zeta = system.damping_ratio();
    if (zeta < 1) {
        return stable_radius({-zeta, std::sqrt((1 - zeta) * (1 + zeta))}) / w0;
    }
    // Both roots are real: the fast one decides.
    return stable_radius({-1, 0}) / (w0 * (zeta + std::sqrt((zeta - 1) * (zeta + 1))));
}

std::optional<text::Error> Rk4::wrong_for(const model::Oscillator& system,
                                          const model::Excitation& /*excitation*/) const {
    const double limit = stability_limit(system);
    // A step that equals the limit to the printed digits is accepted.
    if (h <= limit * (1 + 1e-12)) return {};
    if (!system.has_spring()) {
        return text::Error{
            .sentence = fmt::format("h = {:.6g} exceeds the stability limit {:.6g} of rk4 (C/I = {:.6g}): "
                                    "use h <= {:.3g}",
                                    h, limit, system.damping() / system.inertia(), 0.999 * limit),
            .option = "h"};
    }
    return text::Error{
        .sentence = fmt::format(
            "h = {:.6g} exceeds the stability limit {:.6g} of rk4 (w0 = {:.6g}, zeta = {:.4g}): use h <= {:.3g}", h,
            limit, system.natural_frequency(), system.damping_ratio(), 0.999 * limit),
        .option = "h"};
}

}  // namespace dinal::motion::rk4
