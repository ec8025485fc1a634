// sys:steady{ ... } and run:steady{ ... }, and the run of what they found.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "api/bind_excitation.hpp"
#include "api/bind_simulate.hpp"
#include "api/run.hpp"
#include "api/steady_answer.hpp"

namespace dinal::api {
namespace {

int push_steady(lua_State* L, const lua::Options& options, analysis::SteadyQuestion question) {
    const auto steady = std::make_shared<Steady>(Steady{std::move(question), {}});
    const auto note = watched_memories(L, options, steady->question.excitation, false);
    asking(L, steady->question.extras, [&](const motion::Monitor& monitor) {
        steady->motion = analysis::steady_motion(steady->question, monitor);
    });
    const model::Outcome outcome = steady->motion.outcome;
    if (outcome == model::Outcome::unresolved || outcome == model::Outcome::chattering ||
        outcome == model::Outcome::excitation_not_finite) {
        options.fail({fmt::format("the motion could not be followed: {}", model::sentence(outcome))});
    }
    note(nullptr);
    check_function(options, steady->motion);
    lua::push<SteadyHandle>(L, steady);
    return 1;
}

/// The state of the run at the last beginning of a period of M in it.
model::State state_at_period(const motion::Trajectory& trajectory, const analysis::Drive& drive) {
    const double n = std::floor((trajectory.t_stop - drive.start) / drive.period);
    const double t = drive.start + n * drive.period;
    if (t >= trajectory.t_start) {
        if (const auto state = trajectory.at(t)) return *state;
    }
    return trajectory.state_at_stop;
}

}  // namespace

bool push_kept(lua_State* L, const char* name) {
    if (lua_getiuservalue(L, 1, 1) != LUA_TTABLE) {
        lua_pop(L, 1);
        return false;
    }
    lua_getfield(L, -1, name);
    lua_remove(L, -2);
    if (!lua_isnil(L, -1)) return true;
    lua_pop(L, 1);
    return false;
}

void keep(lua_State* L, const char* name) {
    if (lua_getiuservalue(L, 1, 1) != LUA_TTABLE) {
        lua_pop(L, 1);
        lua_newtable(L);
        lua_pushvalue(L, -1);
        lua_setiuservalue(L, 1, 1);
    }
    lua_pushvalue(L, -2);
    lua_setfield(L, -2, name);
    lua_pop(L, 1);
}

void check_function(const lua::Options& options, const analysis::SteadyMotion& motion) {
    if (motion.contradiction) options.fail({model::sentence_with_cure(*motion.contradiction)});
}

/// One period, as a run of 400 rows from row to row; kept, so that s.run is the same run each time.
int run_of_steady(lua_State* L) {
    const SteadyHandle s = lua::self<SteadyHandle>(L, 1, "s.run");
    if (!is_found(*s)) {
        lua_pushnil(L);
        return 1;
    }
    if (push_kept(L, "run")) return 1;
    if (s->rig) {
        run_of_rig(L, *s);
        keep(L, "run");
        return 1;
    }
    constexpr double rows = 400;
    if (s->motion.settled && s->motion.asked) {
        const analysis::SteadyQuestion& asked = *s->motion.asked;
        source::Task task{.system = asked.system,
                          .excitation = asked.excitation,
                          .initial = asked.initial,
                          .window = {.start = s->motion.settled->t_start, .end = s->motion.settled->t_stop},
                          .rows = motion::Grid::every(s->motion.period / rows),
                          .integrator = motion::integrator_for(asked.system, asked.excitation, asked.extras),
                          .extras = asked.extras};
        Run found{.trajectory = *s->motion.settled, .origin = source::origin_of(L, std::move(task))};
        push_run(L, std::make_shared<const Run>(std::move(found)));
        keep(L, "run");
        return 1;
    }
    if (s->motion.settled) {
        // What led there is a part of the run that is asked for again, and its rows are those of its last period.
        const motion::Trajectory& last = *s->motion.settled;
        const auto times = last.column(motion::Column::t);
        source::Task whole{.system = s->question.system,
                           .excitation = s->question.excitation,
                           .initial = s->question.initial,
                           .window = {.start = s->question.drive.start, .end = last.t_stop},
                           .rows = motion::Grid::at({times.begin(), times.end()}),
                           .integrator = {},
                           .extras = s->question.extras};
        Run found{.trajectory = last, .origin = source::origin_of(L, whole)};
        push_run(L, std::make_shared<const Run>(std::move(found)));
        keep(L, "run");
        return 1;
    }
    if (s->question.is_timeless()) {  // at rest there is no period
        lua_pushnil(L);
        return 1;
    }
    const double start = s->question.drive.start, length = s->motion.period;
    source::Task task{.system = s->question.system,
                      .excitation = s->question.excitation,
                      .initial = s->motion.start,
                      .window = {.start = start, .end = start + length},
                      .rows = motion::Grid::every(length / rows),
                      .integrator = {}};
    Run made{.trajectory = {}, .origin = source::origin_of(L, task)};
    asking(L, [&](const motion::Monitor& monitor) {
        auto result = motion::simulate(task.system, task.excitation, task.initial, task.window, task.rows,
                                       task.integrator, monitor);
        if (result) made.trajectory = std::move(result).value();
    });
    push_run(L, std::make_shared<const Run>(std::move(made)));
    keep(L, "run");
    return 1;
}

analysis::Drive drive_or_fail(lua_State* L, const lua::Options& options, const analysis::SteadyQuestion& question,
                              const std::optional<double>& period) {
    const model::Excitation& excitation = question.excitation;
    std::optional<analysis::Drive> drive;
    asking(L, question.extras,
           [&](const motion::Monitor&) { drive = analysis::drive_of(excitation, question.extras, question.initial); });
    const bool scripts = excitation.has_script() || question.extras.belt.has_script() ||
                         question.extras.base.has_script() || !question.extras.states.empty();
    if (!drive && !period) {
        options.fail(
            {.sentence = scripts ? "the period of M is not known; give it with period = ..."
                                 : "the terms of M have no common period, so no motion is periodic; make a run and use "
                                   "run:spectrum",
             .option = "period"});
    }
    if (period) drive = analysis::Drive{drive ? drive->start : 0, *period};
    if (period || (excitation.has_script() && drive->period > 0)) {
        std::optional<text::Error> wrong;
        asking(L, question.extras, [&](const motion::Monitor&) {
            wrong = question.extras.any() ? analysis::not_periodic(excitation, question.extras, *drive)
                                          : analysis::not_periodic(excitation, *drive);
        });
        if (wrong) options.fail(*wrong);
    }
    return *drive;
}

std::optional<double> period_or_fail(const lua::Options& options, const std::optional<double>& period,
                                     const std::optional<double>& frequency, const std::optional<double>& omega) {
    if ((period ? 1 : 0) + (frequency ? 1 : 0) + (omega ? 1 : 0) > 1) {
        options.fail(
            {.sentence = "period, frequency and omega exclude each other; give one of them", .option = "period"});
    }
    if (frequency) return 1 / *frequency;
    if (omega) return 2 * std::numbers::pi / *omega;
    return period;
}

/// Functions in M that repeat say so, as native terms or by themselves.
void find_period(lua_State* L, analysis::SteadyQuestion& question) {
    const auto terms = terms_alone(L, question.system, question.excitation, 0, model::never, question.extras);
    question.excitation = terms ? *terms : with_periods(L, question.excitation);
}

int steady_of_system(lua_State* L) {
    const model::Oscillator system = lua::self<model::Oscillator>(L, 1, steady_call.example);
    const lua::Options options(L, 2, steady_call);
    SteadyOptions asked;
    options.fill(asked);
    asked.period = period_or_fail(options, asked.period, asked.frequency, asked.omega);
    if (const auto& walls = system.walls()) {
        if (const auto beyond = walls->crossed_by(asked.theta0)) options.fail(*beyond);
    }
    options.push("M");
    analysis::SteadyQuestion question{.system = system,
                                      .excitation = to_excitation(L, -1, "sys:steady: M", "M"),
                                      .drive = {},
                                      .periods = asked.periods.value_or(0),
                                      .initial = {asked.theta0, asked.velocity0},
                                      .extras = read_extras(L, options)};
    lua_pop(L, 1);
    check_relays(options, question.excitation, question.extras);
    if (!asked.period) find_period(L, question);
    question.drive = drive_or_fail(L, options, question, asked.period);
    return push_steady(L, options, std::move(question));
}

int steady_of_run(lua_State* L) {
    const RunHandle run = lua::self<RunHandle>(L, 1, steady_run_call.example);
    const lua::Options options(L, 2, steady_run_call);
    SteadyOptions asked;
    options.fill(asked);
    if (run->whole) options.fail({"ask the system for its steady motion: rig:steady{ ... } with the M of this run"});
    asked.period = period_or_fail(options, asked.period, asked.frequency, asked.omega);
    if (!run->origin) options.fail({"a run read from a file has no system and no M"});
    const source::Task& task = *run->origin;
    analysis::SteadyQuestion question{.system = task.system,
                                      .excitation = task.excitation,
                                      .drive = {},
                                      .periods = asked.periods.value_or(0),
                                      .initial = run->trajectory.state_at_stop,
                                      .extras = task.extras};
    const motion::Trajectory& ended = run->trajectory;
    for (std::size_t i = 0; i < ended.state_count(); ++i) question.extras.states[i].start = ended.carried->states[i];
    if (!asked.period) find_period(L, question);
    question.drive = drive_or_fail(L, options, question, asked.period);
    if (question.extras.any()) {
        question.drive.start = std::max(question.drive.start, ended.t_stop);
    } else if (!question.is_timeless()) {
        asking(L, [&](const motion::Monitor&) { question.initial = state_at_period(ended, question.drive); });
    }
    return push_steady(L, options, std::move(question));
}

}  // namespace dinal::api
