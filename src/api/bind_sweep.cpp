// sweep{ ... }: a function of a point asked at all points of a grid, by several threads.
#include <fmt/format.h>
#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>

#include "api/classes.hpp"
#include "api/run.hpp"
#include "api/sweep_options.hpp"
#include "api/sweep_parameters.hpp"
#include "api/sweep_run.hpp"
#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "lua/vector.hpp"
#include "model/assembly.hpp"
#include "model/oscillator.hpp"
#include "text/option.hpp"

namespace dinal::api {
namespace {

// ---- bifurcation{ ... }: what a motion does once a period, over a parameter; on top of the workers of a sweep.

struct BifurcationOptions {
    double skip = 200;
    double keep = 100;
    std::optional<double> period = {}, frequency = {}, omega = {};
};

constexpr text::Option bifurcation_only_options[] = {
    {.name = "at",
     .otherwise = text::needed,
     .meaning =
         "a function of a point, a table such as { a = 0.5 }, that returns options of sys:simulate, with system = "
         "... and, if need be, another period; for several bodies also of = \"load\", the body to record",
     .wanted = "a function of a point that returns { system = ..., M = ... }"},
    {.name = "period",
     .unit = "time units",
     .range = text::positive,
     .meaning = "time between samples; needed unless `at` returns { period = ... }; or frequency, or omega, instead",
     .filled = text::fills<&BifurcationOptions::period>},
    {.name = "frequency",
     .unit = "cycles per time unit",
     .range = text::positive,
     .meaning = "1/period",
     .filled = text::fills<&BifurcationOptions::frequency>},
    {.name = "omega",
     .unit = "rad per time unit",
     .range = text::positive,
     .meaning = "2 pi/period",
     .filled = text::fills<&BifurcationOptions::omega>},
    {.name = "skip",
     .range = {"be a whole number from 0 to 1e6", [](double x) { return text::is_whole(x, 0, 1e6); }},
     .meaning = "periods to skip while the motion settles",
     .filled = text::fills<&BifurcationOptions::skip>},
    {.name = "keep",
     .range = {"be a whole number from 1 to 10000", [](double x) { return text::is_whole(x, 1, 1e4); }},
     .meaning = "periods to record after that, one row each",
     .filled = text::fills<&BifurcationOptions::keep>},
};

constexpr text::Option options_of_workers[] = {run_options[1], run_options[3], run_options[4]};

constexpr auto bifurcation_options = text::joined(over_option, bifurcation_only_options, options_of_workers);

constexpr text::Call bifurcation_call{
    "bifurcation",
    "bifurcation{ over = { a = vector.linspace(0.2, 1.2, 400) }, period = 1.25, at = function(p) return { system "
    "= sys, M "
    "= M } end }",
    bifurcation_options};

constexpr lua::Doc bifurcation_doc{
    "bifurcation{ OPTIONS } -> data",
    "Runs a system for each value of a parameter, on all cores, and records theta and velocity once a period: a "
    "motion of one period gives one point, one of two periods two, chaos many. Columns: the parameters, theta, "
    "velocity and error. The rules for the function and for file are those of sweep.",
    "sys = nondimensional{ zeta = 0.1 }\n"
    "b = bifurcation{ over = { a = { 0.5, 1 } }, period = 1, skip = 50, keep = 2, at = function(p)\n"
    "    return { system = sys, M = excitation.harmonic{ amplitude = p.a, frequency = 1 } }\n"
    "end }\n"
    "print(b:select(\"a\", \"theta\"))\n"
    "--> data: 4 rows of a, theta\n"
    "-->   i    a  theta\n"
    "-->   1  0.5   -2.5\n"
    "-->   2  0.5   -2.5\n"
    "-->   3    1     -5\n"
    "-->   4    1     -5",
    {&bifurcation_call}};

/// The results of a point have names: "theta 1", "velocity 1", ...
std::string look_name(const char* column, std::size_t look) {
    return fmt::format("{} {}", column, look + 1);
}

double period_of(double period, double frequency, double omega) {
    return period > 0 ? period : frequency > 0 ? 1 / frequency : omega > 0 ? 2 * std::numbers::pi / omega : 0;
}

/// The period among the options at the index, as period, frequency or omega, which are taken out.
double period_of_point(lua_State* L, int more, double otherwise) {
    double found = 0;
    for (const char* name : {"period", "frequency", "omega"}) {
        lua_getfield(L, more, name);
        if (!lua_isnil(L, -1)) {
            const double x = lua_tonumber(L, -1);
            if (!(lua_type(L, -1) == LUA_TNUMBER && x > 0 && x < 1e300)) {
                lua::raise(
                    L, fmt::format("at returned {} = {}, which must be a positive number", name, lua::describe(L, -1)));
            }
            const std::string_view which = name;
            found = period_of(which == "period" ? x : 0, which == "frequency" ? x : 0, which == "omega" ? x : 0);
        }
        lua_pop(L, 1);
        lua_pushnil(L);
        lua_setfield(L, more, name);
    }
    if (found > 0) return found;
    if (!(otherwise > 0)) lua::raise(L, "bifurcation needs period, a number, or at must return { period = ... }");
    return otherwise;
}

/// What the bifurcation itself says to sys:simulate.
void refuse_own_options(lua_State* L, int more) {
    for (const char* name : {"t_end", "dt", "times", "dense"}) {
        const bool given = lua_istable(L, more) && lua_getfield(L, more, name) != LUA_TNIL;
        if (given) {
            lua::raise(L,
                       fmt::format(
                           "at returned {}, which bifurcation sets itself: choose the samples by period, skip and keep",
                           name));
        }
        if (lua_istable(L, more)) lua_pop(L, 1);
    }
}

/// sys:simulate{ M = M, times = ..., dense = false, and what else the table at 4 says }; pushes the run.
void run_point(lua_State* L, double period, std::size_t skip, std::size_t keep) {
    lua_newtable(L);
    const int options = lua_gettop(L);
    if (lua_istable(L, 4)) {
        lua_pushnil(L);
        while (lua_next(L, 4) != 0) {
            lua_pushvalue(L, -2);
            lua_insert(L, -2);
            lua_rawset(L, options);
        }
    }
    lua_pushnil(L);
    lua_setfield(L, options, "period");
    lua_getfield(L, options, "t_start");
    const double start = lua_tonumber(L, -1);
    lua_pop(L, 1);
    std::vector<double> times(keep);
    for (std::size_t i = 0; i < keep; ++i) times[i] = start + period * static_cast<double>(skip + i + 1);
    lua::push_vector(L, std::move(times));
    lua_setfield(L, options, "times");
    lua_pushboolean(L, 0);
    lua_setfield(L, options, "dense");
    lua_pushvalue(L, 3);
    lua_setfield(L, options, "M");
    lua_getfield(L, 2, "simulate");
    lua_pushvalue(L, 2);
    lua_pushvalue(L, options);
    lua_call(L, 2, 1);
}

/// The body of several that is looked at: of = "load" among what `at` returned, at 1; "" of one body.
std::string body_of_point(lua_State* L, bool rig) {
    lua_getfield(L, 1, "of");
    const bool given = lua_type(L, -1) == LUA_TSTRING;
    std::string of = given ? lua_tostring(L, -1) : "";
    lua_pop(L, 1);
    const auto* system = rig ? lua::test<model::AssemblyHandle>(L, 2) : nullptr;
    const bool several = system != nullptr && (*system)->named;
    if (several && !given) lua::raise(L, "at must return the body to record, such as of = \"load\"");
    return several ? of : "";
}

/// The function that the workers ask, with a point; upvalues: the user's function, period, skip, keep.
int looks_of_point(lua_State* L) {
    lua_settop(L, 1);
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, 1, 1);
    if (!lua_istable(L, 1)) {
        lua::raise(
            L, fmt::format("at must return a table such as {{ system = sys, M = M }}, got {}", lua::describe(L, 1)));
    }
    lua_getfield(L, 1, "system");
    lua_getfield(L, 1, "M");
    const bool rig = lua::test<model::AssemblyHandle>(L, 2) != nullptr;
    if (!rig && lua::test<model::Oscillator>(L, 2) == nullptr) {
        lua::raise(L, fmt::format("at must return a table with system = ..., got {} there", lua::describe(L, 2)));
    }
    lua_newtable(L);  // 4: the other options
    for (lua_pushnil(L); lua_next(L, 1) != 0;) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, 4);
    }
    const std::string of = body_of_point(L, rig);
    for (const char* taken : {"system", "M", "of"}) {
        lua_pushnil(L);
        lua_setfield(L, 4, taken);
    }
    const double period = period_of_point(L, 4, lua_tonumber(L, lua_upvalueindex(2)));
    const auto skip = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(3)));
    const auto keep = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(4)));
    refuse_own_options(L, 4);
    run_point(L, period, skip, keep);
    if (!of.empty()) {
        lua_getfield(L, -1, of.c_str());
        lua_replace(L, -2);
    }
    const int run = lua_gettop(L);
    if (const auto* own = lua::test<RunHandle>(L, run); own != nullptr && !is_whole((*own)->trajectory.outcome)) {
        lua::raise(L,
                   fmt::format("the run ended before the last sample: {}", motion::outcome_text((*own)->trajectory)));
    }
    lua_createtable(L, 0, static_cast<int>(2 * keep));
    const int looks = run + 1;
    for (const char* column : {"theta", "velocity"}) {
        lua_getfield(L, run, column);
        const lua::Vector values = *lua::test<lua::Vector>(L, -1);
        for (std::size_t i = 0; i < std::min(keep, values.size()); ++i) {
            lua::push_text(L, look_name(column, i));
            lua_pushnumber(L, values.begin()[i]);
            lua_rawset(L, looks);
        }
        lua_pop(L, 1);
    }
    return 1;
}

/// A row for each look at each point that is done; one for a point that failed.
Data looks_as_rows(const SweepGrid& grid, const SweepResults& results, std::size_t keep) {
    std::vector<std::size_t> points;
    std::vector<double> theta, velocity;
    std::vector<std::string> errors;
    std::vector<const double*> thetas, velocities;
    for (std::size_t look = 0; look < keep; ++look) {
        thetas.push_back(results.find(look_name("theta", look)));
        velocities.push_back(results.find(look_name("velocity", look)));
    }
    const auto value = [](const double* column, std::size_t point) {
        return column == nullptr ? std::numeric_limits<double>::quiet_NaN() : column[point];
    };
    for (const std::size_t point : results.done_points()) {
        const auto failed = results.failures().find(point);
        const bool good = failed == results.failures().end();
        for (std::size_t look = 0; look < (good ? keep : 1); ++look) {
            points.push_back(point);
            theta.push_back(value(good ? thetas[look] : nullptr, point));
            velocity.push_back(value(good ? velocities[look] : nullptr, point));
            errors.push_back(good ? "" : failed->second);
        }
    }
    Data data{.columns = grid.columns(points)};
    data.columns.push_back(column_of("theta", std::move(theta)));
    data.columns.push_back(column_of("velocity", std::move(velocity)));
    data.columns.push_back(column_of("error", std::move(errors)));
    data.heading = heading_of_map(grid, results);
    data.points_of = "theta";
    return data;
}

/// The same out of the columns of a file.
bool take_looks(const SweepGrid& grid, const std::vector<files::ReadColumn>& columns, SweepResults& results,
                std::size_t keep) {
    const std::size_t first = grid.parameters().size();
    if (columns.size() != first + 3 || columns.back().name != "error" || columns[first].of_words) return false;
    const std::vector<double>&theta = columns[first].numbers, &velocity = columns[first + 1].numbers;
    const files::ReadColumn& errors = columns.back();
    std::size_t row = 0;
    for (std::size_t point = 0; point < results.size(); ++point) {
        if (row >= theta.size()) return false;
        if (errors.of_words && !errors.words[row].empty()) {
            results.fail(point, errors.words[row++]);
            continue;
        }
        if (theta.size() - row < keep || columns[first + 1].of_words) return false;
        for (std::size_t look = 0; look < keep; ++look, ++row) {
            results.column(look_name("theta", look))[point] = theta[row];
            results.column(look_name("velocity", look))[point] = velocity[row];
        }
        results.finish(point);
    }
    return row == theta.size();
}

int bifurcation(lua_State* L) {
    if (lua_istable(L, 1)) {
        const bool old = lua_getfield(L, 1, "run") != LUA_TNIL;
        lua_pop(L, 1);
        if (old) lua::raise(L, "bifurcation: instead of run give at = function(p) return { system = sys, M = M } end");
    }
    std::vector<DataColumn> parameters = take_parameters(L, bifurcation_call);
    const lua::Options options(L, 1, bifurcation_call);
    BifurcationOptions asked;
    SweepOptions of_workers;
    options.fill(asked);
    options.fill(of_workers);
    const int function = push_function(L, options, "at");
    check_parameters(L, bifurcation_call, parameters);
    for (const DataColumn& parameter : parameters) {
        if (parameter.name == "theta" || parameter.name == "velocity") {
            options.fail({.sentence = fmt::format("'{}' is a column of the result: give the parameter another name",
                                                  parameter.name),
                          .option = parameter.name});
        }
    }
    check_file_of_sweep(options, of_workers);
    const SweepGrid grid(std::move(parameters));
    const double period = period_of(asked.period.value_or(0), asked.frequency.value_or(0), asked.omega.value_or(0));
    const auto adapt = [&](lua_State* worker) {
        lua_pushnumber(worker, period);
        lua_pushinteger(worker, static_cast<lua_Integer>(asked.skip));
        lua_pushinteger(worker, static_cast<lua_Integer>(asked.keep));
        lua_pushcclosure(worker, lua::guarded<looks_of_point>, 4);
    };
    const auto told = [&](const SweepGrid& of, const SweepResults& results) {
        return looks_as_rows(of, results, static_cast<std::size_t>(asked.keep));
    };
    const auto results = swept(L, {.call = bifurcation_call.name,
                                   .grid = grid,
                                   .function = function,
                                   .workers = of_workers.workers,
                                   .file = of_workers.file,
                                   .max_time = of_workers.max_time.value_or(0),
                                   .settings = {period, asked.skip, asked.keep},
                                   .adapt = adapt,
                                   .told = told,
                                   .taken = [&](const std::vector<files::ReadColumn>& columns, SweepResults& into) {
                                       return take_looks(grid, columns, into, static_cast<std::size_t>(asked.keep));
                                   }});
    push_data(L, told(grid, *results));
    return 1;
}

Data map_of(const SweepGrid& grid, const SweepResults& results) {
    Data map = results.data(grid, results.done_points());
    map.heading = heading_of_map(grid, results);
    for (const DataColumn& parameter : grid.parameters()) map.parameters.push_back(parameter.name);
    return map;
}

int sweep(lua_State* L) {
    std::vector<DataColumn> parameters = take_parameters(L, sweep_call);
    const lua::Options options(L, 1, sweep_call);
    SweepOptions asked;
    options.fill(asked);
    const int function = push_function(L, options, "run");
    check_parameters(L, sweep_call, parameters);
    check_file_of_sweep(options, asked);
    const SweepGrid grid(std::move(parameters));
    const auto results = swept(L, {.call = sweep_call.name,
                                   .grid = grid,
                                   .function = function,
                                   .workers = asked.workers,
                                   .seed = asked.seed,
                                   .file = asked.file,
                                   .max_time = asked.max_time.value_or(0),
                                   .told = map_of});
    push_data(L, map_of(grid, *results));
    return 1;
}

constexpr lua::Member sweep_members[] = {
    {lua::a_function<sweep>, sweep_doc},
    {lua::a_function<bifurcation>, bifurcation_doc},
    {lua::a_function<minimise>, minimise_doc},
};

}  // namespace

const lua::Class sweep_functions = {
    "sweep",
    {"sweep{ ... } -> data", "Many points in parallel.",
     "print(#sweep{ over = { x = { 1, 2, 3 } }, run = function(p) return { y = p.x^2 } end })  --> 3"},
    sweep_members};

void register_sweep(lua_State* L) {
    register_unfinished_sweep(L);
    lua::add_functions(L, sweep_functions);
}

}  // namespace dinal::api
