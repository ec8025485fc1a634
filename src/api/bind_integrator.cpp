// integrator.NAME{...} for every row of motion/integrators.hpp, and the class of integrators: their options are fields.

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "api/cards.hpp"
#include "api/classes.hpp"
#include "lua/options.hpp"
#include "lua/values.hpp"
#include "motion/integrators.hpp"
#include "source/describe.hpp"
#include "text/words.hpp"

namespace dinal::api {

namespace {

constexpr const char* name_of(const motion::MethodText& about) {
    constexpr std::string_view module = "integrator.";
    return about.call.name + module.size();
}

motion::Integrator& integrator_self(lua_State* L) {
    return lua::self<motion::Integrator>(L, 1, "integrator.h");
}

// ---- integrator.rk4{ h = 0.001 }

template <class M>
int make(lua_State* L) {
    lua::push<motion::Integrator>(L, lua::read<M>(L, 1, M::about.call));
    return 1;
}

template <class M>
constexpr text::FixedText<64> signature{M::about.call.name, "{ OPTIONS } -> integrator"};

template <class... M>
constexpr std::array<lua::Member, sizeof...(M)> functions_of(std::type_identity<std::variant<M...>> /*all*/) {
    return {lua::Member{lua::a_function<make<M>>,
                        {signature<M>.c_str(), M::about.summary, M::about.example, {&M::about.call}}}...};
}

constexpr auto integrator_module_members = functions_of(std::type_identity<motion::Integrator>());

// ---- integrator.h

const text::Option* find_option(const motion::MethodText& about, std::string_view name) {
    const auto found = std::ranges::find(about.call.options, name, &text::Option::name);
    return found == about.call.options.end() ? nullptr : &*found;
}

/// Pushes the value of an option, a number; nil if absent or infinite.
void push_option(lua_State* L, const text::OptionValue& value) {
    if (const auto* number = std::get_if<double>(&value); number != nullptr && std::isfinite(*number)) {
        lua_pushnumber(L, *number);
    } else {
        lua_pushnil(L);
    }
}

template <class... M>
bool is_option(std::type_identity<std::variant<M...>> /*all*/, std::string_view name) {
    return ((find_option(M::about, name) != nullptr) || ...);
}

/// Pushes an option by its name; nil for options that only other methods have.
int option_by_name(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const std::string_view name = lua_tostring(L, 2);
    if (!is_option(std::type_identity<motion::Integrator>(), name)) return 0;
    std::visit(
        [L, name](const auto& method) {
            const text::Option* option = find_option(method.about, name);
            option != nullptr ? push_option(L, option->filled.get(&method)) : lua_pushnil(L);
        },
        integrator_self(L));
    return 1;
}

constexpr lua::Member integrator_members[] = {
    {lua::a_value<motion::Integrator,
                  [](const motion::Integrator& i) { return name_of(motion::MethodView(i).about()); }>,
     {"integrator.name -> string", "The name of the method.", "print(integrator.rk4{ h = 0.001 }.name)  --> rk4"}},
    {lua::a_text<motion::Integrator, [](const motion::Integrator& i) { return source::lua_text(i); }>,
     {"tostring(integrator) -> string", "The Lua text that recreates it.",
      "print(integrator.dinal1989{ h = 0.01 })  --> integrator.dinal1989{ h = 0.01 }"}},
};

constexpr text::FixedText<160> module_summary{"The methods a run can use. The default is ",
                                              motion::default_integrator.c_str(), "."};

}  // namespace

const lua::Class integrator_module = {
    "integrator",
    {"integrator.NAME{ ... } -> integrator", module_summary.c_str(),
     "sys = nondimensional{ zeta = 0.1 }\n"
     "run = sys:simulate{ theta0 = 1, t_end = 2, dt = 0.5, integrator = integrator.rk4{ h = 0.01 } }\n"
     "print(run.integrator)  --> integrator.rk4{ h = 0.01 }"},
    integrator_module_members,
    lua::add_module};

const lua::Class integrator_class = {"integrator",
                                     {"integrator.rk4{ h = 0.001 } -> integrator",
                                      "A method with its options as fields, for `integrator =` in sys:simulate{...}.",
                                      "print(integrator.rk4{ h = 0.001 }.h)  --> 0.001"},
                                     integrator_members,
                                     lua::add_class<motion::Integrator>,
                                     lua::guarded<option_by_name>,
                                     integrator_card};

}  // namespace dinal::api
