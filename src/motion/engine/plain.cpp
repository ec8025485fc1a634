#include "motion/engine/plain.hpp"

#include "motion/engine/part.hpp"

namespace dinal::motion::engine {

Run run(const Problem& problem, const Cut& cut) {
    const model::System system = model::as_system(problem.system);
    const model::Drive& drive = problem.drive;
    Run run = run_plain({.system = system,
                         .drive = drive,
                         .window = problem.window,
                         .rows = problem.rows,
                         .monitor = problem.monitor,
                         .limits = problem.limits,
                         .before = problem.left != nullptr ? problem.left->carry : nullptr,
                         .tolerance = cut.tolerance,
                         .longest = cut.longest,
                         .step = cut.step,
                         .pair = cut.pair,
                         .keeps_torques = true,
                         .history_bytes = problem.course_bytes,
                         .joined_elsewhere = true});
    complete(run, system, drive, problem.limits.dense ? std::optional(problem.system) : std::nullopt);
    return run;
}

}  // namespace dinal::motion::engine
