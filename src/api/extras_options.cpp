#include "api/extras_options.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <string>

#include "api/bind_excitation.hpp"
#include "api/classes.hpp"
#include "lua/lua_text.hpp"
#include "lua/user_function.hpp"
#include "model/controller.hpp"

namespace dinal::api {

namespace {

constexpr lua::FunctionRole::Motion with_motion = lua::FunctionRole::Motion::always;

/// The function that the option names; nullptr when it is absent. It is called `role` wherever something is said of it.
std::shared_ptr<model::UserFunction> function_at(lua_State* L, const lua::Options& options, const char* name,
                                                 const std::string& role) {
    options.push(name);
    std::shared_ptr<model::UserFunction> function;
    if (lua::is_callable(L, -1)) {
        function = std::make_shared<lua::LuaFunction>(L, -1, lua::FunctionRole{.name = role, .motion = with_motion});
    } else if (!lua_isnil(L, -1)) {
        options.wrong(name, options.row(name).wanted);
    } else if (options.row(name).otherwise == text::needed) {
        options.missing(name);
    }
    lua_pop(L, 1);
    return function;
}

void check_state_name(const lua::Options& options, const std::string& name) {
    const auto refuse = [&](std::string_view why) {
        options.fail({.sentence = fmt::format("states: {}", why), .option = "states", .culprit = name});
    };
    if (!lua::is_name(name)) {
        refuse(fmt::format("'{}' is not a name; use letters, digits and _", name));
    }
    for (const lua::Member& member : run_class.members) {
        if (name == member.name) {
            refuse(fmt::format("'{}' is a name that a run has already; take another", name));
        }
    }
}

}  // namespace

std::vector<model::OwnState> read_states(lua_State* L, const lua::Options& options) {
    std::vector<model::OwnState> states;
    if (!options.has("states")) return states;
    options.push("states");
    if (lua_type(L, -1) != LUA_TTABLE) {
        options.wrong("states", options.row("states").wanted);
    }
    std::vector<std::string> names;
    lua_pushnil(L);
    while (lua_next(L, -2) != 0) {
        if (lua_type(L, -2) != LUA_TSTRING) {
            options.wrong("states", options.row("states").wanted);
        }
        names.emplace_back(lua_tostring(L, -2));
        lua_pop(L, 1);
    }
    std::sort(names.begin(), names.end());  // a table has no order
    for (const std::string& name : names) {
        check_state_name(options, name);
        const std::string of = "states." + name, call = fmt::format("{}: {}", options.call(), of);
        lua_getfield(L, -1, name.c_str());
        if (lua_type(L, -1) != LUA_TTABLE) {
            options.fail({.sentence = fmt::format("{} must be a table such as {{ start = 0, rate = function(t, theta, "
                                                  "velocity, z) return 1 - theta end }}, got {}",
                                                  of, lua::describe(L, -1)),
                          .option = name,
                          .culprit = lua::written(L, -1)});
        }
        const lua::Options own(L, lua_gettop(L), {call.c_str(), state_call.example, state_call.options});
        model::OwnState state;
        own.fill(state);
        state.name = name;
        state.rate = function_at(L, own, "rate", of + ".rate");
        states.push_back(std::move(state));
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return states;
}

namespace {

/// The event in the table on the top.
model::WantedEvent read_event(lua_State* L, const char* simulate, const std::string& of) {
    const std::string call = fmt::format("{}: {}", simulate, of);
    const lua::Options own(L, lua_gettop(L), {call.c_str(), event_call.example, event_call.options});
    model::WantedEvent wanted;
    own.fill(wanted);
    wanted.when = function_at(L, own, "when", of + ".when");
    own.push("act");
    if (!lua_isnil(L, -1)) {
        if (!lua::is_callable(L, -1)) own.wrong("act", own.row("act").wanted);
        wanted.act = std::make_shared<lua::LuaAction>(L, -1, of + ".act");
    }
    lua_pop(L, 1);
    return wanted;
}

}  // namespace

std::vector<model::WantedEvent> read_events(lua_State* L, const lua::Options& options) {
    std::vector<model::WantedEvent> events;
    if (!options.has("events")) return events;
    options.push("events");
    if (lua_type(L, -1) != LUA_TTABLE) {
        options.wrong("events", options.row("events").wanted);
    }
    const auto count = static_cast<lua_Integer>(lua_rawlen(L, -1));
    for (lua_Integer i = 1; i <= count; ++i) {
        if (lua_rawgeti(L, -1, i) != LUA_TTABLE) {
            options.wrong("events", options.row("events").wanted);
        }
        events.push_back(read_event(L, options.call(), fmt::format("events[{}]", i)));
        lua_pop(L, 1);
    }
    lua_pushnil(L);
    if (count == 0 && lua_next(L, -2) != 0) {
        options.fail("events",
                     "events must be a list, in which each event has braces of its own, such as "
                     "{ { when = function(t, theta) return theta - 1 end, name = \"limit\" } }");
    }
    lua_settop(L, lua_gettop(L) - (count == 0 ? 0 : 1));
    lua_pop(L, 1);
    return events;
}

model::Excitation read_motion(lua_State* L, const lua::Options& options, const char* name) {
    if (!options.has(name)) return {};
    options.push(name);
    model::Excitation motion = to_excitation(L, -1, fmt::format("{}: {}", options.call(), name), name);
    if (motion.has_feedback() || model::has_memory(motion)) {
        options.fail({.sentence = fmt::format("{} must be a number, an excitation or a function of t alone", name),
                      .option = name});
    }
    lua_pop(L, 1);
    return motion;
}

model::Extras read_extras(lua_State* L, const lua::Options& options) {
    return {.states = read_states(L, options),
            .events = read_events(L, options),
            .belt = read_motion(L, options, "belt"),
            .base = read_motion(L, options, "base")};
}

std::vector<std::string> names_of(const model::Extras& extras) {
    std::vector<std::string> names;
    for (const model::OwnState& state : extras.states) {
        names.push_back(state.name);
    }
    return names;
}

void check_relays(const lua::Options& options, const model::Excitation& excitation, const model::Extras& extras) {
    if (!excitation.has_script()) return;
    const std::vector<std::string> names = names_of(extras);
    for (const model::Component& c : excitation.components()) {
        const auto* relay = model::controller_of<model::RelayController>(c);
        if (relay == nullptr || relay->of != model::RelayController::Of::state ||
            std::find(names.begin(), names.end(), relay->state) != names.end()) {
            continue;
        }
        options.fail({.sentence = fmt::format("M has a relay of '{}', which is not a state of this run; its states are "
                                              "{{ {} }}",
                                              relay->state, fmt::join(names, ", ")),
                      .option = "states"});
    }
}

}  // namespace dinal::api
