#include "api/extras_options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "api/bind_excitation.hpp"
#include "api/classes.hpp"
#include "lua/lua_text.hpp"
#include "lua/user_function.hpp"

namespace dinal::api {

namespace {

constexpr lua::FunctionRole::Motion with_motion = lua::FunctionRole::Motion::always;

/// The function in the field of the table on the top; nullptr when it is nil.
std::shared_ptr<model::UserFunction> function_field(lua_State* L, const lua::Options& options, const std::string& of,
                                                    const char* field) {
    lua_getfield(L, -1, field);
    const std::string name = fmt::format("{}.{}", of, field);
    if (!lua_isnil(L, -1) && !lua::is_callable(L, -1)) {
        options.fail({.sentence = fmt::format("{} must be a function of t, theta, velocity, z, got {}", name,
                                              lua::describe(L, -1)),
                      .option = name,
                      .culprit = lua::written(L, -1)});
    }
    std::shared_ptr<model::UserFunction> function;
    if (!lua_isnil(L, -1)) {
        function = std::make_shared<lua::LuaFunction>(L, -1, lua::FunctionRole{.name = name, .motion = with_motion});
    }
    lua_pop(L, 1);
    return function;
}

void check_fields(lua_State* L, const lua::Options& options, const std::string& of,
                  std::initializer_list<std::string_view> known) {
    lua_pushnil(L);
    while (lua_next(L, -2) != 0) {
        const std::string field = lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : lua::describe(L, -2);
        if (std::find(known.begin(), known.end(), field) == known.end()) {
            const std::vector<std::string_view> names(known);
            options.fail({.sentence = fmt::format("{} has no '{}' among {}", of, field, fmt::join(known, ", ")),
                          .option = of,
                          .culprit = field,
                          .cure = text::did_you_mean(field, names)});
        }
        lua_pop(L, 1);
    }
}

void check_state_name(const lua::Options& options, const std::string& name) {
    const auto refuse = [&](std::string_view why) {
        options.fail({.sentence = fmt::format("states: {}", why), .option = "states", .culprit = name});
    };
    if (!lua::is_name(name)) {
        refuse(fmt::format("'{}' is no name; take letters, digits and _", name));
    }
    for (const lua::Member& member : run_class.members) {
        if (name == member.name) {
            refuse(fmt::format("'{}' is a name that a run has already; take another", name));
        }
    }
}

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
        if (lua_type(L, -2) != LUA_TSTRING || lua_type(L, -1) != LUA_TTABLE) {
            options.wrong("states", options.row("states").wanted);
        }
        names.emplace_back(lua_tostring(L, -2));
        lua_pop(L, 1);
    }
    std::sort(names.begin(), names.end());  // a table has no order
    for (const std::string& name : names) {
        check_state_name(options, name);
        const std::string of = "states." + name;
        lua_getfield(L, -1, name.c_str());
        check_fields(L, options, of, {"start", "rate"});
        model::OwnState state;
        state.name = name;
        lua_getfield(L, -1, "start");
        if (!lua_isnil(L, -1)) {
            state.start = lua_tonumber(L, -1);
            if (lua_type(L, -1) != LUA_TNUMBER || !std::isfinite(state.start)) {
                options.fail(
                    {.sentence = fmt::format("{}.start must be a finite number, got {}", of, lua::describe(L, -1)),
                     .option = of + ".start",
                     .culprit = lua::written(L, -1)});
            }
        }
        lua_pop(L, 1);
        state.rate = function_field(L, options, of, "rate");
        if (state.rate == nullptr) {
            options.fail({.sentence = fmt::format("{} needs rate, a function of t, theta, velocity, z", of),
                          .option = of + ".rate",
                          .culprit = "nil"});
        }
        states.push_back(std::move(state));
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return states;
}

/// The event in the table on the top.
model::WantedEvent read_event(lua_State* L, const lua::Options& options, const std::string& of) {
    check_fields(L, options, of, {"when", "direction", "stop", "name", "act"});
    model::WantedEvent wanted;
    wanted.when = function_field(L, options, of, "when");
    if (wanted.when == nullptr) {
        options.fail({.sentence = fmt::format("{} needs when, a function of t, theta, velocity, z", of),
                      .option = of + ".when",
                      .culprit = "nil"});
    }
    const auto refuse = [&](const char* field, const char* must) {
        options.fail({.sentence = fmt::format("{}.{} must be {}, got {}", of, field, must, lua::describe(L, -1)),
                      .option = fmt::format("{}.{}", of, field),
                      .culprit = lua::written(L, -1)});
    };
    lua_getfield(L, -1, "direction");
    if (!lua_isnil(L, -1)) {
        const std::string direction = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "";
        if (direction != "up" && direction != "down" && direction != "both") {
            refuse("direction", "'up', 'down' or 'both'");
        }
        wanted.direction = direction == "up"     ? model::Crossing::up
                           : direction == "down" ? model::Crossing::down
                                                 : model::Crossing::both;
    }
    lua_pop(L, 1);
    lua_getfield(L, -1, "stop");
    if (!lua_isnil(L, -1) && !lua_isboolean(L, -1)) {
        refuse("stop", "true or false");
    }
    wanted.stop = lua_toboolean(L, -1) != 0;
    lua_pop(L, 1);
    lua_getfield(L, -1, "name");
    if (!lua_isnil(L, -1) && lua_type(L, -1) != LUA_TSTRING) {
        refuse("name", "a string");
    }
    wanted.name = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "";
    lua_pop(L, 1);
    lua_getfield(L, -1, "act");
    if (!lua_isnil(L, -1)) {
        if (!lua::is_callable(L, -1)) {
            refuse("act", "a function of t, theta, velocity, z");
        }
        wanted.act = std::make_shared<lua::LuaAction>(L, -1, of + ".act");
    }
    lua_pop(L, 1);
    return wanted;
}

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
        events.push_back(read_event(L, options, fmt::format("events[{}]", i)));
        lua_pop(L, 1);
    }
    lua_pushnil(L);
    if (count == 0 && lua_next(L, -2) != 0) {
        options.wrong("events", options.row("events").wanted);
    }
    lua_settop(L, lua_gettop(L) - (count == 0 ? 0 : 1));
    lua_pop(L, 1);
    return events;
}

/// A function of time alone.
model::Excitation read_motion(lua_State* L, const lua::Options& options, const char* name) {
    if (!options.has(name)) return {};
    options.push(name);
    model::Excitation motion = to_excitation(L, -1, fmt::format("sys:simulate: {}", name), name);
    if (motion.has_feedback() || model::has_memory(motion)) {
        options.fail({.sentence = fmt::format("{} must be a number, an excitation or a function of t alone", name),
                      .option = name});
    }
    lua_pop(L, 1);
    return motion;
}

}  // namespace

model::Extras read_extras(lua_State* L, const lua::Options& options) {
    return {.states = read_states(L, options),
            .events = read_events(L, options),
            .belt = read_motion(L, options, "belt"),
            .base = read_motion(L, options, "base")};
}

}  // namespace dinal::api
