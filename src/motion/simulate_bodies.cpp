// Runs of any system: the general engine runs everything except one plain body.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "motion/engine/modes.hpp"
#include "motion/engine/part.hpp"
#include "motion/engine/plain.hpp"
#include "motion/resumed_rows.hpp"
#include "motion/simulate.hpp"

namespace dinal::motion {

namespace {

/// A run that ended where it began needs no memory for its motion.
bool keeps_motion(const engine::Run& run) {
    return run.history != nullptr && (run.history->bytes() > 0 || run.t_stop == run.t_start);
}

/// An error if the method does not support such systems, or suits not every mode of the bodies. Holding contacts slow
/// no mode down, so they are left out.
std::optional<text::Error> wrong_for_bodies(MethodView method, const model::System& system, const model::Drive& drive,
                                            const Window& window) {
    if (!method.cut()) {
        return text::Error{.sentence = fmt::format("{} is for one body without a name and with constant friction: use "
                                                   "integrator.spectral or rk4",
                                                   method.about().call.name),
                           .option = "integrator"};
    }
    for (const model::Oscillator& mode : engine::modes_of(system)) {
        for (const model::Excitation& load : drive.loads) {
            if (auto wrong = wrong_method(method, mode, load, window)) return wrong;
        }
    }
    return {};
}

text::Expected<engine::Run> run_of(const model::System& system, const model::Drive& drive, const Window& window,
                                   const Grid& rows, MethodView method, const Monitor& monitor, const Limits& limits,
                                   std::shared_ptr<const engine::Carry> before = {}) {
    if (auto wrong = window.complaint()) return *wrong;
    const auto grid = rows.within(window);
    if (!grid) return grid.error();
    if (auto wrong = wrong_rows(*grid, columns_of(system, drive), limits)) return *wrong;
    if (auto wrong = wrong_for_bodies(method, system, drive, window)) return *wrong;
    const Cut cut = *method.cut();
    return engine::run({.system = system,
                        .drive = drive,
                        .window = window,
                        .rows = *grid,
                        .monitor = monitor,
                        .limits = limits,
                        .before = std::move(before),
                        .tolerance = cut.tolerance,
                        .longest = cut.longest,
                        .step = cut.step,
                        .pair = cut.pair,
                        .keeps_torques = true});
}

}  // namespace

std::size_t columns_of(const model::System& system, const model::Drive& drive) {
    return system.is_plain() ? static_cast<std::size_t>(column_count) : engine::column_names_of(system, drive).size();
}

bool is_dense(const Trajectory& trajectory) {
    return trajectory.course != nullptr || (trajectory.bodies != nullptr && keeps_motion(*trajectory.bodies));
}

Trajectory seen_from(const model::System& system, const model::Drive& drive, std::shared_ptr<const engine::Run> run,
                     std::size_t joint) {
    std::optional<model::Oscillator> seen;
    if (keeps_motion(*run)) {
        if (auto made = model::oscillator_at(system, joint)) seen = std::move(made).value();
    }
    Trajectory part = engine::part_with_rows(system, drive, *run, joint, seen);
    part.bodies = std::move(run);
    return part;
}

Trajectory trajectory_of(const model::System& system, const model::Drive& drive,
                         std::shared_ptr<const engine::Run> run) {
    if (!system.named) return seen_from(system, drive, std::move(run), 0);
    Trajectory all = engine::part_of(system, drive, *run, 0, {});
    if (all.rough) all.rough->other_integrators = false;
    all.own_names = engine::column_names_of(system, drive);
    all.rows = Rows(run->table);
    std::vector<model::Event> events;
    std::copy_if(run->events.begin(), run->events.end(), std::back_inserter(events),
                 [](const model::Event& e) { return e.user < 0 || e.where == 0; });  // each user event only once
    all.events = Growing<model::Event>(std::move(events));
    all.bodies = std::move(run);
    return all;
}

text::Expected<Trajectory> simulate(const model::System& system, const model::Drive& drive, const Window& window,
                                    const Grid& rows, MethodView method, const Monitor& monitor, const Limits& limits) {
    if (system.is_plain()) {
        const auto alone = model::oscillator_at(system, 0);
        return alone ? simulate(*alone, drive, window, rows, method, monitor, limits) : alone.error();
    }
    auto run = run_of(system, drive, window, rows, method, monitor, limits);
    if (!run) return run.error();
    return trajectory_of(system, drive, std::make_shared<const engine::Run>(std::move(run).value()));
}

text::Expected<Trajectory> resume(const model::System& system, const model::Drive& drive, const Trajectory& so_far,
                                  double t_end, const Grid& rows, MethodView method, const Monitor& monitor,
                                  const Limits& limits) {
    if (system.is_plain()) {
        const auto alone = model::oscillator_at(system, 0);
        return alone ? resume(*alone, drive, so_far, t_end, rows, method, monitor, limits) : alone.error();
    }
    const engine::Run& first = *so_far.bodies;
    const std::size_t columns = columns_of(system, drive);
    const auto grid = grid_of_both(so_far, t_end, rows, columns, limits);
    if (!grid) return grid.error();
    auto [kept, times] = rows_to_come(so_far, *grid);
    auto second =
        run_of(system, drive, {so_far.t_stop, t_end}, Grid::at(std::move(times)), method, monitor, limits, first.carry);
    if (!second) return second.error();
    engine::Run whole = std::move(second).value();
    whole.table = first.table.followed_by(kept, whole.table, limits.memory / (columns * sizeof(double)));
    whole.events.insert(whole.events.begin(), first.events.begin(), first.events.end());
    whole.t_start = first.t_start, whole.begun = first.begun;
    whole.gap = std::max(first.gap, whole.gap);
    whole.unproven = std::max(first.unproven, whole.unproven);
    whole.noise = std::max(first.noise, whole.noise);
    whole.jumps += first.jumps;
    return trajectory_of(system, drive, std::make_shared<const engine::Run>(std::move(whole)));
}

}  // namespace dinal::motion
