#include "api/bind_excitation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "api/cards.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/lua_run.hpp"
#include "files/csv.hpp"
#include "lua/bind.hpp"
#include "lua/interrupt.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "lua/values.hpp"
#include "lua/vector.hpp"
#include "model/controller.hpp"
#include "motion/witness.hpp"
#include "source/describe.hpp"
#include "text/characters.hpp"
#include "text/option.hpp"
#include "text/words.hpp"

namespace dinal::api {

model::Excitation to_excitation(lua_State* L, int index, std::string_view what, std::string_view option) {
    if (lua_isnoneornil(L, index)) {
        return {};
    }
    if (const auto* excitation = lua::test<model::Excitation>(L, index)) {
        return *excitation;
    }
    const auto refuse = [&](std::string_view wanted, std::string cure) {
        lua::raise(L, {.sentence = fmt::format("{} must be {}, got {}", what, wanted, lua::describe(L, index)),
                       .call = std::string(what),
                       .option = std::string(option),
                       .culprit = lua::written(L, index),
                       .cure = std::move(cure)});
    };
    model::Term term;
    if (lua_type(L, index) == LUA_TNUMBER) {
        term = model::Constant{lua_tonumber(L, index)};
    } else if (lua::is_callable(L, index)) {
        const std::size_t name = what.rfind(": ");  // errors contain the name of the function: "M.motor returned nil"
        lua::FunctionRole role;
        if (name != std::string_view::npos) role.name = what.substr(name + 2);
        role.may_be_negative = option != "Rd" && option != "Re";
        const auto function = std::make_shared<lua::LuaFunction>(L, index, std::move(role));
        term = model::Scripted{.function = function, .feedback = function->feedback()};
    } else {
        refuse("a function, a number or an excitation",
               lua_type(L, index) == LUA_TSTRING ? "; a function of t is written: function(t) return math.sin(t) end"
                                                 : "");
    }
    auto made = model::Excitation::make(std::move(term));
    if (!made) refuse("finite", "");
    return std::move(made).value();
}

namespace {

constexpr double no_end = 1e300;

/// Returns whether terms and formula agree at these times, to the rounding of both. Every replacement of a formula is
/// tested in this way before a run.
bool agree(model::Formula& formula, const model::Excitation& terms, const std::vector<double>& times) {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon(),
                     allowed = 1e-12;  // relative, for the values
    double greatest = 0, worst = 0;
    for (const double t : times) {
        const double value = formula.value(t, {}, {}), near = rounding * std::fabs(t);
        const double slope = std::fabs(formula.value(t + near, {}, {}) - formula.value(t - near, {}, {}));
        const double apart = std::fabs(terms.value(t) - value) - slope;
        if (!std::isfinite(apart)) return false;
        greatest = std::max(greatest, std::fabs(value));
        worst = std::max(worst, apart);
    }
    return worst <= allowed * greatest;
}

/// Returns five times spread over this span, at which agree() compares.
std::vector<double> times_within(double from, double to) {
    std::vector<double> times;
    for (const double part : {0.02, 0.3, 0.5, 0.77, 0.98}) {
        times.push_back(to < no_end ? from + part * (to - from) : from + std::exp(10 * part));
    }
    return times;
}

/// A periodic, piecewise constant function as native terms of which only one jumps: two would jump at the same time
/// only to rounding.
std::optional<model::Excitation> levels(lua::LuaFunction& function, double from, double to, double period) {
    constexpr int most_pieces = 50;
    constexpr double least = 1e-9;  // fraction of a period by which rounding may shorten the last piece
    const double first = function.next_break(from), end = first + period * (1 - least);
    constexpr double far = 1000;  // number of the last period that is tested without an end
    model::Samples made{.t = {}, .M = {}, .interpolation = model::Interpolation::hold, .period = period};
    std::vector<double> tested;  // the middle of each piece in the first, second and last period
    double next = first;
    while (next < end) {
        const double t = next;
        next = function.next_break(t);
        const double width = std::min(next, first + period) - t;
        const double middle = t + width / 2, last = to < no_end ? std::floor((to - middle) / period) : far;
        for (const double n : {0.0, 1.0, last}) tested.push_back(middle + std::max(n, 0.0) * period);
        const auto terms = function.formula()->terms(t, middle);
        const bool one = terms && terms->components().size() == 1;
        const auto* level = one ? std::get_if<model::Constant>(&terms->components().front().term) : nullptr;
        if (level == nullptr || made.t.size() > most_pieces) return {};
        made.t.push_back(t), made.M.push_back(level->amplitude);
    }
    std::optional<model::Excitation> found;
    if (made.t.size() == 2) {  // a square wave is quicker
        const double half = (made.M[0] - made.M[1]) / 2, duty = (made.t[1] - made.t[0]) / period;
        const auto wave =
            model::Excitation::make(model::Square{.amplitude = half, .period = period, .duty = duty, .at = made.t[0]});
        const auto level = model::Excitation::make(model::Constant{made.M[0] - half});
        if (wave && level) found = *wave + *level;
    } else if (const auto all =
                   model::Excitation::make(model::Polyline(std::make_shared<const model::Samples>(std::move(made))))) {
        found = *all;
    }
    return found && agree(*function.formula(), *found, tested) ? found : std::nullopt;
}

/// The function as native terms in a time span, one for each piece; empty if that fails.
std::optional<model::Excitation> native_of(lua::LuaFunction& function, double from, double to) {
    constexpr int most_pieces = 100;
    if (!(function.next_condition(from) < no_end)) {
        auto terms = function.formula()->terms(from, to < no_end ? from + (to - from) / 2 : from);
        return terms && agree(*function.formula(), *terms, times_within(from, to)) ? terms : std::nullopt;
    }
    if (const double period = function.formula()->period(); period > 0) {
        if (auto waves = levels(function, from, to, period)) return waves;
    }
    if (!(to < no_end)) return {};
    model::Excitation sum;
    double t = from;
    // A run may be continued, so the piece that follows it belongs to the sum.
    for (int n = 0; t < no_end; ++n) {
        const bool beyond = t > to;
        const double next = function.next_condition(t), end = beyond ? next : std::min(next, to);
        if (function.formula() == nullptr || n == most_pieces) return {};
        const auto piece = function.formula()->terms(t, end < no_end ? t + (end - t) / 2 : t);
        const bool known = piece && agree(*function.formula(), *piece, times_within(t, end));
        if (!known && beyond && !sum.components().empty()) break;
        if (!known) return {};
        sum = sum + piece->windowed(t, next);
        if (beyond) break;
        t = next;
    }
    return sum;
}

/// The formula function of the component, if it has no declared breaks; otherwise nullptr.
lua::LuaFunction* read_function(const model::Component& component) {
    const auto* script = std::get_if<model::Scripted>(&component.term);
    auto* function = script == nullptr ? nullptr : dynamic_cast<lua::LuaFunction*>(script->function.get());
    const bool own = function != nullptr && script->breaks.empty() && !(script->period > 0);
    return own && function->obstacle().empty() && function->formula() != nullptr ? function : nullptr;
}

}  // namespace

std::optional<model::Excitation> terms_alone(lua_State* L, const model::Excitation& M, double from, double to) {
    if (!M.has_script()) return {};
    lua::CallState call(L);
    if (to < no_end) call.set_span(to - from);
    model::Excitation sum;
    for (const model::Component& component : M.components()) {
        std::optional<model::Excitation> one;
        if (const auto* script = std::get_if<model::Scripted>(&component.term)) {
            lua::LuaFunction* function = read_function(component);
            if (function == nullptr) return {};
            one = native_of(*function, from - script->delay, to - script->delay);
            if (!one || function->formula() == nullptr || function->formula()->gave_up()) return {};
            one = one->delayed(script->delay);
        } else if (const auto made = model::Excitation::make(component.term)) {
            one = *made;
        }
        if (one) sum = sum + one->scaled(component.gain).windowed(component.from, component.to);
    }
    return sum;
}

std::optional<model::Excitation> terms_alone(lua_State* L, const model::System& system, const model::Drive& drive,
                                             double from, double to) {
    if (!system.is_alone()) return {};
    model::Drive others = drive;
    others.loads = {model::Excitation()};
    if (motion::has_functions(system, others)) return {};
    return terms_alone(L, drive.M(), from, to);
}

model::Excitation with_periods(lua_State* L, const model::Excitation& M) {
    const lua::CallState call(L);
    model::Excitation sum;
    for (const model::Component& component : M.components()) {
        model::Term term = component.term;
        if (const lua::LuaFunction* function = read_function(component)) {
            std::get<model::Scripted>(term).period = function->formula()->period();
        }
        const auto made = model::Excitation::make(std::move(term));
        if (!made) return M;
        sum = sum + made->scaled(component.gain).windowed(component.from, component.to);
    }
    return sum;
}

namespace {

const model::Excitation& self_excitation(lua_State* L, std::string_view call) {
    return lua::self<model::Excitation>(L, 1, call);
}

model::State state_arguments(lua_State* L, int index) {
    model::State state;
    if (!lua_isnoneornil(L, index)) {
        state.theta = lua::finite_argument(L, index, "e:value(t, theta, velocity): theta");
    }
    if (!lua_isnoneornil(L, index + 1)) {
        state.velocity = lua::finite_argument(L, index + 1, "e:value(t, theta, velocity): velocity");
    }
    return state;
}

/// Refuses a controller with a memory, whose values exist in runs only.
void refuse_memory(lua_State* L, const model::Excitation& excitation, const char* call) {
    if (model::has_memory(excitation)) {
        lua::fail(L, call, {"a controller with a memory has values in a run only; see run.M"});
    }
}

int values(lua_State* L);

int value(lua_State* L) {
    const model::Excitation& excitation = self_excitation(L, "e:value(t)");
    if (lua_istable(L, 2) || lua::test<lua::Vector>(L, 2) != nullptr) return values(L);
    const double t = lua::finite_argument(L, 2, "e:value(t): t");
    const model::State state = state_arguments(L, 3);
    if (!excitation.has_script()) {  // no other Lua code runs, so formulas stay valid
        lua_pushnumber(L, excitation.value(t));
        return 1;
    }
    refuse_memory(L, excitation, "e:value(t)");
    lua::CallState call(L);
    const double M = excitation.value(t, state);
    call.check();
    lua_pushnumber(L, M);
    return 1;
}

int values(lua_State* L) {
    const model::Excitation& excitation = self_excitation(L, "e:values(times)");
    refuse_memory(L, excitation, "e:values(times)");
    if (excitation.has_feedback()) {
        lua::fail(L, "e:values(times)", {"this excitation needs theta and velocity; use e:value(t, theta, velocity)"});
    }
    const std::vector<double> times = lua::numbers_at(L, 2, "e:values(times): times");
    std::vector<double> result = lua::new_numbers(L, times.size());
    lua::CallState call(L);
    constexpr std::size_t block = std::size_t{1} << 16U;
    for (std::size_t begin = 0; begin < times.size(); begin += block) {
        const std::size_t count = std::min(block, times.size() - begin);
        const std::size_t filled =
            begin + excitation.fill(std::span(times).subspan(begin, count), std::span(result).subspan(begin, count));
        call.check();
        if (filled < begin + count) {
            lua::fail(L, "e:values(times)", "M = {} at t = {:.14g} is not finite", result[filled], times[filled]);
        }
        if (lua::interrupt_requested()) {
            lua::raise_interrupted(L);
        }
    }
    return lua::push_vector(L, std::move(result));
}

double next_break(lua_State* L, const model::Excitation& excitation, double t) {
    const lua::CallState call(L);
    return excitation.next_break(t);
}

std::optional<std::string> obstacle(lua_State* L, const model::Excitation& excitation) {
    const lua::CallState call(L);
    for (const model::Component& component : excitation.components()) {
        const auto* script = std::get_if<model::Scripted>(&component.term);
        if (script == nullptr) continue;
        auto* function = dynamic_cast<lua::LuaFunction*>(script->function.get());
        if (function == nullptr) return "it has a memory";
        if (std::string why = function->obstacle(); !why.empty()) return why;
    }
    return {};
}

/// Describes how a run evaluates this function and what it can miss between samples.
std::string proof_of(model::UserFunction& function) {
    if (dynamic_cast<const model::SampledController*>(&function) != nullptr) return "called at its instants only";
    const auto* delayed = dynamic_cast<const model::DelayedController*>(&function);
    const auto* relay = dynamic_cast<const model::RelayController*>(&function);
    if (relay != nullptr && relay->function == nullptr) return "native terms";
    auto* own = dynamic_cast<lua::LuaFunction*>(relay != nullptr     ? relay->function.get()
                                                : delayed != nullptr ? delayed->function.get()
                                                                     : &function);
    if (own == nullptr) return "sampled";
    if (const std::string why = own->obstacle(); !why.empty()) return "sampled: " + why;
    if (relay != nullptr && own->formula()->has_conditions_of_motion()) {
        return "sampled: a relay's function has conditions on the motion";
    }
    if (delayed != nullptr && own->formula()->has_conditions_of_motion()) {
        return "sampled: the function of a delayed excitation has conditions on the motion";
    }
    const auto& steps = own->formula()->steps();
    const auto conditions = std::ranges::count_if(steps, [](const model::Formula::Step& step) {
        return model::is_comparison(step.op) || model::is_fold(step.op);
    });
    if (conditions == 0) return "read: bounded on every stretch";
    return fmt::format("read: {} condition{}, bounded on every stretch", conditions, conditions == 1 ? "" : "s");
}

std::string proof(lua_State* L, const model::Excitation& excitation) {
    const lua::CallState call(L);
    std::string all;
    excitation.each_function([&](model::UserFunction& function) {
        const std::string one = proof_of(function);
        if (all.find(one) == std::string::npos) all += (all.empty() ? "" : "; ") + one;
    });
    return all.empty() ? "native terms" : all;
}

text::Expected<model::Excitation> delay(const model::Excitation& excitation, double d) {
    if (!model::has_memory(excitation)) return excitation.delayed(d);
    return text::Error{
        "an excitation with memory cannot be delayed as a whole; excitation.sampled has an option delay, and "
        "excitation.delayed uses the past motion"};
}

double window_edge(lua_State* L, int index, std::string_view name) {
    const double edge = lua_tonumber(L, index);
    if (lua_type(L, index) != LUA_TNUMBER || std::isnan(edge)) {
        lua::raise_got(L, index, "e:window(from, to)", fmt::format("e:window(from, to): {} must be a number", name));
    }
    return edge;
}

int window(lua_State* L) {
    const model::Excitation& excitation = self_excitation(L, "e:window(0, 10)");
    const double from = window_edge(L, 2, "from");
    const double to = window_edge(L, 3, "to");
    if (!(from < to)) {
        lua::fail(L, "e:window(from, to)", "to = {} must be after from = {}", to, from);
    }
    lua::push(L, excitation.windowed(from, to));
    return 1;
}

// ---- operators

model::Excitation operand(lua_State* L, int index) {
    return to_excitation(L, index, "what is added to an excitation");
}

int add(lua_State* L) {
    lua::push(L, operand(L, 1) + operand(L, 2));
    return 1;
}

int subtract(lua_State* L) {
    lua::push(L, operand(L, 1) + operand(L, 2).scaled(-1));
    return 1;
}

/// Pushes the excitation at `index` times `gain`.
int push_scaled(lua_State* L, int index, double gain) {
    if (!std::isfinite(gain)) {
        lua::raise(L, "an excitation cannot be scaled by {}", gain);
    }
    lua::push(L, lua::test<model::Excitation>(L, index)->scaled(gain));
    return 1;
}

int multiply(lua_State* L) {
    const int number = lua::test<model::Excitation>(L, 1) != nullptr ? 2 : 1;
    if (lua_type(L, number) != LUA_TNUMBER) {
        lua::raise_got(L, number, "", "an excitation can be multiplied by a number only",
                       "; a product of two is a function: function(t) return a(t) * b(t) end");
    }
    return push_scaled(L, 3 - number, lua_tonumber(L, number));
}

int divide(lua_State* L) {
    if (lua::test<model::Excitation>(L, 1) == nullptr || lua_type(L, 2) != LUA_TNUMBER) {
        lua::raise(L, {.sentence = fmt::format("an excitation can be divided by a number only, got {} / {}",
                                               lua::describe(L, 1), lua::describe(L, 2)),
                       .culprit = lua::written(L, 2)});
    }
    const double divisor = lua_tonumber(L, 2);
    if (divisor == 0) {
        lua::raise(L, "an excitation cannot be divided by zero");
    }
    return push_scaled(L, 1, 1 / divisor);
}

int negate(lua_State* L) {
    return push_scaled(L, 1, -1);
}

constexpr lua::Member excitation_members[] = {
    {lua::a_method<value>,
     {"e:value(t, theta = 0, velocity = 0) -> number",
      "The torque M at the time t. e(t) is the same. At a jump it is the new value.",
      "print(excitation.ramp{ slope = 3 }:value(2))  --> 6.0"}},
    {lua::a_method<values>,
     {"e:values(times) -> vector", "The torques at all these times (a table or a vector), without feedback.",
      "print(excitation.ramp{ slope = 3 }:values{ 0, 1, 2 })  --> vector{ 0, 3, 6 }"}},
    {lua::a_typed_method<next_break>,
     {"e:next_break(t) -> number", "The first known jump or kink of M after t; math.huge if there is none.",
      "print(excitation.pulse{ at = 1, width = 2 }:next_break(1))  --> 3.0"}},
    {lua::a_typed_method<obstacle>,
     {"e:obstacle() -> string or nil",
      "Why a function in it cannot be read as a formula: the line and the reason. nil if every function is read; "
      "it is then evaluated without Lua, and its conditions on t are breaks.",
      "print(excitation.scripted(function(t) return t % 2 < 1 and 1 or 0 end):obstacle())  --> nil"}},
    {lua::a_typed_method<proof>,
     {"e:proof() -> string",
      "What a run with integrator.spectral{} knows of it between its samples: \"native terms\"; \"read: 2 conditions, "
      "bounded on every stretch\" for a function that is read; \"sampled: \" and the reason for any other. "
      "What is sampled, and a stretch without a bound, is reported by run.gap.",
      "print(excitation.scripted(function(t) return t % 2 < 1 and 1 or 0 end):proof())\n"
      "--> read: 2 conditions, bounded on every stretch"}},
    {lua::a_typed_method<delay>,
     {"e:delay(d) -> excitation", "The same, later by d: M(t - d).", "print(excitation.ramp{}:delay(2)(5))  --> 3.0"}},
    {lua::a_method<window>,
     {"e:window(from, to) -> excitation", "The excitation for from <= t < to, and 0 outside. The ends may be infinite.",
      "M = excitation.ramp{}:window(1, 3)\nprint(M(0.5), M(2), M(3))  --> 0.0\t2.0\t0.0"}},
    {lua::a_metamethod<value>("__call"),
     {"e(t, theta = 0, velocity = 0) -> number or vector",
      "The torque M at the time t, or at all times of a table or a vector.",
      "e = excitation.ramp{ slope = 3 }\nprint(e(2), e{ 0, 1, 2 })  --> 6.0\tvector{ 0, 3, 6 }"}},
    {lua::a_metamethod<add>("__add"),
     {"e + f -> excitation", "The sum. One side may be a function or a number.",
      "M = excitation.step{} + 2 + function(t) return 10 * t end\nprint(M(1))  --> 13.0"}},
    {lua::a_metamethod<subtract>("__sub"),
     {"e - f -> excitation", "The difference. One side may be a function or a number.",
      "print((5 - excitation.step{})(1))  --> 4.0"}},
    {lua::a_metamethod<multiply>("__mul"),
     {"number * e -> excitation", "The excitation scaled by a number.", "print((3 * excitation.step{})(1))  --> 3.0"}},
    {lua::a_metamethod<divide>("__div"),
     {"e / number -> excitation", "The excitation divided by a number.",
      "print((excitation.step{} / 4)(1))  --> 0.25"}},
    {lua::a_metamethod<negate>("__unm"),
     {"-e -> excitation", "The excitation with the other sign.", "print((-excitation.step{})(1))  --> -1.0"}},
    {lua::a_text<model::Excitation, [](lua_State* L, const model::Excitation& e) { return source::lua_text(L, e); }>,
     {"tostring(e) -> string",
      "Lua text that recreates it, if possible: functions by their source text, without the values of upvalues; "
      "long tables are left out.",
      "print(0.5 * excitation.step{ at = 2 })  --> 0.5 * excitation.step{ amplitude = 1, at = 2 }"}},
};

}  // namespace

const lua::Class excitation_class{
    "excitation",
    {"e = excitation.NAME{ ... }",
     "A torque M(t), or M(t, theta, velocity) with feedback. It cannot be changed; arithmetic makes new ones.",
     "e = 2 * excitation.step{ at = 1 }\nprint(e(0), e(1))  --> 0.0\t2.0"},
    excitation_members,
    lua::add_class<model::Excitation>,
    nullptr,
    excitation_card,
};

// The options of excitation.sampled, relay and delayed.

inline constexpr text::Option sampled_options[] = {
    text::option<&model::SampledController::every>(
        "every", "sampling interval", {.unit = "time units", .otherwise = text::needed, .range = text::positive}),
    text::option<&model::SampledController::delay>("delay", "time from sampling to output",
                                                   {.unit = "time units", .range = text::not_negative}),
    text::option<&model::SampledController::at>(
        "at", "the first sampling time; those before the start of a run are left out", {.unit = "time units"}),
    {.name = "start",
     .meaning =
         "a function that returns the memory of a run, a table, which f gets as its fifth argument and may change",
     .wanted = "a function that returns a table, such as function() return { e = 0 } end"},
};
inline constexpr text::Call sampled_call{
    "excitation.sampled",
    "excitation.sampled(function(t, theta, velocity) return -theta end, { every = 0.01 })",
    sampled_options,
    false,
    nullptr,
    "every"};

inline constexpr text::Option delayed_options[] = {
    text::option<&model::DelayedController::by>(
        "by", "age of theta and velocity", {.unit = "time units", .otherwise = text::needed, .range = text::positive}),
};
inline constexpr text::Call delayed_call{
    "excitation.delayed",
    "excitation.delayed(function(t, theta, velocity) return -theta end, { by = 0.02 })",
    delayed_options,
    false,
    nullptr,
    "by"};

struct RelayOptions {
    enum class Start { on, off };
    double on = 0, off = 0;
    Start start = Start::on;
};
inline constexpr const char* relay_starts[] = {"on", "off"};
inline constexpr text::Option relay_options[] = {
    text::option<&RelayOptions::on>("on", "threshold at which it switches on", {.otherwise = text::needed}),
    text::option<&RelayOptions::off>("off", "threshold at which it switches off", {.otherwise = text::needed}),
    {.name = "amplitude",
     .unit = "torque",
     .otherwise = text::needed,
     .meaning = "the torque while on, its opposite while off; or both torques { on, off }",
     .wanted = "a number, or two: { on, off }"},
    {.name = "of",
     .otherwise = "\"theta\"",
     .meaning =
         "the observed quantity: \"theta\", \"velocity\", the name of a state, or a function of t, theta, velocity, z",
     .wanted = "\"theta\", \"velocity\", the name of a state or a function"},
    text::option<&RelayOptions::start>("start", "initial state, if the start is between the thresholds",
                                       {.choices = relay_starts}),
};
inline constexpr text::Call relay_call{"excitation.relay", "excitation.relay{ on = 0.25, off = 0.35, amplitude = 0.2 }",
                                       relay_options};

int sampled_controller(lua_State* L);
int relay_controller(lua_State* L);
int delayed_controller(lua_State* L);

inline constexpr lua::Member controller_functions[] = {
    {lua::a_function<sampled_controller>,
     {"excitation.sampled(f, { OPTIONS }) -> excitation",
      "A sampled controller: f(t, theta, velocity, z, memory) is called once at each sampling time, in order. Its "
      "result is held until the next; before the first one M is 0. Each run gets a new memory, the table that "
      "start returns, so runs can be repeated, continued and swept. z is nil without states. It has values only in "
      "a run.",
      "M = excitation.sampled(function(t, theta, velocity, z, memory)\n"
      "  memory.e = memory.e + 0.1*(1 - theta)\n"
      "  return 5*memory.e - 3*velocity\n"
      "end, { every = 0.1, start = function() return { e = 0 } end })\n"
      "run = nondimensional{}:simulate{ M = M, t_end = 1, dt = 0.25 }\n"
      "print(run.M[1], run.M[2] == run.M[3])  --> 0.5\tfalse",
      {&sampled_call}}},
    {lua::a_function<relay_controller>,
     {"excitation.relay{ OPTIONS } -> excitation",
      "A switch with hysteresis: M is amplitude after the quantity has passed `on`, and -amplitude after it has "
      "passed `off`. Each switch is located, and is an event of kind \"switch\". It has values only in a run.",
      "M = excitation.relay{ on = -0.1, off = 0.1, amplitude = 1 }\n"
      "run = nondimensional{ zeta = 0.1 }:simulate{ M = M, t_end = 1, dt = 0.5 }\n"
      "print(run.events[1].kind, string.format(\"%.6f\", run.events[1].theta))  --> switch\t0.100000",
      {&relay_call}}},
    {lua::a_function<delayed_controller>,
     {"excitation.delayed(f, { OPTIONS }) -> excitation",
      "A controller with a dead time: f(t, theta, velocity) gets the present t, and theta and velocity of the time "
      "t - by; before the start of the run these are the initial ones. It has values only in a run.",
      "M = excitation.delayed(function(t, theta, velocity) return -0.1*velocity end, { by = 0.02 })\n"
      "run = nondimensional{}:simulate{ M = M, velocity0 = 1, t_end = 1, dt = 0.01 }\n"
      "print(run.M[1], run.M[2])  --> -0.1\t-0.1",
      {&delayed_call}}},
};

int push_term(lua_State* L, model::Term term) {
    auto made = model::Excitation::make(std::move(term));
    if (!made) {
        lua::raise(L, made.error());  // the message begins with the call
    }
    lua::push(L, std::move(made).value());
    return 1;
}

namespace {

// ---- excitation.samples("record.csv", { time = "t", value = "M" })

constexpr text::Option column_names[] = {
    {.name = "time", .meaning = "the column of times, by its name or number"},
    {.name = "value", .meaning = "the column of torques, likewise"},
};
constexpr auto columns_of_file = text::joined(column_names, model::terms::between_options);
constexpr text::Call file_call{
    "excitation.samples", "excitation.samples(\"record.csv\", { time = \"t\", value = \"M\" })", columns_of_file, true};

/// The column named or numbered by an option, otherwise the first with a usual name, otherwise `otherwise`.
Eigen::Index samples_column(lua_State* L, const lua::Options& options, const std::string& file,
                            const files::Table& table, std::string_view option,
                            std::initializer_list<std::string_view> usual, Eigen::Index otherwise) {
    if (options.has(option)) {
        options.push(option);
        const auto found = column_at(L, -1, table.names, option);
        if (!found) {
            options.fail(text::in_call(file, found.error()));
        }
        lua_pop(L, 1);
        return *found;
    }
    for (const std::string_view name : usual) {
        if (const auto found = std::ranges::find(table.names, name); found != table.names.end()) {
            return found - table.names.begin();
        }
    }
    return otherwise;
}

/// Checks the times; errors count rows of the file rather than table indices.
void check_times(const lua::Options& options, const std::string& file, const files::Table& table, Eigen::Index column) {
    const auto t = table.values.col(column);
    for (Eigen::Index i = 1; i < t.size(); ++i) {
        if (!(t[i] > t[i - 1])) {
            options.fail(
                text::error("{}: row {} of the numbers has {} = {}, which is not after {} in the row "
                            "before; times must increase",
                            file, i + 1, table.names[static_cast<std::size_t>(column)], t[i], t[i - 1]));
        }
    }
}

int samples_from_file(lua_State* L) {
    const std::string file = lua_tostring(L, 1);
    const lua::Options options(L, 2, file_call);
    auto read = files::read_columns(file);
    if (lua::interrupt_requested()) {
        lua::raise_interrupted(L);  // the file was read only in part
    }
    const files::Table table = options.value_or_fail(files::table_of(options.value_or_fail(std::move(read))));
    if (table.values.rows() == 0) {
        options.fail(text::error("{} has names but no rows of numbers", file));
    }
    if (table.values.cols() < 2) {
        options.fail(text::error("{} has only one column; times and values are two", file));
    }
    const Eigen::Index time = samples_column(L, options, file, table, "time", {"t", "time"}, 0);
    const Eigen::Index value = samples_column(L, options, file, table, "value", {"M"}, time == 1 ? 0 : 1);
    check_times(options, file, table, time);
    const auto numbers = [&](Eigen::Index column) {
        const auto values = table.values.col(column);
        return std::vector<double>(values.data(), values.data() + values.size());
    };
    // Columns are referenced by name, so that the text stays valid if the file gets another column. Files without names
    // accept these names for their column numbers.
    const auto name = [&](Eigen::Index column) { return text::quoted(table.names[static_cast<std::size_t>(column)]); };
    model::Samples points;
    options.fill(points);
    points.t = numbers(time);
    points.M = numbers(value);
    const char* const between = model::terms::interpolation_names[static_cast<std::size_t>(points.interpolation)];
    const bool linear = points.interpolation == model::Interpolation::linear;
    points.origin = fmt::format("{}, {{ time = {}, value = {}{}{} }}", text::quoted(file), name(time), name(value),
                                linear ? "" : fmt::format(", interpolation = \"{}\"", between),
                                points.period ? ", period = " + text::number_literal(*points.period) : std::string());
    return push_term(L, std::make_shared<const model::Samples>(std::move(points)));
}

int samples(lua_State* L) {
    if (lua_type(L, 1) == LUA_TSTRING) {
        return samples_from_file(L);
    }
    if (lua_type(L, 1) != LUA_TTABLE) {
        lua::raise_got(L, 1, file_call.name, "excitation.samples takes the name of a file or a table of points",
                       lua::test<DataHandle>(L, 1) != nullptr
                           ? "; of data d give two columns: excitation.samples{ t = d.t, M = d.M }"
                           : fmt::format("; for example {}", file_call.example));
    }
    return push_term(
        L, std::make_shared<const model::Samples>(lua::read<model::Samples>(L, 1, model::Polyline::about.call)));
}

// ---- excitation.scripted(f, { breaks = { 0.5, 2 }, period = 3 })

int scripted(lua_State* L) {
    constexpr const text::Call& call = model::Scripted::about.call;
    if (!lua::is_callable(L, 1) || lua::test<model::Excitation>(L, 1) != nullptr) {
        lua::raise_got(L, 1, call.name, "excitation.scripted needs a function",
                       fmt::format("; for example {}", call.example));
    }
    auto term = lua::read<model::Scripted>(L, 2, call);
    const auto function = std::make_shared<lua::LuaFunction>(L, 1);
    term.function = function;
    term.feedback = function->feedback();
    return push_term(L, std::move(term));
}

// ---- the functions

/// A term's constructor in Lua: from one table of options, except for samples and scripted.
template <class T>
struct Maker {
    static constexpr text::FixedText<96> signature{T::about.call.name, "{ OPTIONS } -> excitation"};
    static constexpr std::array<const text::Call*, 2> calls{&T::about.call};
    static int make(lua_State* L) { return push_term(L, lua::read<T>(L, 1, T::about.call)); }
};
template <>
struct Maker<model::Polyline> {
    static constexpr text::FixedText<96> signature{
        "excitation.samples(file, { OPTIONS }) or excitation.samples{ OPTIONS } -> excitation"};
    static constexpr std::array<const text::Call*, 2> calls{&file_call, &model::Polyline::about.call};
    static int make(lua_State* L) { return samples(L); }
};
template <>
struct Maker<model::Scripted> {
    static constexpr text::FixedText<96> signature{"excitation.scripted(f, { OPTIONS }) -> excitation"};
    static constexpr std::array<const text::Call*, 2> calls{&model::Scripted::about.call};
    static int make(lua_State* L) { return scripted(L); }
};

template <class... T>
constexpr std::array<lua::Member, sizeof...(T)> functions_of(model::TermList<T...> /*all*/) {
    return {lua::Member{lua::a_function<Maker<T>::make>,
                        {Maker<T>::signature.c_str(), T::about.summary, T::about.example, Maker<T>::calls}}...};
}

template <std::size_t n, std::size_t m>
constexpr std::array<lua::Member, n + m> joined_members(const std::array<lua::Member, n>& a,
                                                        const lua::Member (&b)[m]) {
    return [&]<std::size_t... i, std::size_t... j>(std::index_sequence<i...>, std::index_sequence<j...>) {
        return std::array<lua::Member, n + m>{a[i]..., b[j]...};
    }
    (std::make_index_sequence<n>(), std::make_index_sequence<m>());
}

constexpr auto excitation_module_members = joined_members(functions_of(model::Terms()), controller_functions);

}  // namespace

const lua::Class excitation_module{
    "excitation",
    {"excitation.NAME{ ... } -> excitation",
     "The torque M(t) on the mass, made of terms that add and scale. Each term knows the times "
     "at which it jumps or kinks. A Lua function or a number is accepted wherever an excitation "
     "is expected.",
     "M = excitation.harmonic{ frequency = 1 } + 0.5 * excitation.pulse{ at = 1.5, width = 0.2 }\n"
     "print(M:next_break(0))  --> 1.5"},
    excitation_module_members,
    lua::add_module,
};

// excitation.sampled, excitation.relay, excitation.delayed: terms of M with a memory.

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
        options.wrong("start");
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
        options.fail("off", "on = {:.6g} and off = {:.6g} must differ: between them it stays as it is", asked.on,
                     asked.off);
    }
    options.push("amplitude");
    const bool one = lua_type(L, -1) == LUA_TNUMBER;
    lua_pop(L, 1);
    const double alone = one ? options.number("amplitude") : 0;
    const std::vector<double> torques = one ? std::vector{alone, -alone} : options.numbers("amplitude");
    if (!options.has("amplitude")) options.missing("amplitude");
    if (torques.size() != 2) {
        options.fail("amplitude", "amplitude must be {}, got {} number{}", options.row("amplitude").wanted,
                     torques.size(), torques.size() == 1 ? "" : "s");
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
        options.wrong("of");
    }
    lua_pop(L, 1);
    return push_controller(L, std::move(controller));
}

}  // namespace dinal::api
