#include <fmt/format.h>

#include <cmath>

#include "lua/user_function.hpp"
#include "source/describe.hpp"
#include "source/function_source.hpp"
#include "source/value_text.hpp"

namespace dinal::source {
namespace {

/// `whole` writes functions down with all that they refer to; without it, text is for the eye.
struct Context {
    lua_State* L;
    ValueText* whole;
};

/// Reads back exactly; "1" and not "1.0", since all options are numbers of the one kind.
std::string text_of(double x) {
    if (std::isinf(x)) {
        return x > 0 ? "math.huge" : "-math.huge";
    }
    return fmt::format("{}", x);
}

std::string list_text(const std::vector<double>& numbers) {
    std::string text = "{ ";
    for (const double x : numbers) {
        text += (text.size() > 2 ? ", " : "") + text_of(x);
    }
    return text + " }";
}

struct Option {
    std::string_view name;
    double value;
};

std::string call_text(std::string_view term, std::initializer_list<Option> options) {
    std::string list;
    for (const Option& option : options) {
        list += fmt::format("{}{} = {}", list.empty() ? "" : ", ", option.name, text_of(option.value));
    }
    return fmt::format("excitation.{}{{ {} }}", term, list);
}

std::string text_of(const Context&, const model::Constant& c) {
    return call_text("constant", {{"level", c.level}});
}
std::string text_of(const Context&, const model::Harmonic& h) {
    return call_text("harmonic", {{"amplitude", h.amplitude}, {"omega", h.omega}, {"phase", h.phase}});
}
std::string text_of(const Context&, const model::Step& s) {
    return call_text("step", {{"level", s.level}, {"at", s.at}});
}
std::string text_of(const Context&, const model::Pulse& p) {
    return call_text("pulse", {{"amplitude", p.amplitude}, {"at", p.at}, {"width", p.width}});
}
std::string text_of(const Context&, const model::HalfSine& h) {
    return call_text("half_sine", {{"amplitude", h.amplitude}, {"at", h.at}, {"width", h.width}});
}
std::string text_of(const Context&, const model::Ramp& r) {
    return r.width == model::never ? call_text("ramp", {{"slope", r.slope}, {"at", r.at}})
                                   : call_text("ramp", {{"slope", r.slope}, {"at", r.at}, {"width", r.width}});
}
std::string text_of(const Context&, const model::Square& s) {
    return call_text("square", {{"amplitude", s.amplitude}, {"period", s.period}, {"duty", s.duty}, {"at", s.at}});
}
std::string text_of(const Context&, const model::Sawtooth& s) {
    return call_text("sawtooth", {{"amplitude", s.amplitude}, {"period", s.period}, {"at", s.at}});
}
std::string text_of(const Context&, const model::Triangle& s) {
    return call_text("triangle", {{"amplitude", s.amplitude}, {"period", s.period}, {"at", s.at}});
}
std::string text_of(const Context&, const model::Chirp& c) {
    return call_text("chirp", {{"amplitude", c.amplitude},
                               {"from", c.from},
                               {"to", c.to},
                               {"duration", c.duration},
                               {"at", c.at},
                               {"phase", c.phase}});
}
std::string text_of(const Context&, const model::Exponential& e) {
    return call_text("exponential", {{"amplitude", e.amplitude}, {"tau", e.tau}, {"at", e.at}});
}
std::string text_of(const Context&, const model::Polynomial& p) {
    return fmt::format("excitation.polynomial{{ coefficients = {}, at = {} }}", list_text(p.coefficients),
                       text_of(p.at));
}

std::string delay_text(double delay) {
    return delay == 0 ? "" : fmt::format(":delay({})", text_of(delay));
}

std::string text_of(const Context& context, const std::shared_ptr<const model::Samples>& samples) {
    const std::size_t most_written_out = context.whole != nullptr ? 10'000 : 8;
    const model::Samples& s = *samples;
    if (!s.origin.empty()) {
        return fmt::format("excitation.samples({}){}", s.origin, delay_text(s.delay));
    }
    if (s.t.size() <= most_written_out) {
        return fmt::format("excitation.samples{{ t = {}, M = {} }}", list_text(s.t), list_text(s.M));
    }
    return fmt::format("excitation.samples{{ --[[ {} points, t {} ... {} ]] }}", s.t.size(), s.t.front(), s.t.back());
}

/// The function as text, or a comment that says which one it was.
std::string function_text(const Context& context, const lua::LuaFunction& function) {
    lua_State* L = context.L;
    luaL_checkstack(L, LUA_MINSTACK, "for the text of a function");
    function.push(L);
    std::string text;
    if (context.whole != nullptr) {
        text = context.whole->expression(-1);
    } else if (const auto source = function_source(L, -1)) {
        text = *source;
    } else if (lua_type(L, -1) != LUA_TFUNCTION) {
        text = fmt::format("--[[ {} with __call ]]", lua::describe(L, -1));
    } else if (lua_iscfunction(L, -1) != 0) {
        text = "--[[ a function written in C ]]";
    } else {
        lua_Debug about{};
        lua_pushvalue(L, -1);
        lua_getinfo(L, ">S", &about);
        text = fmt::format("--[[ the function at {}:{} ]]", about.short_src, about.linedefined);
    }
    lua_pop(L, 1);
    return text;
}

std::string text_of(const Context& context, const model::Scripted& s) {
    std::string options;
    if (!s.breaks.empty()) {
        options += "breaks = " + list_text(s.breaks);
    }
    if (s.period > 0) {
        options += (options.empty() ? "" : ", ") + std::string("period = ") + text_of(s.period);
    }
    const auto* function = dynamic_cast<const lua::LuaFunction*>(s.function.get());
    return fmt::format("excitation.scripted({}{}){}",
                       function != nullptr ? function_text(context, *function) : "--[[ a function written in C++ ]]",
                       options.empty() ? "" : ", { " + options + " }", delay_text(s.delay));
}

}  // namespace

std::string describe(lua_State* L, const model::Excitation& excitation, ValueText* whole) {
    const Context context{L, whole};
    std::string text;
    for (const model::Component& c : excitation.components()) {
        const bool negative = std::signbit(c.gain);
        if (text.empty()) {
            text += negative ? "-" : "";
        } else {
            text += negative ? " - " : " + ";
        }
        if (std::fabs(c.gain) != 1) {
            text += text_of(std::fabs(c.gain)) + " * ";
        }
        text += std::visit([&context](const auto& term) { return text_of(context, term); }, c.term);
        if (c.from > -model::never || c.to < model::never) {
            text += fmt::format(":window({}, {})", text_of(c.from), text_of(c.to));
        }
    }
    return text.empty() ? "excitation.constant{ level = 0 }" : text;
}

}  // namespace dinal::source
