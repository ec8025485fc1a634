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

/// A number as a factor: "2 ", and nothing for 1.
std::string factor(double x) {
    return x == 1 ? "" : fmt::format("{:.6g} ", x);
}

/// "t", "(t - 2)" or "(t + 2)".
std::string after(double at) {
    return at == 0 ? "t" : fmt::format("(t {} {:.6g})", at < 0 ? '+' : '-', std::fabs(at));
}

std::string from(double at) {
    return at == -model::never ? "" : fmt::format(" for t >= {:.6g}", at);
}

std::string between(double first, double last) {
    return fmt::format(" for {:.6g} <= t < {:.6g}", first, last);
}

std::string wave(std::string_view shape, double amplitude, double period, double at) {
    return fmt::format("{:.6g} {} of period {:.6g}{}", amplitude, shape, period,
                       at == 0 ? "" : fmt::format(" that begins at {:.6g}", at));
}

/// Each formula is of the term times `a`, a factor that is not negative.
struct Formula {
    lua_State* L;
    double a;

    std::string operator()(const model::Constant& c) const { return fmt::format("{:.6g}", a * c.level); }
    std::string operator()(const model::Harmonic& h) const {
        return h.phase == 0 ? fmt::format("{}sin({:.6g} t)", factor(a * h.amplitude), h.omega)
                            : fmt::format("{}sin({:.6g} t {} {:.6g})", factor(a * h.amplitude), h.omega,
                                          h.phase < 0 ? '-' : '+', std::fabs(h.phase));
    }
    std::string operator()(const model::Step& s) const { return fmt::format("{:.6g}{}", a * s.level, from(s.at)); }
    std::string operator()(const model::Pulse& p) const {
        return fmt::format("{:.6g}{}", a * p.amplitude, between(p.at, p.at + p.width));
    }
    std::string operator()(const model::HalfSine& h) const {
        return fmt::format("{}sin(pi {}/{:.6g}){}", factor(a * h.amplitude), after(h.at), h.width,
                           between(h.at, h.at + h.width));
    }
    std::string operator()(const model::Ramp& r) const {
        const std::string rise = factor(a * r.slope) + after(r.at);
        return r.width == model::never
                   ? rise + from(r.at)
                   : fmt::format("{}{}, then {:.6g}", rise, between(r.at, r.at + r.width), a * r.slope * r.width);
    }
    std::string operator()(const model::Square& s) const {
        return wave("square wave", a * s.amplitude, s.period, s.at) +
               (s.duty == 0.5 ? "" : fmt::format(", positive for {:.6g} of it", s.duty));
    }
    std::string operator()(const model::Sawtooth& s) const { return wave("sawtooth", a * s.amplitude, s.period, s.at); }
    std::string operator()(const model::Triangle& s) const {
        return wave("triangle wave", a * s.amplitude, s.period, s.at);
    }
    std::string operator()(const model::Chirp& c) const {
        return fmt::format("{}sine of frequency {:.6g} ... {:.6g} for {:.6g} <= t < {:.6g}", factor(a * c.amplitude),
                           c.from, c.to, c.at, c.at + c.duration);
    }
    std::string operator()(const model::Exponential& e) const {
        return fmt::format("{}exp(-{}/{:.6g}){}", factor(a * e.amplitude), after(e.at), e.tau, from(e.at));
    }
    std::string operator()(const model::Polynomial& p) const {
        std::string text;
        for (std::size_t i = 0; i < p.coefficients.size(); ++i) {
            const double c = a * p.coefficients[i];
            if (c != 0) {
                text += text.empty() ? (c < 0 ? "-" : "") : (c < 0 ? " - " : " + ");
                const std::string power = i == 0 ? "" : i == 1 ? after(p.at) : fmt::format("{}^{}", after(p.at), i);
                text += i == 0 ? fmt::format("{:.6g}", std::fabs(c)) : factor(std::fabs(c)) + power;
            }
        }
        return text.empty() ? "0" : text;
    }
    std::string operator()(const std::shared_ptr<const model::Samples>& s) const {
        return fmt::format("{}straight lines through {} points, t {:.6g} ... {:.6g}{}", a == 1 ? "" : factor(a) + "* ",
                           s->t.size(), s->t.front(), s->t.back(),
                           s->origin.empty() ? "" : ", of " + s->origin.substr(0, s->origin.find(", {")));
    }
    std::string operator()(const model::Scripted& s) const {
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
        return (a == 1 ? "" : factor(a) + "* ") + text +
               (s.delay == 0 ? "" : fmt::format(", later by {:.6g}", s.delay));
    }
};

/// The sign that makes the amplitude of a term positive goes to the front of its line.
double* amplitude_of(model::Term& term) {
    return std::visit(
        [](auto& t) -> double* {
            if constexpr (requires { t.amplitude; }) {
                return &t.amplitude;
            } else if constexpr (requires { t.level; }) {
                return &t.level;
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
    for (const char letter : std::visit(Formula{L, std::fabs(c.gain)}, c.term)) {
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
