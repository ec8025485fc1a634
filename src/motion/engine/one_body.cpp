#include "motion/engine/one_body.hpp"

#include <utility>

#include "motion/engine/part.hpp"

namespace dinal::motion::engine {

model::Assembly assembly_of(const model::Oscillator& system) {
    model::Joint ground;
    ground.stiffness = system.stiffness(), ground.damping = system.damping();
    ground.spring = system.spring(), ground.friction.law = system.friction(), ground.walls = system.walls();
    return {.bodies = {{"", system.inertia()}}, .joints = {ground}, .named = false, .units = system.units()};
}

Trajectory run(const Problem& problem, const Cut& cut) {
    const model::Assembly system = assembly_of(problem.system);
    const model::Drive& drive = problem.drive;
    const auto* left = dynamic_cast<const Left*>(problem.carried);
    AssemblyRun run = run_plain({.system = system,
                                 .drive = drive,
                                 .window = problem.window,
                                 .rows = problem.rows,
                                 .monitor = problem.monitor,
                                 .limits = problem.limits,
                                 .before = left != nullptr ? left->carry : nullptr,
                                 .tolerance = cut.tolerance,
                                 .longest = cut.longest,
                                 .step = cut.step,
                                 .keeps_torques = true,
                                 .history_bytes = problem.course_bytes,
                                 .joined_elsewhere = true});
    Trajectory trajectory =
        part_of(system, drive, run, 0, problem.limits.dense ? std::optional(problem.system) : std::nullopt);
    trajectory.rows = Rows(std::move(run.table));
    return trajectory;
}

}  // namespace dinal::motion::engine
