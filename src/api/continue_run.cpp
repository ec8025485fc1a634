// run:continue{ t_end }: a run goes on from where it ended.
#include <fmt/format.h>

#include <algorithm>

#include "api/bodies.hpp"
#include "model/controller.hpp"

namespace dinal::api {

namespace {

/// The times of the run until it ended, then the new ones; without these, what it had not come to before t_end.
motion::Grid asked_rows(const lua::Options& options, const MoreTime& asked, const motion::Trajectory& so_far,
                        const source::Task& task, double t_end) {
    const std::span<const double> times = task.rows.times();
    std::vector<double> more = asked.times.value_or(std::vector<double>());
    if (!more.empty() && more.front() <= so_far.t_stop) {
        options.fail("times", fmt::format("times[1] = {} must be after t = {}, where the run ended", more.front(),
                                          so_far.t_stop));
    }
    if (const auto wrong = motion::Grid::at(more).within({so_far.t_stop, t_end}); !wrong) {
        options.fail(wrong.error());
    }
    const double kept = asked.times ? so_far.t_stop : t_end;
    const auto end = std::upper_bound(times.begin(), times.end(), kept);
    return task.rows.followed_by(static_cast<std::size_t>(end - times.begin()), std::move(more));
}

/// t_end, the last of the times, or where a run that was stopped should have ended.
double asked_end(const lua::Options& options, const MoreTime& asked, const motion::Trajectory& so_far,
                 const source::Task& task) {
    if (asked.t_end) {
        return *asked.t_end;
    }
    if (asked.times && !asked.times->empty()) {
        return *std::max_element(asked.times->begin(), asked.times->end());
    }
    if (so_far.t_stop < task.window.end) {
        return task.window.end;
    }
    options.fail("t_end", fmt::format("the run reached its end at t = {:.6g}: give a later end, for example {}",
                                      so_far.t_stop, continue_call.example));
}

}  // namespace

int continue_run(lua_State* L) {
    const RunHandle run = lua::self<RunHandle>(L, 1, continue_call.example);  // kept: M may drop the last reference
    const lua::Options options(L, 2, continue_call);
    MoreTime asked;
    options.fill(asked);
    const motion::Trajectory& so_far = run->trajectory;
    if (run->whole && !run->whole->system->named) return continue_one_body(L, options, run->whole, asked);
    if (run->whole) {
        options.fail({"a body cannot go on by itself: continue the run of all bodies, run:continue{ t_end = 40 }"});
    }
    if (!run->origin) {
        options.fail(
            {"a run read from a file cannot be continued; start one from its end with sys:simulate{ theta0, "
             "velocity0, t_start, ... }"});
    }
    source::Origin origin = *run->origin;
    for (const model::Component& component : origin.excitation.components()) {
        const auto* sampled = model::controller_of<model::SampledController>(component);
        if (sampled != nullptr && sampled->first && sampled->latest != run.get()) {
            options.fail(
                {"the function of excitation.sampled has been used in another run since: simulate this run again"});
        }
    }
    const bool spaced = origin.rows.dt() > 0;
    if (spaced && asked.times) {
        options.fail("times",
                     fmt::format("this run has a row every dt = {:.6g} and keeps dt; times are for runs with times",
                                 origin.rows.dt()));
    }
    origin.window.end = asked_end(options, asked, so_far, origin);
    if (!spaced) {
        origin.rows = asked_rows(options, asked, so_far, origin, origin.window.end);
    }
    const auto compute = [&so_far](const source::Task& task, const motion::Monitor& monitor,
                                   const motion::Limits& limits) {
        return motion::resume(task.system, task.excitation, so_far, task.window.end, task.rows, task.integrator,
                              monitor, limits, task.extras);
    };
    return run_task(L, options, std::move(origin), so_far.t_stop, so_far.course != nullptr, compute);
}

}  // namespace dinal::api
