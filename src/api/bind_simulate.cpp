#include "api/bind_simulate.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "terminal/progress.hpp"
#include "api/bind_excitation.hpp"
#include "lua/dinal_table.hpp"
#include "lua/interrupt.hpp"
#include "api/run.hpp"
#include "lua/user_function.hpp"

namespace dinal {

namespace {

constexpr std::string_view example = "sys:simulate{ M = M, theta0 = 1, t_end = 20, dt = 0.01 }";

/// The bytes that the rows will take; none when the window or the grid is wrong, which simulate() tells.
std::size_t bytes_of_rows(const Task& task) {
    if (!(task.window.start < task.window.end)) {
        return 0;
    }
    const auto grid = task.rows.within(task.window);
    return grid ? std::min<std::size_t>(grid->count(), 1ULL << 50U) * column_count * sizeof(double) : 0;
}

/// A run may take half of the memory of the machine, and most of what the script may still have.
Limits limits_of(bool dense) {
    Limits limits{.dense = dense};
    const long pages = sysconf(_SC_PHYS_PAGES);
    const long page_size = sysconf(_SC_PAGESIZE);
    if (pages > 0 && page_size > 0) {
        limits.memory = static_cast<std::size_t>(pages) * static_cast<std::size_t>(page_size) / 2;
    }
    limits.memory = std::min(limits.memory, memory_left() / 4 * 3);
    return limits;
}

Grid asked_rows(const Options& options) {
    if (options.has("dt") == options.has("times")) {
        options.fail(options.has("dt") ? "dt and times exclude each other; give one of them"
                                       : fmt::format("dt or times is needed, for example {}", example));
    }
    if (options.has("times")) {
        return Grid::at(options.numbers("times"));
    }
    const double dt = options.number("dt");
    if (dt <= 0) {
        options.fail(fmt::format("dt = {:.6g} must be positive", dt));
    }
    return Grid::every(dt);
}

Integrator asked_integrator(lua_State* L, const Options& options) {
    if (!options.has("integrator")) {
        return Spectral{};
    }
    options.push("integrator");
    const auto* integrator = test<Integrator>(L, -1);
    if (integrator == nullptr) {
        options.wrong("integrator", "an integrator such as integrator.rk4{ h = 0.001 }");
    }
    lua_pop(L, 1);  // the table of options holds it on
    return *integrator;
}

Task asked_task(lua_State* L, const Options& options, const Oscillator& system) {
    const Grid rows = asked_rows(options);
    options.push("M");
    Task task{.system = system,
              .excitation = to_excitation(L, -1, "sys:simulate: M"),
              .initial = {.theta = options.number("theta0", 0), .velocity = options.number("velocity0", 0)},
              .window = {.start = options.number("t_start", 0)},
              .rows = rows,
              .integrator = asked_integrator(L, options)};
    lua_pop(L, 1);
    const std::vector<double>& times = rows.times();
    // The latest time and not the last one: times that do not increase are an error of their own.
    task.window.end =
        options.has("t_end") || times.empty() ? options.number("t_end") : *std::max_element(times.begin(), times.end());
    return task;
}

void set_partial(lua_State* L) {
    push_dinal_table(L);
    lua_insert(L, -2);
    lua_setfield(L, -2, "partial");
    lua_pop(L, 1);
}

}  // namespace

int run_task(lua_State* L, const Options& options, Origin origin, double from, bool dense, const Compute& compute) {
    const std::size_t bytes = bytes_of_rows(origin);
    const double to = origin.window.end;
    Run run{.trajectory = {}, .origin = std::move(origin)};
    make_room(L, bytes);
    const Limits limits = limits_of(dense);
    if (bytes <= limits.memory) {
        run.rows = MemoryCharge(bytes);  // now, because M may want memory, too
    }

    CallState call(L);
    Progress progress = Progress::of_time(from, to);
    const auto monitor = [&progress](double t) {
        progress.advance(t);
        return !interrupt_requested();
    };
    auto result = compute(*run.origin, monitor, limits);
    if (!result) {
        options.fail(result.error().sentence);
    }
    run.trajectory = std::move(result).value();
    if (call.failed() && interrupt_requested()) {
        run.trajectory.outcome = Outcome::interrupted;  // M was stopped, it did not fail
    }
    const bool interrupted = run.trajectory.outcome == Outcome::interrupted;
    push_run(L, std::move(run));
    if (call.failed() || interrupted) {
        set_partial(L);
        call.failed() ? call.raise_error() : raise_interrupted(L);
    }
    return 1;
}

int simulate_system(lua_State* L) {
    const Oscillator& system = self<Oscillator>(L, 1, example);
    const Options options(L, 2, "sys:simulate", example,
                          {"M", "theta0", "velocity0", "t_start", "t_end", "dt", "times", "integrator", "dense"});
    const Task task = asked_task(L, options, system);
    const auto compute = [](const Task& asked, const Monitor& monitor, const Limits& limits) {
        return simulate(asked.system, asked.excitation, asked.initial, asked.window, asked.rows, asked.integrator,
                        monitor, limits);
    };
    // What M refers to is written down before M runs, because it may change that.
    return run_task(L, options, origin_of(L, task), task.window.start, options.boolean("dense", true), compute);
}

}  // namespace dinal
