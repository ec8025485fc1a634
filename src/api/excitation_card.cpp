// M(t) as a formula for the eye. describe_excitation.cpp writes it as Lua text that makes it again.
#include <fmt/format.h>

#include <cmath>

#include "api/bind_excitation.hpp"
#include "api/cards.hpp"
#include "lua/user_function.hpp"
#include "source/function_source.hpp"

namespace dinal::api {
namespace {

constexpr int most_breaks = 6;
constexpr int most_lines = 8;  // of the text of a function

/// A function by its source text, times `gain`.
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

/// The sign that makes the amplitude of a term positive goes to the front of its line.
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

/// The first breaks, in one line.
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
