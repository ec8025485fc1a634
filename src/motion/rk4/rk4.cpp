// integrator.rk4: a run from beginning to end, and its motion between the rows.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "motion/methods.hpp"
#include "motion/rk4/rk4_engine.hpp"

namespace dinal::motion::rk4 {

namespace {

/// What a replay needs; it outlives the run.
struct Record {
    model::Oscillator system;
    model::Excitation excitation;
    Rk4 options;
    model::State initial;
    Window window;
    Checkpoints<Rk4Checkpoint> checkpoints;
};

/// Runs the steps around t again from the checkpoint before, which gives what the run itself went through. The next
/// checkpoint must come out to the last bit; it does not when a scripted M has changed its mind since.
text::Expected<model::State> replay(const Record& record, double t) {
    const auto grid = Grid::at({t}).within(record.window);
    if (!grid) return grid.error();
    const Monitor monitor;
    const Limits limits;
    const Problem problem{record.system, record.excitation, record.initial, record.window, *grid, monitor, limits};
    Trajectory trajectory;
    RowWriter rows(record.system, *grid, trajectory);
    Rk4Engine engine(problem, record.options, rows, nullptr, nullptr);

    auto step = static_cast<std::size_t>((t - record.window.start) / record.options.h);
    while (step > 0 && engine.time(step) > t) --step;
    while (step < engine.steps() && engine.time(step + 1) <= t) ++step;
    const Rk4Checkpoint* next = record.checkpoints.after(step);
    // Only to the step's own end when the run broke off before another checkpoint.
    const std::size_t last = next != nullptr ? next->step : std::min(step + 1, engine.steps());
    engine.run(record.checkpoints.before(step), last);
    if (trajectory.size() > 0 && rows.next_row() == 0) {
        return text::Error{
            fmt::format("M failed between the rows near t = {:.6g}: it gives no number there any more", t)};
    }
    if (next != nullptr) {
        const Rk4Checkpoint here = engine.here(last);
        if (here.state.theta != next->state.theta || here.state.velocity != next->state.velocity) {
            return text::Error{
                "M is no longer what it was during the run: simulate again before asking between the rows"};
        }
    }
    return model::State{trajectory.rows(0, 1), trajectory.rows(0, 2)};
}

}  // namespace

Trajectory run(const Problem& problem, const Rk4& options) {
    Trajectory trajectory;
    RowWriter rows(problem.system, problem.rows, trajectory);
    auto record = std::make_shared<Record>(Record{problem.system, problem.excitation, options, problem.initial,
                                                  problem.window, Checkpoints<Rk4Checkpoint>(0)});
    const bool dense = problem.limits.dense;
    Rk4Engine engine(problem, options, rows, &trajectory.events, dense ? &record->checkpoints : nullptr);
    if (dense) record->checkpoints = Checkpoints<Rk4Checkpoint>(engine.steps());

    trajectory.outcome = engine.run();
    rows.finish();
    trajectory.t_start = problem.window.start;
    engine.leave(trajectory);
    if (dense) trajectory.dense = [record](double t) { return replay(*record, t); };
    return trajectory;
}

}  // namespace dinal::motion::rk4
