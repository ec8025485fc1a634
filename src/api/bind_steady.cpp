// sys:steady{ ... } and run:steady{ ... }, and the class of their result.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/steady_facts.hpp"
#include "api/bind_excitation.hpp"
#include "api/bind_simulate.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/lua_run.hpp"
#include "api/steady_answer.hpp"
#include "lua/values.hpp"
#include "model/controller.hpp"
#include "terminal/display.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::api {

// ---- the motion of all bodies, and as seen from one

namespace {

SteadyHandle seen_from(const SteadyHandle& whole, std::size_t joint) {
    analysis::SteadyQuestion question = whole->question.seen_at(joint);
    const RunHandle run = whole->run != nullptr ? part_of(whole->run, joint) : nullptr;
    std::shared_ptr<const motion::Run> seen;
    if (run) seen = {run, &run->result};
    analysis::SteadyMotion facts = analysis::seen_from(question, whole->motion, std::move(seen));
    return std::make_shared<Steady>(
        Steady{.question = std::move(question), .motion = std::move(facts), .run = run, .whole = whole});
}

/// The answer to a question about all bodies, or about a single unnamed body.
SteadyHandle made(lua_State* L, analysis::SteadyQuestion question, analysis::SteadyMotion motion) {
    auto whole = std::make_shared<Steady>(Steady{.question = std::move(question), .motion = std::move(motion)});
    if (whole->question.is_plain()) return whole;
    if (const auto& period = whole->motion.by_returns.of_bodies) {
        constexpr double rows = 400;
        source::Task task{.system = whole->question.system,
                          .drive = period->drive,
                          .window = {period->run.t_start, period->run.t_stop},
                          .rows = motion::Grid::every(whole->motion.period / rows),
                          .integrator = motion::Spectral{}};
        auto run = std::make_shared<LuaRun>();
        run->result = period->run;
        run->origin = std::make_shared<const source::Origin>(source::origin_of(L, std::move(task)));
        whole->run = std::move(run);
    }
    return whole->question.system->named ? whole : seen_from(whole, 0);
}

}  // namespace

double settles_or_fail(const lua::Options& options, const analysis::SteadyQuestion& question) {
    const auto settles = analysis::settles_after(question);
    if (settles) return *settles;
    options.fail("M",
                 "the controllers of M and what else drives the bodies have no common period of at most 1000 instants "
                 "or periods; run it for long and see run.load:cycle()");
}

namespace {

int body_of_steady(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const SteadyHandle s = lua::self<SteadyHandle>(L, 1, "s.load");
    if (!s->of_all()) return 0;
    const std::size_t joint =
        joint_named(L, lua_tostring(L, 2), *s->question.system, "this steady motion", steady_class);
    lua::push<SteadyHandle>(L, seen_from(s, joint));
    return 1;
}

}  // namespace

// ---- for one body or link

namespace {

using analysis::SteadyStatus;

bool is_moving(const Steady& s) {
    return s.motion.status == SteadyStatus::steady;
}

/// Returns s; raises an error if it is the motion of several bodies.
const Steady& only_one_body(lua_State* L, const Steady& s) {
    if (!s.of_all()) return s;
    lua::raise(L, "this motion has several bodies; choose one of them, such as s.{}.amplitude",
               s.question.system->bodies.front().name);
}

const analysis::SteadyShape& steady_shape(lua_State* L, const SteadyHandle& s) {
    only_one_body(L, *s);
    if (!s->shape) {
        call_checked(L, s->question, [&](const motion::Monitor& monitor) {
            s->shape = analysis::shape_of(s->question, s->motion, monitor);
        });
    }
    return *s->shape;
}

/// The motions from other starts, for all bodies.
const std::vector<SteadyHandle>& others_of(lua_State* L, const SteadyHandle& s) {
    Steady& all = s->whole ? *s->whole : *s;
    if (all.others) return *all.others;
    std::vector<analysis::OtherMotion> found;
    call_checked(L, all.question, [&](const motion::Monitor& monitor) {
        found = analysis::other_motions(all.question, all.motion, monitor);
    });
    all.others.emplace();
    for (auto& other : found) all.others->push_back(made(L, std::move(other.question), std::move(other.motion)));
    return *all.others;
}

// ---- fields: nil without such a motion

/// A fact about a motion that was found; none if nan, as for a rotating body.
template <auto fact>
auto found_fact(const Steady& s) {
    const auto value = std::invoke(fact, s.motion);
    bool known = is_found(s);
    if constexpr (std::is_floating_point_v<decltype(value)>) known = known && !std::isnan(value);
    return known ? std::optional(value) : std::nullopt;
}

template <auto fact>
auto fact_of_one(lua_State* L, const SteadyHandle& s) {
    return found_fact<fact>(only_one_body(L, *s));
}

std::optional<double> steady_period(const Steady& s) {
    const bool has_one = s.motion.status != SteadyStatus::none && s.motion.period != 0;
    return has_one ? std::optional(s.motion.period) : std::nullopt;
}

std::optional<double> steady_mean(lua_State* L, const SteadyHandle& s) {
    const double mean = is_found(*s) ? steady_shape(L, s).mean : std::nan("");
    return std::isnan(mean) ? std::nullopt : std::optional(mean);
}

template <auto angle>
std::optional<double> steady_shape_angle(lua_State* L, const SteadyHandle& s) {
    return is_moving(*s) ? steady_shape(L, s).*angle : std::nullopt;
}

std::optional<std::size_t> steady_stops(lua_State* L, const SteadyHandle& s) {
    return is_moving(only_one_body(L, *s)) ? std::optional(s->motion.stops) : std::nullopt;
}

std::optional<double> steady_growth(const Steady& s) {
    return s.motion.status == SteadyStatus::grows ? std::optional(s.motion.growth) : std::nullopt;
}

lua::Pushed steady_rest(lua_State* L, const SteadyHandle& s) {
    if (s->motion.status != SteadyStatus::adheres && s->motion.status != SteadyStatus::rest) {
        lua_pushnil(L);
        return {};
    }
    const analysis::SteadyMotion& motion = only_one_body(L, *s).motion;
    lua::push_value(L, std::array{motion.rest.first, motion.rest.second});
    lua::set_value(L, "lower", motion.rest.first);
    lua::set_value(L, "upper", motion.rest.second);
    return {};
}

std::optional<std::vector<lua::NamedNumbers>> steady_multipliers(const Steady& s) {
    if (!is_moving(s) || !s.motion.differentiable) return {};
    std::vector<lua::NamedNumbers> all;
    for (const auto& m : s.motion.multipliers) {
        all.push_back({{"re", m.real()}, {"im", m.imag()}, {"abs", std::abs(m)}});
    }
    return all;
}

lua::Pushed steady_unique(lua_State* L, const SteadyHandle& s) {
    const std::optional<bool>& unique = s->motion.unique;
    if (!is_found(*s)) {
        lua_pushnil(L);
    } else if (unique.value_or(false)) {
        lua_pushliteral(L, "proven");
    } else {
        !unique&& others_of(L, s).empty() ? lua::push_value(L, "not seen") : lua_pushboolean(L, 0);
    }
    return {};
}

std::optional<std::vector<SteadyHandle>> steady_others(lua_State* L, const SteadyHandle& s) {
    if (!is_found(*s)) return {};
    return others_of(L, s);
}

/// The motion as seen from the only body of a system, if it has only one.
SteadyHandle seen_from_only_body(const SteadyHandle& s) {
    return s->of_all() && s->question.system->joints.size() == 1 ? seen_from(s, 0) : s;
}

std::string steady_story(lua_State* L, const SteadyHandle& s) {
    const std::vector<SteadyHandle>& found = others_of(L, s);
    if (s->question.system->joints.size() > 1) {
        const Steady& all = s->whole ? *s->whole : *s;
        return analysis::description_of(all.question, all.motion, found.size());
    }
    std::vector<analysis::OtherMotion> others;
    for (const SteadyHandle& one : found) {
        const SteadyHandle other = seen_from_only_body(one);
        others.push_back({other->question, other->motion});
    }
    const SteadyHandle own = seen_from_only_body(s);
    return analysis::description_of(own->question, own->motion, steady_shape(L, own), others);
}

std::string steady_summary(lua_State*, const SteadyHandle& handle) {
    const SteadyHandle own = seen_from_only_body(handle);
    const Steady& s = *own;
    const analysis::SteadyMotion& m = s.motion;
    const ColumnUnits in(s.question.system->units);
    const auto number = [](double x, const std::string& unit) {
        return model::with_unit(fmt::format("{:.6g}", x), unit);
    };
    if (s.of_all() && is_found(s)) {
        if (m.status == SteadyStatus::adheres) return "adheres: nothing moves";
        if (m.status == SteadyStatus::rest) return m.stable ? "rest: the motion ends" : "rest, unstable";
        return m.period == 0 ? "steady: all bodies keep their velocities"
                             : fmt::format("steady: period {}, {}", number(m.period, in.t),
                                           text::counted(s.question.system->bodies.size(), "body"));
    }
    switch (m.status) {
        case SteadyStatus::steady:
            if (m.period == 0) {
                return std::isnan(m.amplitude) ? "steady: rotates at constant speed"
                                               : fmt::format("steady: theta = {}", number(m.low, in.theta));
            }
            if (std::isnan(m.amplitude)) {
                return fmt::format("steady: period {}, rotates, {} a period", number(m.period, in.t),
                                   text::counted(m.stops, "stop"));
            }
            return fmt::format("steady: period {}, amplitude {}, {} a period{}", number(m.period, in.t),
                               number(m.amplitude, in.theta), text::counted(m.stops, "stop"),
                               m.stable || !m.differentiable ? "" : ", unstable");
        case SteadyStatus::adheres:
            if (m.rest.first == m.rest.second)
                return fmt::format("adheres: rests at theta = {}", number(m.rest.first, in.theta));
            return fmt::format("adheres: rests anywhere from theta = {:.6g} to {}", m.rest.first,
                               number(m.rest.second, in.theta));
        case SteadyStatus::rest:
            return fmt::format("{} at theta = {}", m.stable ? "rest: the motion ends" : "rest, unstable,",
                               number(m.low, in.theta));
        case SteadyStatus::grows:
            if (s.question.is_timeless() || std::isinf(m.growth)) return "grows: without bound";
            return fmt::format("grows: by {} in each period of M", number(m.growth, in.theta));
        case SteadyStatus::none:
            break;
    }
    if (s.question.is_timeless()) return "none: no limit cycle was found";
    return fmt::format("none: nothing periodic was found in {} periods of M", m.maps);
}

#define DINAL_STEADY                                 \
    "sys = nondimensional{ friction_ratio = 0.4 }\n" \
    "s = sys:steady{ M = excitation.harmonic{ frequency = 0.4 } }\n"

constexpr lua::Member steady_members[] = {
    {lua::a_question<SteadyHandle,
                     [](lua_State* L, const SteadyHandle& s) { return text::wrapped(steady_story(L, s)); }>,
     {"s:explain() -> string",
      "Describes the motion, whether it is stable, and whether other starts lead to another one.",
      DINAL_STEADY "print(s:explain():match(\"It stops[^.]*\"))  --> It stops 2 times a period and is stuck for 31"}},
    {lua::a_value<SteadyHandle, [](const Steady& s) { return analysis::name(s.motion.status); }>,
     {"s.status -> string",
      "\"steady\"; \"adheres\": the mass never moves; \"rest\": the motion dies out; \"grows\": M supplies more "
      "energy than is dissipated; \"none\": no periodic motion was found. Fields without a value are nil.",
      DINAL_STEADY "print(s.status)  --> steady"}},
    {lua::a_value<SteadyHandle, steady_period>,
     {"s.period -> number", "The period of the motion, time units; nil at rest.",
      DINAL_STEADY "print(s.period)  --> 2.5"}},
    {lua::a_value<SteadyHandle, found_fact<&analysis::SteadyMotion::periods>>,
     {"s.periods -> integer", "The number of periods of M in one period of the motion; 1 unless it is subharmonic.",
      DINAL_STEADY "print(s.periods)  --> 1"}},
    {lua::a_value<SteadyHandle, fact_of_one<&analysis::SteadyMotion::amplitude>>,
     {"s.amplitude -> number", "Half the distance between the extremes of theta, rad.",
      DINAL_STEADY "print(string.format(\"%.4f\", s.amplitude))  --> 1.1111"}},
    {lua::a_value<SteadyHandle, fact_of_one<greatest_angle>>,
     {"s.peak -> number", "The greatest |theta|, rad.", DINAL_STEADY "print(s.peak >= s.amplitude)  --> true"}},
    {lua::a_value<SteadyHandle, steady_mean>,
     {"s.mean -> number", "The mean of theta over time, rad.",
      DINAL_STEADY "print(math.abs(s.mean) < 1e-9)  --> true"}},
    {lua::a_value<SteadyHandle, steady_shape_angle<&analysis::SteadyShape::lag>>,
     {"s.lag -> number",
      "The lag of the fundamental of theta behind that of M, rad in (-pi, pi]; nil if one of them has none or M "
      "depends on the motion.",
      "s = system{ I = 1, k = 1, C = 0.5 }:steady{ M = excitation.harmonic{ omega = 1 } }\n"
      "print(string.format(\"%.6f\", s.lag))  --> 1.570796"}},
    {lua::a_value<SteadyHandle, steady_shape_angle<&analysis::SteadyShape::peak_lag>>,
     {"s.peak_lag -> number", "The lag of the maximum of theta behind that of the fundamental of M, rad.",
      "s = system{ I = 1, k = 1, C = 0.5 }:steady{ M = excitation.harmonic{ omega = 1 } }\n"
      "print(string.format(\"%.6f\", s.peak_lag))  --> 1.570796"}},
    {lua::a_value<SteadyHandle, steady_stops>,
     {"s.stops -> integer", "The number of stops in a period; nil if it adheres.",
      DINAL_STEADY "print(s.stops)  --> 2"}},
    {lua::a_value<SteadyHandle, fact_of_one<&analysis::SteadyMotion::stuck>>,
     {"s.stuck -> number", "The fraction of a period for which it is stuck.",
      DINAL_STEADY "print(string.format(\"%.4f\", s.stuck))  --> 0.3154"}},
    {lua::a_value<SteadyHandle, steady_multipliers>,
     {"s.multipliers -> table",
      "The Floquet multipliers, each { re, im, abs }: the factors of small disturbances in one period. There are "
      "two, and one for each state; a limit cycle has one less, without the trivial one. nil with delayed and "
      "sampled controllers, and where the motion is not smooth.",
      "s = system{ I = 1, k = 1, C = 0.5 }:steady{ M = excitation.harmonic{ omega = 1 } }\n"
      "print(string.format(\"%.6f %.6f\", s.multipliers[1].abs, math.exp(-math.pi / 2)))  --> 0.207880 0.207880"}},
    {lua::a_value<SteadyHandle, found_fact<&analysis::SteadyMotion::stable>>,
     {"s.stable -> boolean", "true if no disturbance grows; if M has a memory, true if a run converged to this motion.",
      DINAL_STEADY "print(s.stable)  --> true"}},
    {lua::a_value<SteadyHandle, steady_unique>,
     {"s.unique -> string or false",
      "\"proven\": no other periodic motion exists; this is proven for linear springs with Re = Rd, no walls and "
      "M, belt and base of time alone. \"not seen\": sixteen other starts led to no other. false: others exist, in s.others or "
      "as a family.",
      DINAL_STEADY "print(s.unique)  --> proven"}},
    {lua::a_kept_value<SteadyHandle, steady_others>,
     {"s.others -> table",
      "The other motions found from sixteen other starts, a list of steady motions. Empty if the motion is unique, "
      "or one of a family.",
      "s = system{ I = 1, k = 4, C = 0.1, Rd = 0.3, Re = 0.6 }:steady{ belt = 0.1 }\n"
      "print(s.status, #s.others, s.others[1].status)  --> steady\t1\trest"}},
    {lua::a_value<SteadyHandle, found_fact<&analysis::SteadyMotion::symmetric>>,
     {"s.symmetric -> boolean", "The motion is symmetric: theta(t + T/2) = -theta(t).",
      DINAL_STEADY "print(s.symmetric)  --> true"}},
    {lua::a_value<SteadyHandle, steady_rest>,
     {"s.rest -> table", "If it adheres or comes to rest: { lower, upper }, the range of rest positions, rad.",
      "s = system{ I = 1, k = 2, Rd = 1 }:steady{ M = excitation.harmonic{ amplitude = 0.8, omega = 1 } }\n"
      "print(s.status, string.format(\"%.4f %.4f\", s.rest[1], s.rest[2]))  --> adheres\t-0.1000 0.1000"}},
    {lua::a_value<SteadyHandle, steady_growth>,
     {"s.growth -> number",
      "If it grows: the growth of the amplitude in a period of M, rad; math.huge if it grows "
      "faster and faster.",
      "s = nondimensional{ friction_ratio = 0.167 }:steady{ M = excitation.harmonic{ frequency = 1 } }\n"
      "print(string.format(\"%.6f\", s.growth))  --> 2.473593"}},
    {lua::a_kept_value<SteadyHandle, run_of_steady>,
     {"s.run -> run", "One period of the motion as a run with 401 rows; nil at rest.",
      DINAL_STEADY "print(#s.run, s.run.t_end)  --> 401\t2.5"}},
    {lua::a_text<SteadyHandle, steady_summary>,
     {"tostring(s) -> string", "The answer in one line.",
      DINAL_STEADY "print(s)  --> steady: period 2.5 T0, amplitude 1.11113 Mc/k, 2 stops a period"}},
};

#undef DINAL_STEADY

std::string steady_card(lua_State* L, int index, const terminal::Display& screen) {
    return text::wrapped(terminal::spelled(steady_summary(L, *lua::test<SteadyHandle>(L, index)), screen),
                         screen.width - 1);
}

}  // namespace

const lua::Class steady_class = {
    "steady motion",
    {"sys:steady{ ... }, run:steady{ ... } -> s",
     "The result of steady: a periodic motion and its properties, rest, or the reason why there is none. With "
     "several bodies s.load is the motion of the body `load`.",
     "s = nondimensional{}:steady{}\nprint(s.status)  --> rest"},
    steady_members,
    lua::add_class<SteadyHandle>,
    body_of_steady,
    steady_card};

// sys:steady{ ... } and run:steady{ ... }, and the run of the motion found.

namespace {

int push_steady(lua_State* L, const lua::Options& options, analysis::SteadyQuestion question) {
    if (!question.is_plain()) question.settles = settles_or_fail(options, question);
    const model::Excitation loads = question.drive.sum_of_loads();
    const auto note = watched_memories(L, options, loads, false);
    analysis::SteadyMotion found;
    call_checked(L, question,
                 [&](const motion::Monitor& monitor) { found = analysis::steady_motion(question, monitor); });
    check_motion(options, found);
    note(nullptr);
    lua::push<SteadyHandle>(L, made(L, std::move(question), std::move(found)));
    return 1;
}

/// The state at the beginning of the last period of M in the run.
model::State state_at_period(const motion::Run& result, const analysis::Repetition& repeats) {
    const double n = std::floor((result.t_stop - repeats.start) / repeats.period);
    const double t = repeats.start + n * repeats.period;
    if (t >= result.t_start) {
        if (const auto state = result.at(t)) return *state;
    }
    return result.state_at_stop;
}

}  // namespace

void check_motion(const lua::Options& options, const analysis::SteadyMotion& motion) {
    using model::Outcome;
    if (motion.outcome == Outcome::unresolved || motion.outcome == Outcome::chattering ||
        motion.outcome == Outcome::excitation_not_finite) {
        options.fail(text::error("the motion could not be followed: {}", model::sentence(motion.outcome)));
    }
    if (motion.contradiction) options.fail({model::sentence_with_cure(*motion.contradiction)});
}

namespace {

/// One period as a run with 400 rows; none at rest.
std::optional<LuaRun> period_as_run(lua_State* L, const Steady& s) {
    constexpr double rows = 400;
    const analysis::SteadyQuestion& asked =
        s.motion.by_returns.question && s.motion.by_returns.run ? *s.motion.by_returns.question : s.question;
    source::Task task{.system = asked.system,
                      .drive = asked.drive,
                      .window = {},
                      .rows = motion::Grid::every(s.motion.period / rows),
                      .integrator = {}};
    if (s.motion.by_returns.run) {
        // Its origin also repeats the approach to the motion; the rows are those of the last period.
        const motion::Run& last = *s.motion.by_returns.run;
        task.window = {.start = s.motion.by_returns.question ? last.t_start : asked.repeats.start, .end = last.t_stop};
        if (s.motion.by_returns.question) {
            task.integrator = motion::integrator_for(asked.body, asked.drive);
        } else {
            const auto times = last.column(motion::Column::t);
            task.rows = motion::Grid::at({times.begin(), times.end()});
        }
        return LuaRun{.result = last,
                      .origin = std::make_shared<const source::Origin>(source::origin_of(L, std::move(task)))};
    }
    if (asked.is_timeless()) return {};
    task.window = {.start = asked.repeats.start, .end = asked.repeats.start + s.motion.period};
    task.drive = {asked.drive.M(), s.motion.start};
    LuaRun made{.result = {}, .origin = std::make_shared<const source::Origin>(source::origin_of(L, task))};
    call_checked(L, [&](const motion::Monitor& monitor) {
        auto result = motion::simulate(*task.system, task.drive, task.window, task.rows, task.integrator, monitor);
        if (result) made.result = std::move(result).value();
    });
    return made;
}

}  // namespace

lua::Pushed run_of_steady(lua_State* L, const SteadyHandle& s) {
    RunHandle run = s->run;
    if (is_found(*s) && s->question.is_plain()) {
        if (auto period = period_as_run(L, *s)) run = std::make_shared<const LuaRun>(std::move(*period));
    }
    run ? push_run(L, run) : lua_pushnil(L);
    return {};
}

analysis::Repetition repetition_or_fail(lua_State* L, const lua::Options& options,
                                        const analysis::SteadyQuestion& question, const std::optional<double>& period) {
    const auto acting = analysis::acting_in(question);
    const auto is_script = [](const analysis::Acting& one) { return one.what->has_script(); };
    const bool scripts = !question.drive.states.empty() || std::ranges::any_of(acting, is_script);
    std::optional<analysis::Repetition> repeats;
    call_checked(L, question, [&](const motion::Monitor&) { repeats = analysis::repetition_of(question); });
    if (!repeats && !period) {
        options.fail("period",
                     scripts ? "the period of M is not known; give it with period = ..."
                             : "the terms of M have no common period, so no motion is periodic; make a run and use "
                               "run:spectrum");
    }
    if (period) repeats = analysis::Repetition{repeats ? repeats->start : 0, *period};
    if (repeats->period > 0 && (period || scripts)) {
        std::optional<text::Error> wrong;
        call_checked(L, question, [&](const motion::Monitor&) { wrong = analysis::not_periodic(question, *repeats); });
        if (wrong) options.fail(*wrong);
    }
    return *repeats;
}

std::optional<double> asked_period(const lua::Options& options) {
    PeriodOptions asked;
    options.fill(asked);
    if ((asked.period ? 1 : 0) + (asked.frequency ? 1 : 0) + (asked.omega ? 1 : 0) > 1) {
        options.fail("period", "period, frequency and omega exclude each other; give one of them");
    }
    if (asked.frequency) return 1 / *asked.frequency;
    if (asked.omega) return 2 * std::numbers::pi / *asked.omega;
    return asked.period;
}

namespace {

/// Makes repeating functions in M of a plain system native terms, and declares the periods of all others that are read.
void find_period(lua_State* L, analysis::SteadyQuestion& question) {
    model::Drive& drive = question.drive;
    const auto terms = question.is_plain() ? terms_alone(L, *question.system, drive, 0, model::never) : std::nullopt;
    if (terms) drive.loads = {*terms};
    for (auto* acting : {&drive.loads, &drive.belts}) {
        for (model::Excitation& one : *acting) one = with_periods(L, one);
    }
    drive.base = with_periods(L, drive.base);
}

}  // namespace

int steady_of_system(lua_State* L) {
    const SystemHandle system = lua::self<SystemHandle>(L, 1, steady_call.example);
    const lua::Options options(L, 2, steady_call);
    SteadyOptions asked;
    options.fill(asked);
    const std::optional<double> period = asked_period(options);
    auto question = options.value_or_fail(analysis::SteadyQuestion::of(system, asked_drive(L, options, *system)));
    question.periods = asked.periods.value_or(0);
    find_period(L, question);
    question.repeats = repetition_or_fail(L, options, question, period);
    return push_steady(L, options, std::move(question));
}

int steady_of_run(lua_State* L) {
    const RunHandle run = lua::self<RunHandle>(L, 1, steady_run_call.example);
    const lua::Options options(L, 2, steady_run_call);
    SteadyOptions asked;
    options.fill(asked);
    const std::optional<double> period = asked_period(options);
    if (run->joint) {
        options.fail({"a body has no steady motion by itself: ask the run of all bodies, run:steady()"});
    }
    if (!run->origin) options.fail({"a run read from a file has no system and no M"});
    auto question = options.value_or_fail(analysis::SteadyQuestion::of(run->origin->system, run->origin->drive));
    question.periods = asked.periods.value_or(0);
    const motion::Run& ended = run->result;
    if (question.is_plain() || ended.left == nullptr) {
        question.drive.start_at(ended.state_at_stop);
        for (std::size_t i = 0; i < ended.states; ++i) question.drive.states[i].start = ended.left->carry->y[2 + i];
    } else {
        const motion::Monitor none;
        question.drive = analysis::Runs(question, none).from(analysis::Runs::at_stop(ended), ended.t_stop);
    }
    find_period(L, question);
    question.repeats = repetition_or_fail(L, options, question, period);
    if (!question.is_plain() || question.drive.has_more()) {
        question.repeats.start = std::max(question.repeats.start, ended.t_stop);
    } else if (!question.is_timeless()) {
        call_checked(
            L, [&](const motion::Monitor&) { question.drive.start_at(state_at_period(ended, question.repeats)); });
    }
    return push_steady(L, options, std::move(question));
}

}  // namespace dinal::api
