#include "source/describe.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "lua/bind.hpp"
#include "lua/standard_globals.hpp"
#include "lua/user_function.hpp"
#include "lua/vector.hpp"
#include "model/controller.hpp"
#include "model/functions.hpp"
#include "model/laws/coulomb.hpp"
#include "model/laws/user_law.hpp"
#include "model/springs.hpp"
#include "motion/integrators.hpp"
#include "source/function_source.hpp"
#include "text/characters.hpp"
#include "text/option.hpp"
#include "text/words.hpp"

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
    void operator()(const char* name, const model::Excitation& value) { add(name, lua_text(L, value, whole)); }
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

std::string lua_text(lua_State* L, const model::Excitation& excitation, ValueText* whole) {
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

// Lua text of values and functions.

namespace {

constexpr std::size_t deepest = 50;  // nesting depth of tables and functions, which use the C++ stack

}  // namespace

std::string ValueText::nothing(std::string_view what) {
    remarks_.push_back(fmt::format("-- {} could not be written down", what));
    return "nil";
}

std::string ValueText::expression(int index) {
    luaL_checkstack(L_, 10, "too deep");
    index = lua_absindex(L_, index);
    if (--budget_ < 0) {
        return budget_ == -1 ? nothing("a part of a large table") : "nil";
    }
    switch (lua_type(L_, index)) {
        case LUA_TNIL:
            return "nil";
        case LUA_TBOOLEAN:
            return lua_toboolean(L_, index) != 0 ? "true" : "false";
        case LUA_TNUMBER:
            return lua_isinteger(L_, index) != 0 ? fmt::format("{}", lua_tointeger(L_, index))
                                                 : lua::float_text(lua_tonumber(L_, index));
        case LUA_TSTRING:
            return text::quoted(lua::text_at(L_, index));
        case LUA_TTABLE:
            return table(index);
        case LUA_TFUNCTION:
            return function(index);
        case LUA_TUSERDATA:
            return object(index);
        default:
            return nothing(lua::describe(L_, index));
    }
}

std::string ValueText::table(int index) {
    const void* identity = lua_topointer(L_, index);
    if (text::contains(open_, identity) || open_.size() > deepest) {
        return nothing("a table that contains itself");
    }
    const int top = lua_gettop(L_);
    // The metatable of rows of data and balances only stores the order of names.
    if (lua_getmetatable(L_, index) != 0 && luaL_getmetafield(L_, index, "names") == LUA_TNIL) {
        remarks_.emplace_back("-- the metatable of a table could not be written down");
    }
    lua_settop(L_, top);
    open_.push_back(identity);
    std::string text;
    const auto sequence = static_cast<lua_Integer>(lua_rawlen(L_, index));
    for (lua_Integer i = 1; i <= sequence && budget_ >= 0; ++i) {
        lua_rawgeti(L_, index, i);
        text += (text.empty() ? "" : ", ") + expression(-1);
        lua_pop(L_, 1);
    }
    std::vector<std::string> named;
    lua_pushnil(L_);
    while (budget_ >= 0 && lua_next(L_, index) != 0) {
        const bool listed =
            lua_isinteger(L_, -2) != 0 && lua_tointeger(L_, -2) >= 1 && lua_tointeger(L_, -2) <= sequence;
        if (!listed) {
            const bool plain = lua_type(L_, -2) == LUA_TSTRING && lua::is_name(lua_tostring(L_, -2));
            const std::string key = plain ? lua_tostring(L_, -2) : "[" + expression(-2) + "]";
            named.push_back(key + " = " + expression(-1));
        }
        lua_pop(L_, 1);
    }
    std::ranges::sort(named);  // the same text in each process
    for (const std::string& entry : named) text += (text.empty() ? "" : ", ") + entry;
    lua_settop(L_, top);  // the loop may end early
    open_.pop_back();
    return text.empty() ? "{}" : "{ " + text + " }";
}

std::string ValueText::object(int index) {
    if (const auto* vector = lua::test<lua::Vector>(L_, index)) {
        if (aside_) return aside_(index);
        budget_ -= static_cast<int>(std::min<std::size_t>(vector->size(), 1'000'000));
        if (budget_ < 0) {
            return nothing("a long vector");
        }
        std::string text;
        for (const double x : vector->values()) {
            text += (text.empty() ? "" : ", ") + lua::float_text(x);
        }
        return "vector{ " + text + " }";
    }
    std::string own;
    visit_object(L_, index, [&](const auto& object) { own = lua_text(L_, object, this); });
    if (const auto* method = lua::test<motion::Integrator>(L_, index)) own = lua_text(*method);
    if (!own.empty()) return own;
    if (aside_ && lua::documented(L_, index).owner != nullptr) own = aside_(index);
    if (!own.empty()) return own;
    return nothing(lua::describe(L_, index));
}

std::optional<std::string> ValueText::aside(const std::vector<double>& numbers) {
    if (!aside_) return std::nullopt;
    lua::push_vector(L_, numbers);
    std::string name = aside_(lua_gettop(L_));
    lua_pop(L_, 1);
    return name;
}

std::string ValueText::function(int index) {
    const void* identity = lua_topointer(L_, index);
    if (text::contains(open_, identity)) {
        return nothing("a function that refers to itself in a roundabout way");
    }
    if (open_.size() > deepest) {
        return nothing("a function within too many others");
    }
    const auto source = function_source(L_, index);
    if (!source) {
        const lua::Foreign* other = lua::foreign(L_, index);
        if (aside_ && other != nullptr) return aside_(index);
        return nothing(other != nullptr ? fmt::format("a function written in {}", other->language)
                                        : "a function whose text is not at hand");
    }
    if (lua_iscfunction(L_, index) != 0) {
        return *source;
    }
    open_.push_back(identity);
    note_globals(index, *source);
    std::string text = with_locals(index, *source);
    open_.pop_back();
    return text;
}

/// (function() local a = 1; return function(t) return a*t end end)() for a function with upvalues.
std::string ValueText::with_locals(int index, const std::string& source) {
    std::string locals;
    std::string own_name;  // in local function f(t) ... f(t - 1) ... end, f is an upvalue of f
    for (int i = 1; const char* name = lua_getupvalue(L_, index, i); ++i) {
        const bool environment = std::string_view(name) == "_ENV";
        if (lua_rawequal(L_, -1, index) != 0) {
            own_name = name;
        } else if (!environment && *name != '\0') {
            locals += fmt::format("local {} = {}\n", name, expression(-1));
        }
        lua_pop(L_, 1);
    }
    if (locals.empty() && own_name.empty()) {
        return source;
    }
    const std::string result =
        own_name.empty() ? "return " + source : fmt::format("local {0}; {0} = {1}\nreturn {0}", own_name, source);
    return "(function()\n" + locals + result + "\nend)()";
}

void ValueText::note_globals(int function_index, std::string_view source) {
    for (int i = 1; const char* name = lua_getupvalue(L_, function_index, i); ++i) {
        if (std::string_view(name) == "_ENV" && lua_istable(L_, -1)) {
            const int environment = lua_gettop(L_);
            for (const std::string& free : lua::free_names(source)) {
                note_global(environment, free);
            }
        }
        lua_pop(L_, 1);
    }
}

void ValueText::note_global(int environment, const std::string& name) {
    if (text::contains(names_, name)) {
        return;
    }
    lua::push_standard_globals(L_);
    lua_pushlstring(L_, name.data(), name.size());
    lua_pushvalue(L_, -1);
    lua_rawget(L_, environment);
    lua_insert(L_, -2);
    lua_rawget(L_, -3);  // stack: standard globals, value, standard value
    const bool users = !lua_isnil(L_, -2) && lua_rawequal(L_, -1, -2) == 0;
    lua_pop(L_, 1);
    if (users) {
        names_.push_back(name);
        const bool itself = text::contains(open_, lua_topointer(L_, -1));
        // function M(t) return M_old(t) end needs M_old first; a function that calls itself already exists under its
        // name, if it has one.
        if (itself && aside_) nothing("the global function " + name + ", which calls itself: make it local");
        globals_.push_back(name + " = " + (itself ? "nil" : expression(-1)));
    }
    lua_pop(L_, 2);
}

}  // namespace dinal::source
