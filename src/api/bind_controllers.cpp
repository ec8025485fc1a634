// excitation.sampled, excitation.relay, excitation.delayed: terms of M with a memory.
#include <fmt/format.h>

#include <cmath>

#include "api/bind_excitation.hpp"
#include "api/controller_options.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "lua/vector.hpp"
#include "model/controller.hpp"

namespace dinal::api {

namespace {

std::shared_ptr<lua::LuaFunction> controller_function(lua_State* L, const text::Call& call, const char* role) {
    if (!lua::is_callable(L, 1)) {
        lua::raise(L, {.sentence = fmt::format("{} takes a function of t, theta, velocity, z, got {}, for example {}",
                                               call.name, lua::describe(L, 1), call.example),
                       .call = call.name,
                       .culprit = lua::written(L, 1)});
    }
    return std::make_shared<lua::LuaFunction>(
        L, 1, lua::FunctionRole{.name = role, .motion = lua::FunctionRole::Motion::always});
}

int push_controller(lua_State* L, std::shared_ptr<model::Controller> controller) {
    return push_term(L, model::Scripted{.function = std::move(controller), .feedback = true});
}

}  // namespace

int sampled_controller(lua_State* L) {
    auto controller = std::make_shared<model::SampledController>();
    const auto function = controller_function(L, sampled_call, "the sampled function");
    controller->function = function;
    const lua::Options options(L, 2, sampled_call);
    options.fill(*controller);
    options.push("start");
    if (lua::is_callable(L, -1)) {
        function->remember_from(L, -1);
    } else if (!lua_isnil(L, -1)) {
        options.wrong("start", options.row("start").wanted);
    }
    lua_pop(L, 1);
    return push_controller(L, std::move(controller));
}

int delayed_controller(lua_State* L) {
    auto controller = std::make_shared<model::DelayedController>();
    controller->function = controller_function(L, delayed_call, "the delayed function");
    lua::Options(L, 2, delayed_call).fill(*controller);
    return push_controller(L, std::move(controller));
}

int relay_controller(lua_State* L) {
    const lua::Options options(L, 1, relay_call);
    auto controller = std::make_shared<model::RelayController>();
    RelayOptions asked;
    options.fill(asked);
    if (asked.on == asked.off) {
        options.fail(
            {.sentence = fmt::format("on = {:.6g} and off = {:.6g} must differ: between them it stays as it is",
                                     asked.on, asked.off),
             .option = "off"});
    }
    options.push("amplitude");
    const bool one = lua_type(L, -1) == LUA_TNUMBER;
    lua_pop(L, 1);
    const double alone = one ? options.number("amplitude") : 0;
    const std::vector<double> torques = one ? std::vector{alone, -alone} : options.numbers("amplitude");
    if (!options.has("amplitude")) options.missing("amplitude");
    if (torques.size() != 2) {
        options.fail("amplitude", fmt::format("amplitude must be {}, got {} number{}", options.row("amplitude").wanted,
                                              torques.size(), torques.size() == 1 ? "" : "s"));
    }
    controller->on = asked.on, controller->off = asked.off;
    controller->levels = {torques[0], torques[1]};
    controller->starts_on = asked.start == RelayOptions::Start::on;
    using Of = model::RelayController::Of;
    options.push("of");
    if (lua_type(L, -1) == LUA_TSTRING) {
        controller->state = lua_tostring(L, -1);
        controller->of = controller->state == "theta"      ? Of::theta
                         : controller->state == "velocity" ? Of::velocity
                                                           : Of::state;
    } else if (lua::is_callable(L, -1)) {
        controller->of = Of::function;
        controller->function = std::make_shared<lua::LuaFunction>(
            L, -1, lua::FunctionRole{.name = "of", .motion = lua::FunctionRole::Motion::always});
    } else if (!lua_isnil(L, -1)) {
        options.wrong("of", options.row("of").wanted);
    }
    lua_pop(L, 1);
    return push_controller(L, std::move(controller));
}

}  // namespace dinal::api
