// Runs of systems that have names or a friction that varies: how they are made, go on, and look from a body or link.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/bind_simulate.hpp"
#include "api/bodies.hpp"
#include "api/run.hpp"
#include "lua/interrupt.hpp"
#include "lua/user_function.hpp"
#include "motion/engine/modes.hpp"
#include "motion/engine/one_body.hpp"
#include "motion/engine/part.hpp"
#include "source/origin.hpp"
#include "terminal/progress.hpp"

namespace dinal::api {

namespace engine = motion::engine;

namespace {

/// Whether it is known between the rows. A run that ended where it began has no stretch that takes memory.
bool keeps_motion(const engine::AssemblyRun& run) {
    return run.history != nullptr && (run.history->bytes() > 0 || run.t_stop == run.t_start);
}

/// The joint as a system of one body; none where the motion between the rows is not known.
std::optional<model::Oscillator> seen_alone(const BodiesRun& run, std::size_t joint) {
    if (!keeps_motion(run.run)) return {};
    const auto made = engine::seen_alone(*run.system, joint);
    return made ? std::optional(made.value()) : std::nullopt;
}

/// The run of all bodies: all columns and events, but no motion between the rows, which is that of its parts.
motion::Trajectory trajectory_of(const BodiesRun& run) {
    motion::Trajectory all = engine::part_of(*run.system, run.drive, run.run, 0, {});
    if (all.rough) all.rough->other_integrators = false;
    all.own_names = engine::column_names_of(*run.system, run.drive);
    all.rows = motion::Rows(run.run.table);
    std::vector<model::Event> events;
    std::copy_if(run.run.events.begin(), run.run.events.end(), std::back_inserter(events),
                 [](const model::Event& e) { return e.user < 0 || e.where == 0; });  // those of the user once
    all.events = motion::Growing<model::Event>(std::move(events));
    return all;
}

/// As seen from this body or link, or from all of them.
std::shared_ptr<Run> seen_from(const BodiesRunHandle& run, std::optional<std::size_t> joint) {
    auto seen = std::make_shared<Run>();
    seen->trajectory =
        joint ? engine::part_with_rows(*run->system, run->drive, run->run, *joint, seen_alone(*run, *joint))
              : trajectory_of(*run);
    seen->whole = run, seen->joint = joint;
    seen->units = run->system->units;
    seen->readings = run->readings;
    return seen;
}

}  // namespace

RunHandle part_of(const BodiesRunHandle& run, std::size_t joint) {
    run->parts.resize(run->system->joints.size());
    if (RunHandle known = run->parts[joint].lock()) return known;
    auto made = seen_from(run, joint);
    run->parts[joint] = made;
    return made;
}

void push_bodies_run(lua_State* L, const BodiesRunHandle& run) {
    lua::note_external_memory(L, run->run.table.own_bytes());
    push_run(L, seen_from(run, run->system->named ? std::nullopt : std::optional<std::size_t>(0)));
}

namespace {

std::size_t columns_of_run(const BodiesRun& run) {
    return engine::column_names_of(*run.system, run.drive).size();
}

/// The rows in this window, of which memory can hold all.
motion::Grid grid_within(const lua::Options& options, const BodiesRun& run, const motion::Grid& rows,
                         const motion::Window& window, const motion::Limits& limits) {
    motion::Grid grid = options.value_or_fail(rows.within(window));
    if (auto wrong = motion::wrong_rows(grid, columns_of_run(run), limits)) options.fail(*wrong);
    return grid;
}

/// How the integrator cuts the run into stretches.
engine::Cut cut_of(const motion::Integrator& integrator) {
    if (const auto* rk4 = std::get_if<motion::Rk4>(&integrator)) return {.longest = rk4->h, .step = rk4->h};
    const auto* spectral = std::get_if<motion::Spectral>(&integrator);
    return {.tolerance = spectral->tolerance, .longest = std::min(spectral->max_panel, spectral->widest_looks())};
}

/// The integrator asked for, which suits each mode of the bodies. Contacts that hold make none of them faster.
motion::Integrator asked_integrator(const lua::Options& options, const model::Assembly& system,
                                    const model::Drive& drive, const motion::Window& window) {
    const auto* asked = options.object<motion::Integrator>("integrator");
    if (asked == nullptr) return motion::Spectral{};
    const motion::MethodView method = *asked;
    if (!method.knows_more()) {
        options.fail("integrator",
                     fmt::format("{} is for one body with constant friction: use integrator.spectral or rk4",
                                 method.about().call.name));
    }
    for (const model::Oscillator& mode : engine::modes_of(system)) {
        for (const model::Excitation& load : drive.loads) {
            if (const auto wrong = motion::wrong_method(method, mode, load, window)) options.fail(*wrong);
        }
    }
    return *asked;
}

/// Runs what `problem` says, under the limits of the script.
int run_bodies(lua_State* L, const lua::Options& options, const std::shared_ptr<BodiesRun>& run,
               const motion::Window& window, const motion::Grid& rows, const motion::Limits& limits,
               std::shared_ptr<const engine::Carry> before = {}) {
    const motion::Grid grid = grid_within(options, *run, rows, window, limits);
    model::Excitation all;
    for (const model::Excitation& load : run->drive.loads) all = all + load;
    const auto note = watched_memories(L, options, all, before != nullptr);
    lua::CallState call(L);
    name_functions(call, *run->system, run->drive);
    call.set_span(window.end - window.start);
    terminal::Progress progress = terminal::Progress::of_time(window.start, window.end);
    const motion::Monitor monitor = [&progress](double t) {
        progress.advance(t);
        return !lua::interrupt_requested();
    };
    const engine::Cut cut = cut_of(run->integrator);
    run->run = engine::run({.system = *run->system,
                            .drive = run->drive,
                            .window = window,
                            .rows = grid,
                            .monitor = monitor,
                            .limits = limits,
                            .before = std::move(before),
                            .tolerance = cut.tolerance,
                            .longest = cut.longest,
                            .step = cut.step,
                            .keeps_torques = true});
    if (call.failed() && lua::interrupt_requested()) run->run.outcome = model::Outcome::interrupted;
    run->readings = readings_of(*run->system, run->drive, run->run.located, false);
    if (sees_all(*run->system, run->drive, run->run.located)) run->run.gap = run->run.unproven;
    const bool interrupted = run->run.outcome == model::Outcome::interrupted;
    push_bodies_run(L, run);
    note(run.get());
    if (call.failed() || interrupted) {
        set_partial(L);
        call.failed() ? call.raise_error() : lua::raise_interrupted(L);
    }
    return 1;
}

}  // namespace

int simulate_bodies(lua_State* L, const lua::Options& options, AssemblyHandle system) {
    RunOptions asked;
    options.fill(asked);
    if (!asked.t_end && asked.times.empty()) options.missing("t_end");
    auto run = std::make_shared<BodiesRun>();
    run->system = std::move(system);
    run->drive = asked_drive(L, options, *run->system);
    const motion::Window window{asked.t_start,
                                asked.t_end ? *asked.t_end : *std::max_element(asked.times.begin(), asked.times.end())};
    if (const auto wrong = window.complaint()) options.fail(*wrong);
    run->integrator = asked_integrator(options, *run->system, run->drive, window);
    run->dt = asked.dt.value_or(usual_dt(window, run->system->shortest_natural_period()));
    run->t_end = window.end, run->spaced = !options.has("times");
    run->set_up = source::set_up_lines(L, *run->system, run->drive);  // before the functions change what they refer to
    const motion::Grid grid = run->spaced ? motion::Grid::every(run->dt) : motion::Grid::at(asked.times);
    return run_bodies(L, options, run, window, grid, limits_of_run(asked.dense));
}

int continue_bodies(lua_State* L, const lua::Options& options, const BodiesRunHandle& first, const MoreTime& asked) {
    if (asked.times) options.fail("times", "this run goes on with a row every dt; times are for other runs");
    const double from = first->run.t_stop;
    const double end = asked_end(options, asked, from, first->t_end);
    if (!(end > from)) {
        options.fail("t_end", fmt::format("t_end = {} must be after t = {}, where the run ended", end, from));
    }
    auto run = std::make_shared<BodiesRun>();
    run->system = first->system, run->drive = first->drive, run->dt = first->dt;
    run->t_end = end, run->spaced = first->spaced, run->set_up = first->set_up;
    run->integrator = first->integrator;
    // The last row of the first run stands in the second one only where the spacing puts it there.
    const motion::Limits limits = limits_of_run(keeps_motion(first->run));
    const double start = first->run.t_start;
    const motion::Grid grid = grid_within(options, *run, motion::Grid::every(run->dt), {start, end}, limits);
    std::vector<double> times;
    for (auto row = static_cast<std::size_t>((from - start) / run->dt * (1 - 1e-12)); row < grid.count(); ++row) {
        if (grid.time(row) > from + 1e-15 * std::fabs(from)) times.push_back(grid.time(row));
    }
    run_bodies(L, options, run, {from, end}, motion::Grid::at(std::move(times)), limits, first->run.carry);
    std::size_t kept = first->run.table.size();
    const double last = kept == 0 ? start : first->run.table(kept - 1, 0);
    const double nearest = start + std::round((last - start) / run->dt) * run->dt;
    if (kept > 0 && std::fabs(last - nearest) > 1e-12 * std::max(1.0, std::fabs(last))) --kept;
    run->run.table =
        first->run.table.followed_by(kept, run->run.table, limits.memory / (columns_of_run(*run) * sizeof(double)));
    run->run.events.insert(run->run.events.begin(), first->run.events.begin(), first->run.events.end());
    run->run.t_start = start, run->run.begun = first->run.begun;
    lua_pop(L, 1);  // it was made of the second part
    push_bodies_run(L, run);
    return 1;
}

}  // namespace dinal::api
