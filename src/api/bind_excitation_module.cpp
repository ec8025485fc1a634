// The module `excitation`: a function for each term of the model, with options and documentation from the term. Two
// terms have special arguments: samples also takes a file, scripted a function.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "api/bind_excitation.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/lua_run.hpp"
#include "files/csv.hpp"
#include "lua/bind.hpp"
#include "lua/interrupt.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "model/controller.hpp"
#include "text/characters.hpp"
#include "text/option.hpp"
#include "text/words.hpp"

namespace dinal::api {

// The options of excitation.sampled, relay and delayed.

inline constexpr text::Option sampled_options[] = {
    {.name = "every",
     .unit = "time units",
     .otherwise = text::needed,
     .range = text::positive,
     .meaning = "sampling interval",
     .filled = text::fills<&model::SampledController::every>},
    {.name = "delay",
     .unit = "time units",
     .range = text::not_negative,
     .meaning = "time from sampling to output",
     .filled = text::fills<&model::SampledController::delay>},
    {.name = "at",
     .unit = "time units",
     .meaning = "the first sampling time; those before the start of a run are left out",
     .filled = text::fills<&model::SampledController::at>},
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
    {.name = "by",
     .unit = "time units",
     .otherwise = text::needed,
     .range = text::positive,
     .meaning = "age of theta and velocity",
     .filled = text::fills<&model::DelayedController::by>},
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
    {.name = "on",
     .otherwise = text::needed,
     .meaning = "threshold at which it switches on",
     .filled = text::fills<&RelayOptions::on>},
    {.name = "off",
     .otherwise = text::needed,
     .meaning = "threshold at which it switches off",
     .filled = text::fills<&RelayOptions::off>},
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
    {.name = "start",
     .meaning = "initial state, if the start is between the thresholds",
     .filled = text::fills<&RelayOptions::start>,
     .choices = relay_starts},
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
                {fmt::format("{}: row {} of the numbers has {} = {}, which is not after {} in the row "
                             "before; times must increase",
                             file, i + 1, table.names[static_cast<std::size_t>(column)], t[i], t[i - 1])});
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
        options.fail({fmt::format("{} has names but no rows of numbers", file)});
    }
    if (table.values.cols() < 2) {
        options.fail({fmt::format("{} has only one column; times and values are two", file)});
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
        options.fail("off", fmt::format("on = {:.6g} and off = {:.6g} must differ: between them it stays as it is",
                                        asked.on, asked.off));
    }
    options.push("amplitude");
    const bool one = lua_type(L, -1) == LUA_TNUMBER;
    lua_pop(L, 1);
    const double alone = one ? options.number("amplitude") : 0;
    const std::vector<double> torques = one ? std::vector{alone, -alone} : options.numbers("amplitude");
    if (!options.has("amplitude")) options.missing("amplitude");
    if (torques.size() != 2) {
        options.fail("amplitude", fmt::format("amplitude must be {}, got {} number{}", options.row("amplitude").wanted,
                                              torques.size(), torques.size() == 1 ? "" : "s"));
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
