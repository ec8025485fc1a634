#include "api/bifurcation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <string_view>

#include "api/classes.hpp"
#include "api/run.hpp"
#include "api/sweep_parameters.hpp"
#include "api/sweep_run.hpp"
#include "lua/lua_text.hpp"
#include "lua/vector.hpp"
#include "model/assembly.hpp"
#include "model/oscillator.hpp"

namespace dinal::api {
namespace {

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

}  // namespace

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

}  // namespace dinal::api
