// sweep{ ... }: a function of a point asked at all points of a grid, by several threads.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "api/classes.hpp"
#include "api/run.hpp"
#include "api/sweep_options.hpp"
#include "api/sweep_run.hpp"
#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "lua/values.hpp"
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
    lua::push_copy(L, 4);
    const int options = lua_gettop(L);
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
    lua::push_copy(L, 1);  // 4: the other options
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
    struct Row {
        std::size_t point;
        double theta, velocity;
        std::string error;
    };
    std::vector<Row> rows;
    std::vector<const double*> thetas, velocities;
    for (std::size_t look = 0; look < keep; ++look) {
        thetas.push_back(results.find(look_name("theta", look)));
        velocities.push_back(results.find(look_name("velocity", look)));
    }
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    for (const std::size_t point : results.done_points()) {
        if (const auto failed = results.failures().find(point); failed != results.failures().end()) {
            rows.push_back({point, none, none, failed->second});
            continue;
        }
        for (std::size_t look = 0; look < keep; ++look) {
            rows.push_back({point, thetas[look] != nullptr ? thetas[look][point] : none,
                            velocities[look] != nullptr ? velocities[look][point] : none, ""});
        }
    }
    std::vector<std::size_t> points;
    points.reserve(rows.size());
    for (const Row& row : rows) points.push_back(row.point);
    Data data{.columns = grid.columns(points)};
    for (DataColumn& column : table_of(rows, ListColumn{"theta", &Row::theta}, ListColumn{"velocity", &Row::velocity},
                                       ListColumn{"error", &Row::error})
                                  .columns) {
        data.columns.push_back(std::move(column));
    }
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
            options.fail(parameter.name, fmt::format("'{}' is a column of the result: give the parameter another name",
                                                     parameter.name));
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
    return push_data(L, told(grid, *results));
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
    return push_data(L, map_of(grid, *results));
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

// minimise{ over, run }: the least value of a function of one or two parameters within limits. A coarse grid finds the
// valley; Brent's method (1973) follows it in one parameter, that of Nelder and Mead (1965) in two.

namespace {

constexpr double accuracy = 1.5e-8;  // of the range: below it a function near its least value is rounding

struct Range {
    std::string name;
    double low = 0, high = 0;
    [[nodiscard]] double at(double part) const { return low + (high - low) * part; }
};

/// The place in parts of the ranges, and the value there.
struct Spot {
    std::array<double, 2> at{};
    double value = 0;
};
using Cost = std::function<double(const std::array<double, 2>& at)>;

/// Brent's method between two parts of the range: parabolas, and golden sections where these do not help.
Spot brent(const Cost& cost, double a, double b, double start, double value) {
    constexpr double golden_part = 0.3819660112501051;
    double x = start, w = start, v = start, fx = value, fw = value, fv = value, step = 0, before = 0;
    constexpr int most = 200;
    for (int i = 0; i < most; ++i) {
        const double middle = (a + b) / 2;
        if (std::fabs(x - middle) <= 2 * accuracy - (b - a) / 2) break;
        double r = (x - w) * (fx - fv), q = (x - v) * (fx - fw), p = (x - v) * q - (x - w) * r;
        q = 2 * (q - r);
        if (q > 0) p = -p;
        q = std::fabs(q);
        const bool parabola = std::fabs(before) > accuracy && std::fabs(p) < std::fabs(q * before / 2) &&
                              p > q * (a - x) && p < q * (b - x);
        before = parabola ? step : (x < middle ? b - x : a - x);
        step = parabola ? p / q : golden_part * before;
        const double u = x + (std::fabs(step) >= accuracy ? step : std::copysign(accuracy, step));
        const double fu = cost({u, 0});
        if (fu <= fx) {
            (u < x ? b : a) = x;
            v = w, w = x, x = u, fv = fw, fw = fx, fx = fu;
            continue;
        }
        (u < x ? a : b) = u;
        if (fu <= fw || w == x) {
            v = w, w = u, fv = fw, fw = fu;
        } else if (fu <= fv || v == x || v == w) {
            v = u, fv = fu;
        }
    }
    return {{x, 0}, fx};
}

/// The simplex of Nelder and Mead, kept within the ranges.
Spot nelder_mead(const Cost& cost, const Spot& start, double size) {
    const auto look = [&](std::array<double, 2> at) {
        for (double& x : at) x = std::clamp(x, 0.0, 1.0);
        return Spot{at, cost(at)};
    };
    std::array<Spot, 3> corner{start, {}, {}};
    for (std::size_t i = 0; i < 2; ++i) {
        std::array<double, 2> at = start.at;
        at[i] += at[i] + size <= 1 ? size : -size;
        corner[i + 1] = look(at);
    }
    constexpr int most = 400;
    for (int i = 0; i < most; ++i) {
        std::sort(corner.begin(), corner.end(), [](const Spot& a, const Spot& b) { return a.value < b.value; });
        double widest = 0;
        for (const Spot& other : corner) {
            for (std::size_t k = 0; k < 2; ++k) widest = std::max(widest, std::fabs(other.at[k] - corner[0].at[k]));
        }
        if (widest <= accuracy) break;
        const auto along = [&](double t) {
            std::array<double, 2> at{};
            for (std::size_t k = 0; k < 2; ++k) {
                const double middle = (corner[0].at[k] + corner[1].at[k]) / 2;
                at[k] = middle + t * (corner[2].at[k] - middle);
            }
            return look(at);
        };
        const Spot mirrored = along(-1);
        if (mirrored.value < corner[0].value) {
            const Spot farther = along(-2);
            corner[2] = farther.value < mirrored.value ? farther : mirrored;
            continue;
        }
        if (mirrored.value < corner[1].value) {
            corner[2] = mirrored;
            continue;
        }
        const Spot nearer = along(mirrored.value < corner[2].value ? -0.5 : 0.5);
        if (nearer.value < std::min(mirrored.value, corner[2].value)) {
            corner[2] = nearer;
            continue;
        }
        for (std::size_t c = 1; c < 3; ++c) {
            corner[c] = look({(corner[0].at[0] + corner[c].at[0]) / 2, (corner[0].at[1] + corner[c].at[1]) / 2});
        }
    }
    return *std::min_element(corner.begin(), corner.end(),
                             [](const Spot& a, const Spot& b) { return a.value < b.value; });
}

Spot least(const Cost& cost, std::size_t parameters) {
    const int parts = parameters == 1 ? 16 : 8;
    Spot best{{}, std::numeric_limits<double>::infinity()};
    for (int i = 0; i <= parts; ++i) {
        for (int j = 0; j <= (parameters == 1 ? 0 : parts); ++j) {
            const std::array<double, 2> at{static_cast<double>(i) / parts, static_cast<double>(j) / parts};
            const double value = cost(at);
            if (value < best.value || (i == 0 && j == 0)) best = {at, value};
        }
    }
    const double width = 1.0 / parts;
    if (parameters == 2) return nelder_mead(cost, best, width / 2);
    const double x = best.at[0];
    return brent(cost, std::max(0.0, x - width), std::min(1.0, x + width), x, best.value);
}

std::vector<Range> asked_ranges(lua_State* L, const lua::Options& options) {
    std::vector<Range> ranges;
    for (const DataColumn& parameter : take_parameters(L, minimise_call)) {
        const lua::Vector* limits = parameter.numbers();
        if (limits == nullptr || limits->size() != 2 || !(limits->begin()[0] < limits->begin()[1])) {
            options.fail("over",
                         fmt::format("over.{0} must be the two limits of {0}, such as {{ 0.1, 2 }}", parameter.name));
        }
        ranges.push_back({parameter.name, limits->begin()[0], limits->begin()[1]});
    }
    if (ranges.empty()) options.missing("over");
    if (ranges.size() > 2) options.fail("over", "over has more than two parameters; minimise takes one or two");
    for (const Range& range : ranges) {
        if (range.name != "value" && range.name != "calls") continue;
        options.fail("over", fmt::format("'{}' is a field of the result: give the parameter another name", range.name));
    }
    return ranges;
}

}  // namespace

int minimise(lua_State* L) {
    const lua::Options options(L, 1, minimise_call);
    const std::vector<Range> ranges = asked_ranges(L, options);
    const int function = push_function(L, options, "run");
    lua_Integer calls = 0;
    const Cost cost = [&](const std::array<double, 2>& at) {
        ++calls;
        lua_pushvalue(L, function);
        lua_createtable(L, 0, 2);
        std::string place;
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            const double x = ranges[i].at(at[i]);
            lua_pushnumber(L, x);
            lua_setfield(L, -2, ranges[i].name.c_str());
            place += fmt::format("{}{} = {:.6g}", i == 0 ? "" : ", ", ranges[i].name, x);
        }
        lua_call(L, 1, 1);
        const double value = lua_tonumber(L, -1);
        if (lua_type(L, -1) != LUA_TNUMBER || std::isnan(value)) {
            options.fail("run",
                         fmt::format("run returned {} at {}; it must return a number, math.huge if there is none",
                                     lua::describe(L, -1), place));
        }
        lua_pop(L, 1);
        return value;
    };
    const Spot best = least(cost, ranges.size());
    lua_createtable(L, 0, 4);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        lua_pushnumber(L, ranges[i].at(best.at[i]));
        lua_setfield(L, -2, ranges[i].name.c_str());
    }
    lua_pushnumber(L, best.value);
    lua_setfield(L, -2, "value");
    lua_pushinteger(L, calls);
    lua_setfield(L, -2, "calls");
    return 1;
}

namespace {

[[noreturn]] void fail_sweep(lua_State* L, const text::Call& call, text::Error error) {
    lua::fail(L, call.name, std::move(error));
}

bool is_option(const text::Call& call, std::string_view name) {
    return std::any_of(call.options.begin(), call.options.end(),
                       [name](const text::Option& option) { return option.name == name; });
}

/// The values on the top of the stack.
DataColumn parameter_on_top(lua_State* L, const text::Call& call, const std::string& name) {
    if (!lua_istable(L, -1) && lua::test<lua::Vector>(L, -1) == nullptr) {
        fail_sweep(L, call,
                   {.sentence = fmt::format("over.{} must be a vector or a table of values, got {}", name,
                                            lua::describe(L, -1)),
                    .option = "over",
                    .culprit = name});
    }
    if (lua_istable(L, -1)) {
        const bool of_words = lua_rawgeti(L, -1, 1) == LUA_TSTRING;
        lua_pop(L, 1);
        if (of_words) return read_column(L, call.name, name);
    }
    std::vector<double> numbers = lua::numbers_at(L, -1, call.name, name);
    if (numbers.empty()) {
        fail_sweep(L, call, {.sentence = fmt::format("{} has no values", name), .option = name});
    }
    return column_of(name, std::move(numbers));
}

/// Those of the table at this index: { r = values }, in the order of their names, or { { "r", values } }, as listed.
std::vector<DataColumn> parameters_in(lua_State* L, int table, const text::Call& call) {
    return columns_in(
        L, table, [&](const std::string& name) { return parameter_on_top(L, call, name); },
        [&](lua_Integer i) {
            lua::fail(L, call.name,
                      {fmt::format("over[{}] must be a name and its values, {{ \"r\", v }}; or name them, r = v", i)});
        });
}

/// Names the new form of a call that has its parameters among its options.
void refuse_old_form(lua_State* L, const text::Call& call) {
    for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1)) {
        const bool named = lua_type(L, -2) == LUA_TSTRING;
        const bool values = lua_istable(L, -1) || lua::test<lua::Vector>(L, -1) != nullptr;
        if (!values || (named && is_option(call, lua_tostring(L, -2)))) continue;
        const std::string name = named ? lua_tostring(L, -2) : "NAME";
        fail_sweep(L, call,
                   {.sentence = fmt::format("parameters and their values stand in over = {{ {} = values }}", name),
                    .option = "over"});
    }
}

}  // namespace

std::vector<DataColumn> take_parameters(lua_State* L, const text::Call& call) {
    if (lua_gettop(L) != 1 || !lua_istable(L, 1)) {
        lua::raise(L, {.sentence = fmt::format("{} takes one table, for example {}", call.name, call.example),
                       .call = call.name});
    }
    refuse_old_form(L, call);
    lua_getfield(L, 1, "over");
    if (!lua_isnoneornil(L, -1) && !lua_istable(L, -1)) {
        fail_sweep(L, call,
                   {.sentence = fmt::format("over must be {}, got {}", over_option[0].wanted, lua::describe(L, -1)),
                    .option = "over",
                    .culprit = lua::written(L, -1)});
    }
    std::vector<DataColumn> parameters;
    if (lua_istable(L, -1)) parameters = parameters_in(L, lua_gettop(L), call);
    lua_pop(L, 1);
    return parameters;
}

std::vector<DataColumn> varied_in(lua_State* L, const lua::Options& options, const text::Call& call) {
    options.push("over");
    if (lua_isnil(L, -1)) options.missing("over");
    if (!lua_istable(L, -1)) options.wrong("over");
    std::vector<DataColumn> parameters = parameters_in(L, lua_gettop(L), call);
    lua_pop(L, 1);
    if (parameters.empty()) options.wrong("over");
    if (parameters.size() > 2) {
        options.fail("over", fmt::format("over has {} names: a response varies one or two, and sweep varies more",
                                         parameters.size()));
    }
    check_parameters(L, call, parameters);
    for (const DataColumn& parameter : parameters) {
        if (parameter.numbers() == nullptr) {
            options.fail("over", fmt::format("over.{} must be a list of numbers", parameter.name));
        }
    }
    return parameters;
}

void check_parameters(lua_State* L, const text::Call& call, const std::vector<DataColumn>& parameters) {
    if (parameters.empty()) {
        fail_sweep(L, call, {fmt::format("there is no parameter; for example {}", call.example)});
    }
    double points = 1;
    std::set<std::string> names;
    for (const DataColumn& parameter : parameters) {
        if (!names.insert(parameter.name).second || parameter.name == "error") {
            fail_sweep(L, call,
                       {.sentence = parameter.name == "error"
                                        ? "'error' is the column of messages: give the parameter another name"
                                        : fmt::format("there are two parameters '{}'", parameter.name),
                        .option = parameter.name});
        }
        points *= static_cast<double>(parameter.size());
    }
    constexpr double most = 1e9;
    if (points > most) {
        fail_sweep(L, call,
                   {fmt::format("{:.3g} points are more than the {:.0e} that one sweep can hold", points, most)});
    }
}

int push_function(lua_State* L, const lua::Options& options, const char* name) {
    options.push(name);
    if (lua_isnil(L, -1)) options.missing(name);
    if (!lua::is_callable(L, -1)) options.wrong(name);
    return lua_gettop(L);
}

}  // namespace dinal::api
