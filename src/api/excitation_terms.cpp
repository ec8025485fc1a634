// excitation.pulse{...} and its like: the terms that take a table of numbers.
#include <fmt/format.h>

#include <numbers>

#include "api/bind_excitation.hpp"
#include "lua/options.hpp"

namespace dinal::api::excitation_functions {

namespace {

/// The one of two options that says the same thing in two ways.
bool first_is_given(const lua::Options& options, std::string_view first, std::string_view second) {
    if (options.has(first) == options.has(second)) {
        options.fail(options.has(first) ? fmt::format("{} and {} say the same; give one of them", first, second)
                                        : fmt::format("one of {} and {} is needed", first, second));
    }
    return options.has(first);
}

double omega_of(const lua::Options& options) {
    if (!first_is_given(options, "frequency", "omega")) {
        return options.number("omega");
    }
    const double frequency = options.number("frequency");
    if (frequency < 0) {
        options.fail(fmt::format("frequency = {} must not be negative", frequency));
    }
    return 2 * std::numbers::pi * frequency;
}

double period_of(const lua::Options& options) {
    if (first_is_given(options, "period", "frequency")) {
        return options.number("period");
    }
    const double frequency = options.number("frequency");
    if (frequency <= 0) {
        options.fail(fmt::format("frequency = {} must be positive", frequency));
    }
    return 1 / frequency;
}

}  // namespace

int push_term(lua_State* L, model::Term term) {
    auto made = model::Excitation::make(std::move(term));
    if (!made) {
        lua::raise(L, made.error());
    }
    lua::push(L, std::move(made).value());
    return 1;
}

int constant(lua_State* L) {
    const lua::Options o(L, 1, "excitation.constant", "excitation.constant{ level = 1 }", {"level"});
    return push_term(L, model::Constant{o.number("level")});
}

int harmonic(lua_State* L) {
    const lua::Options o(L, 1, "excitation.harmonic", "excitation.harmonic{ amplitude = 1, frequency = 1 }",
                         {"amplitude", "frequency", "omega", "phase"});
    return push_term(L, model::Harmonic{o.number("amplitude", 1), omega_of(o), o.number("phase", 0)});
}

int step(lua_State* L) {
    const lua::Options o(L, 1, "excitation.step", "excitation.step{ level = 1, at = 2 }", {"level", "at"});
    return push_term(L, model::Step{o.number("level", 1), o.number("at", 0)});
}

int pulse(lua_State* L) {
    const lua::Options o(L, 1, "excitation.pulse", "excitation.pulse{ at = 1, width = 0.2 }",
                         {"amplitude", "at", "width"});
    return push_term(L, model::Pulse{o.number("amplitude", 1), o.number("at", 0), o.number("width")});
}

int half_sine(lua_State* L) {
    const lua::Options o(L, 1, "excitation.half_sine", "excitation.half_sine{ at = 1, width = 0.2 }",
                         {"amplitude", "at", "width"});
    return push_term(L, model::HalfSine{o.number("amplitude", 1), o.number("at", 0), o.number("width")});
}

int gaussian(lua_State* L) {
    const lua::Options o(L, 1, "excitation.gaussian", "excitation.gaussian{ at = 1, width = 0.2 }",
                         {"amplitude", "at", "width"});
    return push_term(L, model::Gaussian{o.number("amplitude", 1), o.number("at", 0), o.number("width")});
}

int ramp(lua_State* L) {
    const lua::Options o(L, 1, "excitation.ramp", "excitation.ramp{ slope = 2, at = 1 }", {"slope", "at", "width"});
    return push_term(L, model::Ramp{o.number("slope", 1), o.number("at", 0), o.extended_number("width", model::never)});
}

int square(lua_State* L) {
    const lua::Options o(L, 1, "excitation.square", "excitation.square{ period = 2 }",
                         {"amplitude", "period", "frequency", "duty", "at"});
    return push_term(L,
                     model::Square{o.number("amplitude", 1), period_of(o), o.number("duty", 0.5), o.number("at", 0)});
}

int sawtooth(lua_State* L) {
    const lua::Options o(L, 1, "excitation.sawtooth", "excitation.sawtooth{ period = 2 }",
                         {"amplitude", "period", "frequency", "at"});
    return push_term(L, model::Sawtooth{o.number("amplitude", 1), period_of(o), o.number("at", 0)});
}

int triangle(lua_State* L) {
    const lua::Options o(L, 1, "excitation.triangle", "excitation.triangle{ period = 2 }",
                         {"amplitude", "period", "frequency", "at"});
    return push_term(L, model::Triangle{o.number("amplitude", 1), period_of(o), o.number("at", 0)});
}

int chirp(lua_State* L) {
    const lua::Options o(L, 1, "excitation.chirp", "excitation.chirp{ from = 0.2, to = 2, duration = 20 }",
                         {"amplitude", "from", "to", "duration", "at", "phase"});
    return push_term(L, model::Chirp{o.number("amplitude", 1), o.number("from"), o.number("to"), o.number("duration"),
                                     o.number("at", 0), o.number("phase", 0)});
}

int exponential(lua_State* L) {
    const lua::Options o(L, 1, "excitation.exponential", "excitation.exponential{ amplitude = 2, tau = 0.5 }",
                         {"amplitude", "tau", "at"});
    return push_term(L, model::Exponential{o.number("amplitude", 1), o.number("tau"), o.number("at", 0)});
}

int polynomial(lua_State* L) {
    const lua::Options o(L, 1, "excitation.polynomial", "excitation.polynomial{ coefficients = { 1, 0.5 } }",
                         {"coefficients", "at"});
    if (!o.has("coefficients")) {
        o.missing("coefficients");
    }
    return push_term(L, model::Polynomial{o.numbers("coefficients"), o.number("at", 0)});
}

}  // namespace dinal::api::excitation_functions
