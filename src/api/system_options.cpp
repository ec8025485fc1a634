#include "api/system_options.hpp"

#include <fmt/format.h>

#include "api/units_option.hpp"
#include "model/laws/bristle.hpp"
#include "source/describe.hpp"

namespace dinal::api {

int push_system(lua_State* L, const lua::Options& options, const model::OscillatorParameters& parameters) {
    lua::push(L, options.value_or_fail(model::Oscillator::make(parameters)));
    return 1;
}

std::optional<model::Friction> asked_law(lua_State* L, const lua::Options& options,
                                         std::initializer_list<const char*> instead_of, bool may_have_state) {
    options.push("friction");
    if (lua_type(L, -1) == LUA_TNUMBER) {
        options.fail({.sentence = fmt::format("friction must be {}, got {}", options.row("friction").wanted,
                                              lua::describe(L, -1)),
                      .option = "friction",
                      .culprit = lua::written(L, -1),
                      .cure = fmt::format("; did you mean '{}'?", *instead_of.begin())});
    }
    lua_pop(L, 1);
    const auto* law = options.object<model::Friction>("friction");
    if (law == nullptr) {
        return std::nullopt;
    }
    for (const char* name : instead_of) {
        if (options.has(name)) {
            options.fail({.sentence = fmt::format("friction and {} exclude each other; give one of them", name),
                          .option = name});
        }
    }
    if (!may_have_state && law->as<model::laws::Bristle>() != nullptr) {
        options.fail("friction", "a law of bristles has a state of its own, which only system{ ... } supports");
    }
    return *law;
}

std::optional<model::Walls> asked_walls(lua_State* L, const lua::Options& options) {
    options.push("walls");
    if (lua_isnil(L, -1)) {
        lua_pop(L, 1);
        return std::nullopt;
    }
    if (lua_type(L, -1) != LUA_TTABLE) {
        options.wrong("walls", options.row("walls").wanted);
    }
    lua_pushnil(L);
    if (lua_next(L, -2) == 0) {
        lua_pop(L, 1);
        return std::nullopt;
    }
    lua_pop(L, 2);
    const auto walls = lua::read<model::Walls>(L, lua_gettop(L), model::walls_call);
    lua_pop(L, 1);
    return walls;
}

/// A new Rd or Re makes another law one of Coulomb's again; Re goes with Rd where the two were one number.
int system_with(lua_State* L) {
    const model::Oscillator& old = lua::self<model::Oscillator>(L, 1, with_call.example);
    const lua::Options options(L, 2, with_call);
    model::OscillatorParameters parameters = old.parameters();
    SystemChanges changes;
    options.fill(changes);
    parameters.inertia = changes.inertia.value_or(parameters.inertia);
    parameters.stiffness = changes.stiffness.value_or(parameters.stiffness);
    parameters.damping = changes.damping.value_or(parameters.damping);
    if (const auto spring = asked_spring(L, options)) {
        parameters.spring = *spring;
    }
    if (options.has("walls")) {
        parameters.walls = asked_walls(L, options);
    }
    if (const auto units = asked_units(L, options)) {
        parameters.units = *units;
    }
    const auto law = asked_law(L, options, {"Rd", "Re"});
    if (law) {
        parameters.friction = law;
    } else if (changes.kinetic || changes.breakaway) {
        if (parameters.friction && !(changes.kinetic && changes.breakaway)) {
            options.fail({.sentence = fmt::format("the friction of this system is {}: give both Rd and Re, or friction",
                                                  source::lua_text(L, *parameters.friction)),
                          .option = changes.kinetic ? "Rd" : "Re"});
        }
        const bool one_number = parameters.breakaway == parameters.kinetic_friction;
        parameters.friction.reset();
        parameters.kinetic_friction = changes.kinetic.value_or(parameters.kinetic_friction);
        if (changes.breakaway || one_number) {
            parameters.breakaway = changes.breakaway ? changes.breakaway : parameters.kinetic_friction;
        }
    }
    return push_system(L, options, parameters);
}

}  // namespace dinal::api
