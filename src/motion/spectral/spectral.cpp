// integrator.spectral: a run from beginning to end, and its motion between the rows.
#include <fmt/format.h>

#include "motion/methods.hpp"
#include "motion/spectral/spectral_engine.hpp"

namespace dinal::motion::spectral {

namespace {

/// The panels may take this part of the memory that the rows may.
constexpr std::size_t share_of_panels = 4;

text::Expected<model::State> state_at(const Panels& panels, double t) {
    if (panels.size() == 0) return text::Error{"the run has no motion to evaluate: it ended where it started"};
    if (t > panels.end() && !panels.complete()) {
        return text::Error{fmt::format(
            "the motion was kept up to t = {:.6g} only, for want of memory: take rows, or begin a run there",
            panels.end())};
    }
    return panels.at(t);
}

}  // namespace

Trajectory run(const Problem& problem, const Spectral& options) {
    Trajectory trajectory;
    RowWriter rows(problem.system, problem.rows, trajectory);
    std::shared_ptr<Panels> panels;
    if (problem.limits.dense) {
        panels = std::make_shared<Panels>(problem.system, problem.limits.memory / share_of_panels);
    }
    SpectralEngine engine(problem, options, rows, trajectory.events, panels.get());
    trajectory.outcome = engine.run();
    rows.finish();
    trajectory.t_start = problem.window.start;
    engine.leave(trajectory);
    if (panels) trajectory.dense = [panels](double t) { return state_at(*panels, t); };
    trajectory.panels = std::move(panels);
    return trajectory;
}

}  // namespace dinal::motion::spectral
