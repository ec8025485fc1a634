// spring.polynomial{...}: springs as values for `spring =` of a system; and Lua functions used there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/classes.hpp"
#include "api/system_options.hpp"
#include "lua/user_function.hpp"
#include "lua/values.hpp"
#include "model/springs.hpp"
#include "source/describe.hpp"

namespace dinal::api {

namespace {

namespace springs = model::springs;

constexpr const char* polynomial_example = "spring.polynomial{ [3] = 0.5 }";

[[noreturn]] void refuse_power(lua_State* L, std::string sentence, int index) {
    lua::fail(L, "spring.polynomial", {.sentence = std::move(sentence), .culprit = lua::written(L, index)});
}

/// The power given by the key at `index`.
int power_at(lua_State* L, int index) {
    const double n = lua_tonumber(L, index);
    if (lua_type(L, index) == LUA_TNUMBER && n == 0) {
        refuse_power(L, "the power 0 is a constant torque, not a spring; add it to M", index);
    }
    if (lua_type(L, index) != LUA_TNUMBER || !text::is_whole(n, 1, springs::PolynomialSpring::highest_power)) {
        refuse_power(L,
                     fmt::format("the power {} must be a whole number from 1 to {}, for example {}",
                                 lua_type(L, index) == LUA_TNUMBER ? fmt::format("{:.6g}", n) : lua::describe(L, index),
                                 springs::PolynomialSpring::highest_power, polynomial_example),
                     index);
    }
    return static_cast<int>(n);
}

int polynomial_spring(lua_State* L) {
    if (lua_type(L, 1) != LUA_TTABLE) {
        lua::raise_got(L, 1, "spring.polynomial", "spring.polynomial takes a table of powers of theta",
                       fmt::format(", for example {}", polynomial_example));
    }
    springs::PolynomialSpring spring;
    lua_pushnil(L);
    while (lua_next(L, 1) != 0) {
        const int n = power_at(L, -2);
        const double c = lua_tonumber(L, -1);
        if (lua_type(L, -1) != LUA_TNUMBER || !std::isfinite(c)) {
            refuse_power(L, fmt::format("[{}] must be a finite number, got {}", n, lua::describe(L, -1)), -1);
        }
        if (c != 0) {
            spring.terms.emplace_back(n, c);
        }
        lua_pop(L, 1);
    }
    std::ranges::sort(spring.terms);
    lua::push<model::Spring>(L, spring.terms.empty() ? model::Spring() : model::Spring(spring));
    return 1;
}

/// A value of the spring at theta; the spring may be a user's function.
template <double (model::Spring::*get)(double) const>
double at_theta(lua_State* L, const model::Spring& spring, double theta) {
    lua::CallState call(L);
    const double value = (spring.*get)(theta);
    call.check();
    return value;
}

constexpr lua::Member spring_module_members[] = {
    {lua::a_function<polynomial_spring>,
     {"spring.polynomial{ [POWER] = COEFFICIENT, ... } -> spring",
      "A spring whose restoring torque is a sum of powers of theta, in addition to k theta: c "
      "theta^n for each [n] = c, torque per rad^n. Powers are whole numbers from 1 to 31; { [3] "
      "= c } is Duffing's spring.",
      "duffing = spring.polynomial{ [3] = 0.5 }\n"
      "print(duffing:torque(2), duffing:energy(2))  --> 4.0\t2.0"}},
};

constexpr lua::Member spring_members[] = {
    {lua::a_typed_method<at_theta<&model::Spring::torque>>,
     {"spring:torque(theta) -> number", "The restoring torque at theta (rad).",
      "print(spring.polynomial{ [1] = -1, [3] = 1 }:torque(0.5))  --> -0.375"}},
    {lua::a_typed_method<at_theta<&model::Spring::energy>>,
     {"spring:energy(theta) -> number",
      "The stored energy at theta (rad): the integral of the torque from 0, torque times rad.",
      "print(spring.polynomial{ [3] = 0.5 }:energy(1))  --> 0.125"}},
    {lua::a_text<model::Spring, [](lua_State* L, const model::Spring& spring) { return source::lua_text(L, spring); }>,
     {"tostring(spring) -> string", "The Lua text that recreates it.",
      "print(spring.polynomial{ [3] = 0.5 })  --> spring.polynomial{ [3] = 0.5 }"}},
};

}  // namespace

std::optional<model::Spring> asked_spring(lua_State* L, const lua::Options& options) {
    options.push("spring");
    const int index = lua_gettop(L);
    std::optional<model::Spring> asked;
    if (const auto* spring = lua::test<model::Spring>(L, index)) {
        asked = *spring;
    } else if (lua::is_callable(L, index)) {
        springs::UserSpring own{std::make_shared<lua::LuaFunction>(
            L, index,
            lua::FunctionRole{.name = "spring", .argument = "theta", .motion = lua::FunctionRole::Motion::never})};
        lua::CallState call(L);
        static_cast<void>(own.torque(0));  // reports an invalid result here rather than during a run
        call.check();
        asked = own;
    } else if (!lua_isnil(L, index)) {
        options.wrong("spring");
    }
    lua_pop(L, 1);
    return asked;
}

const lua::Class spring_module = {
    "spring",
    {"spring.NAME{ ... } -> spring",
     "Springs in addition to k theta, for `spring =` of system{...}. A Lua function of theta is "
     "also possible there.",
     "sys = system{ I = 1, k = 1, spring = spring.polynomial{ [3] = 0.5 } }\n"
     "print(sys.spring)  --> spring.polynomial{ [3] = 0.5 }"},
    spring_module_members,
    lua::add_module};

const lua::Class spring_class = {
    "spring",
    {"spring.NAME{ ... } -> spring", "A spring. It cannot be changed.",
     "print(system{ I = 1, k = 1, spring = function(theta) return theta^3 end }.spring:torque(2))  --> 8.0"},
    spring_members,
    lua::add_class<model::Spring>};

}  // namespace dinal::api
