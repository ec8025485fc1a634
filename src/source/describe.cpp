#include "source/describe.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "lua/user_function.hpp"
#include "model/controller.hpp"
#include "model/functions.hpp"
#include "model/laws/coulomb.hpp"
#include "model/laws/user_law.hpp"
#include "model/springs/user_spring.hpp"
#include "source/function_source.hpp"
#include "source/value_text.hpp"
#include "text/characters.hpp"
#include "text/option.hpp"

namespace dinal::source {

std::string lua_text(lua_State* L, const model::Friction& law, ValueText* whole) {
    if (const auto* coulomb = law.as<model::laws::Coulomb>()) {
        return fmt::format("friction.coulomb{{ Rd = {}, Re = {} }}", coulomb->kinetic, coulomb->breakaway);
    }
    if (const auto* own = law.as<model::laws::UserLaw>()) {
        const std::string options = own->breakaway ? fmt::format(", {{ Re = {} }}", *own->breakaway) : "";
        return fmt::format("friction.law({}{})", function_text(L, *own->function, whole), options);
    }
    const std::string text = law.lua_text();
    return text.empty() ? "--[[ a law of friction written in C++ ]] nil" : text;
}

std::string lua_text(lua_State* L, const model::Spring& spring, ValueText* whole) {
    if (const auto* own = spring.as<model::springs::UserSpring>()) {
        return function_text(L, *own->function, whole);
    }
    return spring.lua_text();
}

namespace {

/// Receives options, and writes them as "I = 1", "k = 4".
struct OptionTexts {
    lua_State* L;
    ValueText* whole;
    std::vector<std::string> parts = {};

    void add(const char* name, const std::string& text) { parts.push_back(fmt::format("{} = {}", name, text)); }
    void body(const std::string& name) { parts.push_back(text::quoted(name)); }
    void unless_0(const char* name, double x) {
        if (x != 0) (*this)(name, x);
    }
    void operator()(const char* name, double x) { add(name, text::number_literal(x)); }
    void operator()(const char* name, bool /*yes*/) { add(name, "true"); }
    void operator()(const char* name, const model::Excitation& value) { add(name, describe(L, value, whole)); }
    void operator()(const char* name, const model::UserFunction& value) { add(name, function_text(L, value, whole)); }
    void operator()(const char* name, const model::Friction& value) { add(name, lua_text(L, value, whole)); }
    void operator()(const char* name, const model::Spring& value) { add(name, lua_text(L, value, whole)); }
    void operator()(const char* name, const model::Walls& value) { add(name, value.lua_text()); }
    void operator()(const char* name, const std::vector<model::Friction>& laws) {
        std::vector<std::string> texts;
        texts.reserve(laws.size());
        for (const model::Friction& law : laws) texts.push_back(lua_text(L, law, whole));
        add(name, fmt::format("{{ {} }}", fmt::join(texts, ", ")));
    }
};

/// "{ I = 1, k = 4, Rd = 0.3 }", or for a link "{ \"motor\", \"load\", k = 90 }".
std::string joint_text(lua_State* L, const model::System& system, std::size_t j, ValueText* whole) {
    OptionTexts texts{L, whole};
    model::give_options(system, j, texts);
    if (!system.named && !system.units.usual()) texts.add("units", system.units.lua_text());
    return fmt::format("{{ {} }}", fmt::join(texts.parts, ", "));
}

}  // namespace

std::string lua_text(lua_State* L, const model::System& system, ValueText* whole) {
    if (!system.named) return "system" + joint_text(L, system, 0, whole);
    std::vector<std::string> bodies, links;
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        (system.is_link(j) ? links : bodies)
            .push_back(fmt::format("{} = {}", system.joints[j].name, joint_text(L, system, j, whole)));
    }
    std::string text = fmt::format("system{{ bodies = {{ {} }}", fmt::join(bodies, ", "));
    if (!links.empty()) text += fmt::format(", links = {{ {} }}", fmt::join(links, ", "));
    if (!system.units.usual()) text += ", units = " + system.units.lua_text();
    return text + " }";
}

std::string lua_text(motion::MethodView method) {
    return method.lua_text(text::Defaults::left_out);
}

namespace {

/// `whole` writes functions with everything they refer to; without it, the text is for display.
struct Context {
    lua_State* L;
    ValueText* whole;
};

template <model::terms::NativeTerm T>
std::string text_of(const Context& /*context*/, const T& term) {
    return text::lua_text(T::about.call.name, T::about.call.options, term, text::Defaults::written);
}

std::string delay_text(double delay) {
    return delay == 0 ? "" : fmt::format(":delay({})", text::number_literal(delay));
}

std::string text_of(const Context& context, const model::Polyline& line) {
    const std::size_t most_written_out = context.whole != nullptr ? 10'000 : 8;
    const model::Samples& s = *line.samples;
    const auto aside = context.whole != nullptr ? context.whole->aside(s.t) : std::nullopt;
    if (!aside && !s.origin.empty()) {
        return fmt::format("excitation.samples({}){}", s.origin, delay_text(s.delay));
    }
    std::string between;
    if (s.interpolation != model::Interpolation::linear) {
        between = fmt::format(", interpolation = \"{}\"",
                              model::terms::interpolation_names[static_cast<std::size_t>(s.interpolation)]);
    }
    if (s.period) between += ", period = " + text::number_literal(*s.period);
    if (aside) {
        return fmt::format("excitation.samples{{ t = {}, M = {}{} }}", *aside, *context.whole->aside(s.M), between);
    }
    if (s.t.size() <= most_written_out) {
        return fmt::format("excitation.samples{{ t = {}, M = {}{} }}", text::list_literal(s.t), text::list_literal(s.M),
                           between);
    }
    return fmt::format("excitation.samples{{ --[[ {} points, t {} ... {} ]]{} }}", s.t.size(), s.t.front(), s.t.back(),
                       between.empty() ? "" : " " + between.substr(2));
}

/// The text of the function on the top of the stack, which is popped.
std::string popped_text(lua_State* L, ValueText* whole) {
    std::string text;
    if (whole != nullptr) {
        text = whole->expression(-1);
    } else if (const auto source = function_source(L, -1)) {
        text = *source;
    } else if (lua_type(L, -1) != LUA_TFUNCTION) {
        text = fmt::format("--[[ {} with __call ]]", lua::describe(L, -1));
    } else if (lua_iscfunction(L, -1) != 0) {
        const lua::Foreign* other = lua::foreign(L, -1);
        text = fmt::format("--[[ a function written in {} ]]", other != nullptr ? other->language : "C");
    } else {
        lua_Debug about{};
        lua_pushvalue(L, -1);
        lua_getinfo(L, ">S", &about);
        text = fmt::format("--[[ the function at {}:{} ]]", about.short_src, about.linedefined);
    }
    lua_pop(L, 1);
    return text;
}

/// ", start = function ... end" if the controller has one.
std::string start_text(const Context& context, const model::UserFunction& function) {
    const auto* own = dynamic_cast<const lua::LuaFunction*>(&function);
    if (own == nullptr || !own->push_start(context.L)) return "";
    return ", start = " + popped_text(context.L, context.whole);
}

/// A controller with a memory.
std::string text_of(const Context& context, const model::Controller& controller) {
    const auto function = [&](const auto& own) { return function_text(context.L, *own.function, context.whole); };
    if (const auto* sampled = dynamic_cast<const model::SampledController*>(&controller)) {
        return fmt::format("excitation.sampled({}, {{ every = {}, delay = {}, at = {}{} }})", function(*sampled),
                           sampled->every, sampled->delay, sampled->at, start_text(context, *sampled->function));
    }
    if (const auto* delayed = dynamic_cast<const model::DelayedController*>(&controller)) {
        return fmt::format("excitation.delayed({}, {{ by = {} }})", function(*delayed), delayed->by);
    }
    const auto& relay = dynamic_cast<const model::RelayController&>(controller);
    using Of = model::RelayController::Of;
    const std::string of = relay.of == Of::theta      ? "\"theta\""
                           : relay.of == Of::velocity ? "\"velocity\""
                           : relay.of == Of::state    ? "\"" + relay.state + "\""
                                                      : function(relay);
    return fmt::format("excitation.relay{{ on = {}, off = {}, amplitude = {{ {}, {} }}, of = {}, start = \"{}\" }}",
                       relay.on, relay.off, relay.levels[0], relay.levels[1], of, relay.starts_on ? "on" : "off");
}

std::string text_of(const Context& context, const model::Scripted& s) {
    if (const auto* controller = dynamic_cast<const model::Controller*>(s.function.get())) {
        return text_of(context, *controller);
    }
    std::string options;
    if (!s.breaks.empty()) {
        options += "breaks = " + text::list_literal(s.breaks);
    }
    if (s.period > 0) {
        options += (options.empty() ? "" : ", ") + std::string("period = ") + text::number_literal(s.period);
    }
    return fmt::format("excitation.scripted({}{}){}", function_text(context.L, *s.function, context.whole),
                       options.empty() ? "" : ", { " + options + " }", delay_text(s.delay));
}

}  // namespace

std::string function_text(lua_State* L, const model::UserFunction& user_function, ValueText* whole) {
    const auto* function = dynamic_cast<const lua::LuaFunction*>(&user_function);
    if (function == nullptr) {
        return "--[[ a function written in C++ ]]";
    }
    luaL_checkstack(L, LUA_MINSTACK, "for the text of a function");
    function->push(L);
    return popped_text(L, whole);
}

const lua::LuaFunction* function_alone(const model::Excitation& excitation) {
    if (excitation.components().size() != 1) return nullptr;
    const model::Component& only = excitation.components().front();
    const auto* scripted = std::get_if<model::Scripted>(&only.term);
    const bool plain = scripted != nullptr && only.gain == 1 && only.from == -model::never && only.to == model::never &&
                       scripted->breaks.empty() && scripted->period == 0 && scripted->delay == 0;
    return plain ? dynamic_cast<const lua::LuaFunction*>(scripted->function.get()) : nullptr;
}

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
            text += text::number_literal(std::fabs(c.gain)) + " * ";
        }
        text += std::visit([&context](const auto& term) { return text_of(context, term); }, c.term);
        if (c.from > -model::never || c.to < model::never) {
            text += fmt::format(":window({}, {})", text::number_literal(c.from), text::number_literal(c.to));
        }
    }
    return text.empty() ? "excitation.constant{ amplitude = 0 }" : text;
}

}  // namespace dinal::source
