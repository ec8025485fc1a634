#include "motion/engine/plain.hpp"

#include <utility>

#include "motion/engine/part.hpp"

namespace dinal::motion::engine {

Trajectory run(const Problem& problem, const Cut& cut) {
    const model::System system = model::as_system(problem.system);
    const model::Drive& drive = problem.drive;
    const auto* left = dynamic_cast<const Left*>(problem.carried);
    Run run = run_plain({.system = system,
                         .drive = drive,
                         .window = problem.window,
                         .rows = problem.rows,
                         .monitor = problem.monitor,
                         .limits = problem.limits,
                         .before = left != nullptr ? left->carry : nullptr,
                         .tolerance = cut.tolerance,
                         .longest = cut.longest,
                         .step = cut.step,
                         .pair = cut.pair,
                         .keeps_torques = true,
                         .history_bytes = problem.course_bytes,
                         .joined_elsewhere = true});
    Trajectory trajectory =
        part_of(system, drive, run, 0, problem.limits.dense ? std::optional(problem.system) : std::nullopt);
    trajectory.rows = Rows(std::move(run.table));
    return trajectory;
}

}  // namespace dinal::motion::engine
