// The class of what sys:steady{ ... } and run:steady{ ... } return; the calls are in steady_calls.cpp.
#include "api/steady_answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/cards.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "text/characters.hpp"
#include "text/sentences.hpp"

namespace dinal::api {
namespace {

using analysis::SteadyStatus;

const SteadyHandle& steady_self(lua_State* L, const char* call) {
    return lua::self<SteadyHandle>(L, 1, call);
}

bool is_moving(const Steady& s) {
    return s.motion.status == SteadyStatus::steady;
}

/// Raises where a motion of several bodies is asked for what only one of them has.
const Steady& of_one(lua_State* L, const Steady& s) {
    if (s.rig == nullptr || s.of_body) return s;
    lua::raise(L, fmt::format("this motion has several bodies; choose one of them, such as s.{}.amplitude",
                              s.rig->question.system->bodies.front().name));
}

const analysis::SteadyShape& steady_shape(lua_State* L, const SteadyHandle& s) {
    of_one(L, *s);
    if (!s->shape) {
        asking(L, s->question.extras,
               [&](const motion::Monitor& monitor) { s->shape = analysis::shape_of(s->question, s->motion, monitor); });
    }
    return *s->shape;
}

const std::vector<analysis::OtherMotion>& others_of(lua_State* L, const SteadyHandle& s) {
    if (!s->others && !is_found(*s)) s->others.emplace();
    if (!s->others) {
        std::vector<analysis::OtherMotion> others;
        asking(L, s->question.extras, [&](const motion::Monitor& monitor) {
            others = analysis::other_motions(s->question, s->motion, monitor);
        });
        s->others = std::move(others);
    }
    return *s->others;
}

int push_or_nil(lua_State* L, const std::optional<double>& x) {
    x && !std::isnan(*x) ? lua_pushnumber(L, *x) : lua_pushnil(L);  // NaN: of a body that goes round
    return 1;
}

// ---- fields

int steady_status(lua_State* L) {
    const std::string_view text = analysis::name(steady_self(L, "s.status")->motion.status);
    lua_pushlstring(L, text.data(), text.size());
    return 1;
}

template <auto fact>
int steady_found_number(lua_State* L) {
    const Steady& s = of_one(L, *steady_self(L, "s.amplitude"));
    return push_or_nil(L, is_found(s) ? std::optional<double>(static_cast<double>(s.motion.*fact)) : std::nullopt);
}

int steady_period(lua_State* L) {
    const Steady& s = *steady_self(L, "s.period");
    return push_or_nil(L, s.motion.status == SteadyStatus::none || s.motion.period == 0
                              ? std::nullopt
                              : std::optional(s.motion.period));
}

int steady_peak(lua_State* L) {
    const Steady& s = of_one(L, *steady_self(L, "s.peak"));
    const double most = std::max(std::fabs(s.motion.low), std::fabs(s.motion.high));
    return push_or_nil(L, is_found(s) ? std::optional(most) : std::nullopt);
}

int steady_mean(lua_State* L) {
    const SteadyHandle s = steady_self(L, "s.mean");
    return push_or_nil(L, is_found(*s) ? std::optional(steady_shape(L, s).mean) : std::nullopt);
}

template <auto angle>
int steady_shape_angle(lua_State* L) {
    const SteadyHandle s = steady_self(L, "s.lag");
    return push_or_nil(L, is_moving(*s) ? steady_shape(L, s).*angle : std::nullopt);
}

int steady_stops(lua_State* L) {
    const Steady& s = of_one(L, *steady_self(L, "s.stops"));
    is_moving(s) ? lua_pushinteger(L, static_cast<lua_Integer>(s.motion.stops)) : lua_pushnil(L);
    return 1;
}

int steady_periods(lua_State* L) {
    const Steady& s = *steady_self(L, "s.periods");
    is_found(s) ? lua_pushinteger(L, s.motion.periods) : lua_pushnil(L);
    return 1;
}

int steady_growth(lua_State* L) {
    const Steady& s = *steady_self(L, "s.growth");
    return push_or_nil(L, s.motion.status == SteadyStatus::grows ? std::optional(s.motion.growth) : std::nullopt);
}

int steady_rest(lua_State* L) {
    const Steady& s = of_one(L, *steady_self(L, "s.rest"));
    if (s.motion.status != SteadyStatus::adheres && s.motion.status != SteadyStatus::rest) {
        lua_pushnil(L);
        return 1;
    }
    lua_createtable(L, 2, 2);
    lua_pushnumber(L, s.motion.rest.first);
    lua_rawseti(L, -2, 1);
    lua_pushnumber(L, s.motion.rest.second);
    lua_rawseti(L, -2, 2);
    lua_pushnumber(L, s.motion.rest.first);
    lua_setfield(L, -2, "lower");
    lua_pushnumber(L, s.motion.rest.second);
    lua_setfield(L, -2, "upper");
    return 1;
}

int steady_multipliers(lua_State* L) {
    const Steady& s = *steady_self(L, "s.multipliers");
    if (!is_moving(s) || !s.motion.differentiable) {
        lua_pushnil(L);
        return 1;
    }
    lua_createtable(L, 2, 0);
    for (std::size_t i = 0; i < s.motion.multipliers.size(); ++i) {
        lua_createtable(L, 0, 3);
        lua_pushnumber(L, s.motion.multipliers[i].real());
        lua_setfield(L, -2, "re");
        lua_pushnumber(L, s.motion.multipliers[i].imag());
        lua_setfield(L, -2, "im");
        lua_pushnumber(L, std::abs(s.motion.multipliers[i]));
        lua_setfield(L, -2, "abs");
        lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
    }
    return 1;
}

template <auto fact>
int steady_found_flag(lua_State* L) {
    const Steady& s = *steady_self(L, "s.stable");
    is_found(s) ? lua_pushboolean(L, s.motion.*fact ? 1 : 0) : lua_pushnil(L);
    return 1;
}

int steady_unique(lua_State* L) {
    const SteadyHandle s = steady_self(L, "s.unique");
    if (!is_found(*s)) {
        lua_pushnil(L);
        return 1;
    }
    if (s->motion.unique.value_or(false)) {
        lua_pushliteral(L, "proven");
    } else if (!s->motion.unique && (s->rig ? others_of_rig(L, *s->rig).empty() : others_of(L, s).empty())) {
        lua_pushliteral(L, "not seen");
    } else {
        lua_pushboolean(L, 0);
    }
    return 1;
}

/// Kept, so that s.others is the same table each time.
int steady_others(lua_State* L) {
    const SteadyHandle s = steady_self(L, "s.others");
    if (!is_found(*s)) {
        lua_pushnil(L);
        return 1;
    }
    if (push_kept(L, "others")) return 1;
    lua_newtable(L);
    lua_Integer n = 0;
    if (s->rig) {
        for (const SteadyHandle& other : others_of_rig(L, *s->rig)) {
            lua::push<SteadyHandle>(L, other);
            lua_rawseti(L, -2, ++n);
        }
        keep(L, "others");
        return 1;
    }
    for (const analysis::OtherMotion& other : others_of(L, s)) {
        lua::push<SteadyHandle>(L, std::make_shared<Steady>(Steady{other.question, other.motion}));
        lua_rawseti(L, -2, ++n);
    }
    keep(L, "others");
    return 1;
}

std::string steady_story(lua_State* L, const SteadyHandle& s) {
    if (s->rig) return story_of_rig(L, *s);
    return analysis::told(s->question, s->motion, steady_shape(L, s), others_of(L, s));
}

int steady_explain(lua_State* L) {
    const SteadyHandle s = steady_self(L, "s:explain()");
    const std::string text = text::wrapped(steady_story(L, s));
    lua_pushlstring(L, text.data(), text.size());
    return 1;
}

std::string steady_summary(const Steady& s) {
    const analysis::SteadyMotion& m = s.motion;
    const ColumnUnits in(s.question.system.units());
    const auto number = [](double x, const std::string& unit) {
        return model::with_unit(fmt::format("{:.6g}", x), unit);
    };
    if (s.rig && !s.of_body && is_found(s)) {
        if (m.status == SteadyStatus::adheres) return "adheres: nothing moves";
        if (m.status == SteadyStatus::rest) return "rest: the motion ends";
        return m.period == 0 ? "steady: all bodies rotate at constant speed"
                             : fmt::format("steady: period {}, {} bodies", number(m.period, in.t),
                                           s.rig->question.system->bodies.size());
    }
    switch (m.status) {
        case SteadyStatus::steady:
            return fmt::format("steady: period {}, amplitude {}, {} a period{}", number(m.period, in.t),
                               number(m.amplitude, in.theta), text::counted(m.stops, "stop"),
                               m.stable || !m.differentiable ? "" : ", unstable");
        case SteadyStatus::adheres:
            return fmt::format("adheres: rests anywhere from theta = {:.6g} to {}", m.rest.first,
                               number(m.rest.second, in.theta));
        case SteadyStatus::rest:
            return fmt::format("rest: the motion ends at theta = {}", number(m.low, in.theta));
        case SteadyStatus::grows:
            if (s.question.is_timeless()) return "grows: without bound";
            return fmt::format("grows: by {} in each period of M", number(m.growth, in.theta));
        case SteadyStatus::none:
            break;
    }
    if (s.question.is_timeless()) return "none: no limit cycle was found";
    return fmt::format("none: nothing periodic was found in {} periods of M", m.maps);
}

int steady_to_string(lua_State* L) {
    const std::string text = steady_summary(*steady_self(L, "tostring(s)"));
    lua_pushlstring(L, text.data(), text.size());
    return 1;
}

#define DINAL_STEADY                                 \
    "sys = nondimensional{ friction_ratio = 0.4 }\n" \
    "s = sys:steady{ M = excitation.harmonic{ frequency = 0.4 } }\n"

constexpr lua::Member steady_members[] = {
    {"explain",
     lua::guarded<steady_explain>,
     lua::Kind::method,
     {"s:explain() -> string",
      "Describes the motion, whether it is stable, and whether other starts lead to another one.",
      DINAL_STEADY "print(s:explain():match(\"It stops[^.]*\"))  --> It stops 2 times a period and is stuck for 31"}},
    {"status",
     lua::guarded<steady_status>,
     lua::Kind::field,
     {"s.status -> string",
      "\"steady\"; \"adheres\": the mass never moves; \"rest\": the motion dies out; \"grows\": M supplies more "
      "energy than is dissipated; \"none\": no periodic motion was found. Fields without a value are nil.",
      DINAL_STEADY "print(s.status)  --> steady"}},
    {"period",
     lua::guarded<steady_period>,
     lua::Kind::field,
     {"s.period -> number", "The period of the motion, time units; nil at rest.",
      DINAL_STEADY "print(s.period)  --> 2.5"}},
    {"periods",
     lua::guarded<steady_periods>,
     lua::Kind::field,
     {"s.periods -> integer", "The number of periods of M in one period of the motion; 1 unless it is subharmonic.",
      DINAL_STEADY "print(s.periods)  --> 1"}},
    {"amplitude",
     lua::guarded<steady_found_number<&analysis::SteadyMotion::amplitude>>,
     lua::Kind::field,
     {"s.amplitude -> number", "Half the distance between the extremes of theta, rad.",
      DINAL_STEADY "print(string.format(\"%.4f\", s.amplitude))  --> 1.1111"}},
    {"peak",
     lua::guarded<steady_peak>,
     lua::Kind::field,
     {"s.peak -> number", "The greatest |theta|, rad.", DINAL_STEADY "print(s.peak >= s.amplitude)  --> true"}},
    {"mean",
     lua::guarded<steady_mean>,
     lua::Kind::field,
     {"s.mean -> number", "The mean of theta over time, rad.",
      DINAL_STEADY "print(math.abs(s.mean) < 1e-9)  --> true"}},
    {"lag",
     lua::guarded<steady_shape_angle<&analysis::SteadyShape::lag>>,
     lua::Kind::field,
     {"s.lag -> number",
      "The lag of the fundamental of theta behind that of M, rad in (-pi, pi]; nil if one of them has none or M "
      "depends on the motion.",
      "s = system{ I = 1, k = 1, C = 0.5 }:steady{ M = excitation.harmonic{ omega = 1 } }\n"
      "print(string.format(\"%.6f\", s.lag))  --> 1.570796"}},
    {"peak_lag",
     lua::guarded<steady_shape_angle<&analysis::SteadyShape::peak_lag>>,
     lua::Kind::field,
     {"s.peak_lag -> number", "The lag of the maximum of theta behind that of the fundamental of M, rad.",
      "s = system{ I = 1, k = 1, C = 0.5 }:steady{ M = excitation.harmonic{ omega = 1 } }\n"
      "print(string.format(\"%.6f\", s.peak_lag))  --> 1.570796"}},
    {"stops",
     lua::guarded<steady_stops>,
     lua::Kind::field,
     {"s.stops -> integer", "The number of stops in a period; nil if it adheres.",
      DINAL_STEADY "print(s.stops)  --> 2"}},
    {"stuck",
     lua::guarded<steady_found_number<&analysis::SteadyMotion::stuck>>,
     lua::Kind::field,
     {"s.stuck -> number", "The fraction of a period for which it is stuck.",
      DINAL_STEADY "print(string.format(\"%.4f\", s.stuck))  --> 0.3154"}},
    {"multipliers",
     lua::guarded<steady_multipliers>,
     lua::Kind::field,
     {"s.multipliers -> table",
      "The Floquet multipliers, each { re, im, abs }: the factors of small disturbances in one period. There are "
      "two, and one for each state; a limit cycle has one less, without the trivial one. nil with delayed and "
      "sampled controllers.",
      "s = system{ I = 1, k = 1, C = 0.5 }:steady{ M = excitation.harmonic{ omega = 1 } }\n"
      "print(string.format(\"%.6f %.6f\", s.multipliers[1].abs, math.exp(-math.pi / 2)))  --> 0.207880 0.207880"}},
    {"stable",
     lua::guarded<steady_found_flag<&analysis::SteadyMotion::stable>>,
     lua::Kind::field,
     {"s.stable -> boolean", "true if no disturbance grows; if M has a memory, true if a run converged to this motion.",
      DINAL_STEADY "print(s.stable)  --> true"}},
    {"unique",
     lua::guarded<steady_unique>,
     lua::Kind::field,
     {"s.unique -> string or false",
      "\"proven\": no other periodic motion exists; this is proven for a linear spring with Re = Rd, no walls and "
      "an M of time alone. \"not seen\": sixteen other starts led to no other. false: others exist, in s.others or "
      "as a family.",
      DINAL_STEADY "print(s.unique)  --> proven"}},
    {"others",
     lua::guarded<steady_others>,
     lua::Kind::field,
     {"s.others -> table",
      "The other motions found from sixteen other starts, a list of steady motions. Empty if the motion is unique, "
      "or one of a family.",
      "s = system{ I = 1, k = 4, C = 0.1, Rd = 0.3, Re = 0.6 }:steady{ belt = 0.1 }\n"
      "print(s.status, #s.others, s.others[1].status)  --> steady\t1\trest"}},
    {"symmetric",
     lua::guarded<steady_found_flag<&analysis::SteadyMotion::symmetric>>,
     lua::Kind::field,
     {"s.symmetric -> boolean", "The motion is symmetric: theta(t + T/2) = -theta(t).",
      DINAL_STEADY "print(s.symmetric)  --> true"}},
    {"rest",
     lua::guarded<steady_rest>,
     lua::Kind::field,
     {"s.rest -> table", "If it adheres or comes to rest: { lower, upper }, the range of rest positions, rad.",
      "s = system{ I = 1, k = 2, Rd = 1 }:steady{ M = excitation.harmonic{ amplitude = 0.8, omega = 1 } }\n"
      "print(s.status, string.format(\"%.4f %.4f\", s.rest[1], s.rest[2]))  --> adheres\t-0.1000 0.1000"}},
    {"growth",
     lua::guarded<steady_growth>,
     lua::Kind::field,
     {"s.growth -> number", "If it grows: the growth of the amplitude in a period of M, rad.",
      "s = nondimensional{ friction_ratio = 0.167 }:steady{ M = excitation.harmonic{ frequency = 1 } }\n"
      "print(string.format(\"%.6f\", s.growth))  --> 2.473593"}},
    {"run",
     lua::guarded<run_of_steady>,
     lua::Kind::field,
     {"s.run -> run", "One period of the motion as a run with 401 rows; nil at rest.",
      DINAL_STEADY "print(#s.run, s.run.t_end)  --> 401\t2.5"}},
    {"__tostring",
     lua::guarded<steady_to_string>,
     lua::Kind::metamethod,
     {"tostring(s) -> string", "The answer in one line.",
      DINAL_STEADY "print(s)  --> steady: period 2.5 T0, amplitude 1.11113 Mc/k, 2 stops a period"}},
};

#undef DINAL_STEADY

std::string steady_card(lua_State* L, int index, const terminal::Display& screen) {
    return text::wrapped(terminal::spelled(steady_summary(**lua::test<SteadyHandle>(L, index)), screen),
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
    body_of_steady,
    steady_card};

void register_steady(lua_State* L) {
    lua::add_class<SteadyHandle>(L, steady_class);
}

}  // namespace dinal::api
