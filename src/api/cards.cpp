#include "api/cards.hpp"

#include <fmt/format.h>

#include <cmath>

#include "api/bodies.hpp"
#include "api/lua_run.hpp"
#include "lua/bind.hpp"
#include "lua/user_function.hpp"
#include "lua/vector.hpp"
#include "model/laws/coulomb.hpp"
#include "model/oscillator.hpp"
#include "source/describe.hpp"
#include "source/function_source.hpp"
#include "text/characters.hpp"

namespace dinal::api {

namespace {

using model::name_with_unit;

/// Name, value and remark in columns; a remark that does not fit is omitted.
std::string row(std::string_view name, double value, std::string_view remark, const terminal::Display& screen) {
    const std::string text = fmt::format("  {:<9}  {:<10.6g}", name, value);
    const bool fits = text::columns(text) + text::columns(remark) + 1 < screen.width;
    return "\n" + (fits ? text + " " + std::string(remark) : text.substr(0, text.find_last_not_of(' ') + 1));
}

}  // namespace

std::string system_card(lua_State* L, int index, const terminal::Display& screen) {
    const SystemHandle& handle = *lua::test<SystemHandle>(L, index);
    const auto one = oscillator_of(*handle);
    if (!one) return source::lua_text(L, *handle);
    const model::Oscillator& system = one.value();
    std::string text = terminal::spelled("system  I θ'' + C θ' + Rd sgn θ' + k θ = M(t)", screen);
    text = text::columns(text) < screen.width ? text : "system";
    const model::Units& units = system.units();
    text += row("I", system.inertia(),
                name_with_unit(units.theta == "rad" ? "moment of inertia" : "inertia", units.inertia()), screen);
    text += row("k", system.stiffness(), name_with_unit("stiffness", units.stiffness()), screen);
    text += row("C", system.damping(), name_with_unit("viscous damping", units.damping()), screen);
    const model::Friction law = system.friction().under(1);
    text += row("Rd", law.kinetic(), name_with_unit("dry friction while sliding", units.M), screen);
    text += row("Re", law.greatest_holding(), name_with_unit("breakaway torque", units.M), screen);
    if (system.friction().normal() != 1) {
        text += row("normal", system.friction().normal(), "factor of the torques of friction", screen);
    }
    if (!system.friction().none() && system.friction().as<model::laws::Coulomb>() == nullptr) {
        text += "\n  friction   " + source::lua_text(L, system.friction());
    }
    if (!system.spring().none()) {
        text += "\n  spring     " + source::lua_text(L, system.spring());
    }
    if (system.walls()) {
        text += "\n  walls      " + system.walls()->lua_text();
    }
    if (!units.usual()) {
        std::string words = units.in_words();
        constexpr std::string_view place = "\n             ";
        const bool fits = place.size() + words.size() <= screen.width;
        for (std::size_t at = words.find(", "); !fits && at != std::string::npos; at = words.find(", ", at + 1)) {
            words.replace(at + 1, 1, place);
        }
        text += "\n  units      " + words;
    }
    if (!system.has_spring()) {
        return text;
    }
    text += row("omega0", system.natural_frequency(),
                "natural frequency, rad per " + (units.t.empty() ? "time unit" : units.t), screen);
    text += row("T0", system.natural_period(), name_with_unit("natural period", units.t), screen);
    text += row("zeta", system.damping_ratio(), "damping ratio: " + std::string(model::name(system.regime())), screen);
    if (!system.spring().none()) {
        return text;
    }
    const std::string place = terminal::spelled("the mass can rest wherever |θ| <= this", screen);
    text += row("dead_zone", system.dead_zone(), units.usual() ? place : name_with_unit(place, units.theta), screen);
    return text;
}

std::string integrator_card(lua_State* L, int index, const terminal::Display& screen) {
    const motion::MethodView method = *lua::test<motion::Integrator>(L, index);
    return text::wrapped(method.lua_text(text::Defaults::described), screen.width - 1);
}

std::string vector_text(const lua::Vector& v, std::size_t whole, std::size_t ends) {
    const auto list = [](std::span<const double> x) { return fmt::format("{:.6g}", fmt::join(x, ", ")); };
    if (v.size() == 0) return "vector{}";
    if (v.size() <= whole) return fmt::format("vector{{ {} }}", list(v.values()));
    return fmt::format("vector{{ {}, ..., {} }}  -- {} numbers", list(v.values().first(ends)),
                       list(v.values().last(ends)), v.size());
}

std::string vector_card(lua_State* L, int index, const terminal::Display& screen) {
    const lua::Vector& v = *lua::test<lua::Vector>(L, index);
    std::size_t ends = 5, whole = 12;
    std::string line = vector_text(v, whole, ends);
    for (; ends > 1 && text::columns(line) >= screen.width; line = vector_text(v, whole, ends)) whole = 2 * --ends;
    return text::columns(line) < screen.width ? line
                                              : fmt::format("{} ({})", line.substr(0, line.find("  --")), v.size());
}

std::string run_card(lua_State* L, int index, const terminal::Display& screen) {
    const LuaRun& run = **lua::test<RunHandle>(L, index);
    std::string text = line_of(run);
    if (run.origin) {
        const std::string_view name = motion::MethodView(run.origin->integrator).about().call.name;
        text.append("; by ").append(name.substr(name.find('.') + 1));
    }
    if (const model::Units& units = units_of(run); !units.usual()) {
        text.append("; ").append(units.in_words());
    }
    return text::wrapped(terminal::spelled(text, screen), screen.width - 1);
}

// M(t) as a formula for display. source/describe.cpp writes it as Lua text.

namespace {

constexpr int most_breaks = 6;
constexpr int most_lines = 8;  // lines of a function's text

/// A function as its source text, times `gain`.
std::string formula(lua_State* L, const model::Scripted& s, double gain) {
    const auto* function = dynamic_cast<const lua::LuaFunction*>(s.function.get());
    std::string text = "a function";
    if (function != nullptr) {
        function->push(L);
        text = source::function_source(L, -1).value_or(text);
        lua_pop(L, 1);
    }
    std::size_t end = 0;
    for (int line = 0; line < most_lines && end != std::string::npos; ++line) {
        end = text.find('\n', end + 1);
    }
    text = end == std::string::npos ? text : text.substr(0, end) + "\n...";
    return (gain == 1 ? "" : fmt::format("{:.6g} * ", gain)) + text +
           (s.delay == 0 ? "" : fmt::format(", later by {:.6g}", s.delay));
}

template <model::terms::NativeTerm T>
std::string formula(lua_State* /*L*/, const T& term, double gain) {
    return term.formula(gain);
}

/// The amplitude of a term; its sign goes to the front of the line.
double* amplitude_of(model::Term& term) {
    return std::visit(
        [](auto& t) -> double* {
            if constexpr (requires { t.amplitude; }) {
                return &t.amplitude;
            } else if constexpr (requires { t.slope; }) {
                return &t.slope;
            } else {
                return nullptr;
            }
        },
        term);
}

std::string line_of(lua_State* L, model::Component c, bool first) {
    if (double* amplitude = amplitude_of(c.term); amplitude != nullptr && *amplitude < 0) {
        *amplitude = -*amplitude;
        c.gain = -c.gain;
    }
    std::string text = c.gain < 0 ? "\n  - " : first ? "\n    " : "\n  + ";
    for (const char letter :
         std::visit([&](const auto& term) { return formula(L, term, std::fabs(c.gain)); }, c.term)) {
        text += letter;
        text += letter == '\n' ? "    " : "";
    }
    if (c.from > -model::never || c.to < model::never) {
        text += fmt::format(", within {:.6g} <= t < {:.6g}", c.from, c.to);
    }
    return text;
}

/// The first breaks in one line.
std::string breaks_of(const model::Excitation& excitation, std::size_t width) {
    std::string text;
    int count = 0;
    double t = excitation.next_break(std::nextafter(0.0, -1.0));
    while (t < model::never) {
        const std::string next = fmt::format("{}{:.6g}", count == 0 ? "\n  jumps or kinks at t = " : ", ", t);
        constexpr std::string_view rest = ", ...";
        if (count == most_breaks || (count > 0 && text.size() + next.size() + rest.size() > width)) {
            return text.append(rest);
        }
        text += next;
        ++count;
        t = excitation.next_break(t);
    }
    return text;
}

}  // namespace

std::string excitation_card(lua_State* L, int index, const terminal::Display& screen) {
    const model::Excitation& excitation = *lua::test<model::Excitation>(L, index);
    luaL_checkstack(L, LUA_MINSTACK, "for the text of an excitation");
    std::string text =
        terminal::spelled(excitation.has_feedback() ? "excitation  M(t, θ, θ') =" : "excitation  M(t) =", screen);
    for (const model::Component& c : excitation.components()) {
        text += line_of(L, c, &c == &excitation.components().front());
    }
    return text + (excitation.components().empty() ? " 0" : breaks_of(excitation, screen.width));
}

}  // namespace dinal::api
