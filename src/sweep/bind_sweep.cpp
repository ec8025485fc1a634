// sweep{ ... }: calls a function at all points of a grid, on several threads.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "api/lua_run.hpp"
#include "api/steady_answer.hpp"
#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "lua/options.hpp"
#include "lua/values.hpp"
#include "lua/vector.hpp"
#include "model/oscillator.hpp"
#include "model/system.hpp"
#include "sweep/sweep_run.hpp"
#include "text/option.hpp"

namespace dinal::sweep {

using namespace api;

namespace {

// ---- bifurcation{ ... }: stroboscopic states of a motion over a parameter, computed by workers of a sweep.

struct BifurcationOptions {
    double skip = 200;
    double keep = 100;
};

constexpr text::Option bifurcation_only_options[] = {
    {.name = "at",
     .otherwise = text::needed,
     .meaning =
         "a function of a point, a table such as { a = 0.5 }, that returns options of sys:simulate, with system = "
         "... and, if need be, another period; for several bodies also of = \"load\", the body to record",
     .wanted = "a function of a point that returns { system = ..., M = ... }"},
    period_row("time between samples; needed unless `at` returns { period = ... }"),
    instead_of_period[0],
    instead_of_period[1],
    text::option<&BifurcationOptions::skip>(
        "skip", "periods to skip while the motion settles",
        {.range = {"be a whole number from 0 to 1e6", [](double x) { return text::is_whole(x, 0, 1e6); }}}),
    text::option<&BifurcationOptions::keep>(
        "keep", "periods to record after that, one row each",
        {.range = {"be a whole number from 1 to 10000", [](double x) { return text::is_whole(x, 1, 1e4); }}}),
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

/// The names of a point's results: "theta 1", "velocity 1", ...
std::string sample_name(const char* column, std::size_t sample) {
    return fmt::format("{} {}", column, sample + 1);
}

/// Pushes a field of the table at the index and removes it there; returns its type.
int take_field(lua_State* L, int table, const char* name) {
    const int type = lua_getfield(L, table, name);
    lua_pushnil(L);
    lua_setfield(L, table, name);
    return type;
}

/// Takes the options period, frequency or omega out of the table at `more`; returns the period that they give, or else
/// `otherwise`.
double period_of_point(lua_State* L, int more, double otherwise) {
    const auto period = [](const char* name, double x) {
        return *name == 'p' ? x : *name == 'f' ? 1 / x : 2 * std::numbers::pi / x;
    };
    double found = otherwise;
    for (const char* name : {"period", "frequency", "omega"}) {
        if (take_field(L, more, name) != LUA_TNIL) {
            const double x = lua_tonumber(L, -1);
            if (!(lua_type(L, -1) == LUA_TNUMBER && x > 0 && x < 1e300)) {
                lua::raise(L, "at returned {} = {}, which must be a positive number", name, lua::describe(L, -1));
            }
            found = period(name, x);
        }
        lua_pop(L, 1);
    }
    if (!(found > 0)) lua::raise(L, "bifurcation needs period, a number, or at must return { period = ... }");
    return found;
}

/// Raises an error for options that bifurcation itself passes to sys:simulate.
void refuse_own_options(lua_State* L, int more) {
    for (const char* name : {"t_end", "dt", "times", "dense"}) {
        if (lua_getfield(L, more, name) != LUA_TNIL) {
            lua::raise(L, "at returned {}, which bifurcation sets itself: choose the samples by period, skip and keep",
                       name);
        }
        lua_pop(L, 1);
    }
}

/// The function that workers call with a point. Its upvalues are the user's function, period, skip and keep.
int samples_of_point(lua_State* L) {
    lua_settop(L, 1);
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, 1, 1);
    if (!lua_istable(L, 1)) {
        lua::raise(L, "at must return a table such as {{ system = sys, M = M }}, got {}", lua::describe(L, 1));
    }
    lua::push_copy(L, 1);  // index 2: the options of simulate
    take_field(L, 2, "system");
    const auto* system = lua::test<model::SystemHandle>(L, 3);
    if (system == nullptr) {
        lua::raise(L, "at must return a table with system = ..., got {} there", lua::describe(L, 3));
    }
    const bool several = (*system)->named;
    if (take_field(L, 2, "of") != LUA_TSTRING && several) {
        lua::raise(L, "at must return the body to record, such as of = \"load\"");
    }
    const double period = period_of_point(L, 2, lua_tonumber(L, lua_upvalueindex(2)));
    const auto skip = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(3)));
    const auto keep = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(4)));
    refuse_own_options(L, 2);
    lua_getfield(L, 2, "t_start");
    const double start = lua_tonumber(L, -1);
    std::vector<double> times(keep);
    for (std::size_t i = 0; i < keep; ++i) times[i] = start + period * static_cast<double>(skip + i + 1);
    lua::push_vector(L, std::move(times));
    lua_setfield(L, 2, "times");
    lua_pushboolean(L, 0);
    lua_setfield(L, 2, "dense");
    lua_settop(L, 4);  // the options, the system, the body
    lua_getfield(L, 3, "simulate");
    lua_pushvalue(L, 3);
    lua_pushvalue(L, 2);
    lua_call(L, 2, 1);
    if (several) {
        lua_pushvalue(L, 4);
        lua_gettable(L, -2);
    }
    const int run = lua_gettop(L);
    if (const auto* own = lua::test<RunHandle>(L, run); own != nullptr && !is_whole((*own)->result.outcome)) {
        lua::raise(L, "the run ended before the last sample: {}", motion::outcome_text((*own)->result));
    }
    lua_createtable(L, 0, static_cast<int>(2 * keep));
    for (const char* column : {"theta", "velocity"}) {
        lua_getfield(L, run, column);
        const lua::Vector values = *lua::test<lua::Vector>(L, -1);
        lua_pop(L, 1);
        for (std::size_t i = 0; i < std::min(keep, values.size()); ++i) {
            lua::set_number(L, sample_name(column, i).c_str(), values.begin()[i]);
        }
    }
    return 1;
}

/// Makes a row for each sample of these points, and one row for a failed point.
std::vector<DataColumn> samples_as_rows(const PointGrid& grid, const SweepResults& results,
                                        const std::vector<std::size_t>& done, std::size_t keep) {
    std::vector<std::size_t> points;
    std::vector<double> theta, velocity;
    std::vector<std::string> errors;
    const auto number = [&results](const char* column, std::size_t sample, std::size_t point) {
        const double* numbers = results.find(sample_name(column, sample));
        return numbers != nullptr ? numbers[point] : std::numeric_limits<double>::quiet_NaN();
    };
    for (const std::size_t point : done) {
        const auto failed = results.failures().find(point);
        const bool is_good = failed == results.failures().end();
        for (std::size_t sample = 0; sample < (is_good ? keep : 1); ++sample) {
            points.push_back(point);
            theta.push_back(number("theta", sample, point));
            velocity.push_back(number("velocity", sample, point));
            errors.push_back(is_good ? "" : failed->second);
        }
    }
    std::vector<DataColumn> columns = grid.columns(points);
    columns.push_back(column_of("theta", std::move(theta)));
    columns.push_back(column_of("velocity", std::move(velocity)));
    columns.push_back(column_of("error", std::move(errors)));
    return columns;
}

int bifurcation(lua_State* L) {
    const lua::Options options(L, 1, bifurcation_call);
    BifurcationOptions asked;
    SweepOptions of_workers;
    options.fill(asked);
    options.fill(of_workers);
    const int function = push_function(L, options, "at");
    const PointGrid grid(asked_parameters(L, options));
    for (const DataColumn& parameter : grid.parameters()) {
        if (parameter.name == "theta" || parameter.name == "velocity") {
            options.fail("over", "'{}' is a column of the result: give the parameter another name", parameter.name);
        }
    }
    check_file_of_sweep(options, of_workers);
    const double period = asked_period(options).value_or(0);
    const auto keep = static_cast<std::size_t>(asked.keep);
    const auto adapt = [&](lua_State* worker) {
        lua_pushnumber(worker, period);
        lua_pushinteger(worker, static_cast<lua_Integer>(asked.skip));
        lua_pushinteger(worker, static_cast<lua_Integer>(asked.keep));
        lua_pushcclosure(worker, lua::guarded<samples_of_point>, 4);
    };
    return push_data(
        L, swept(L, {.call = bifurcation_call.name,
                     .grid = grid,
                     .function = function,
                     .workers = of_workers.workers,
                     .file = of_workers.file,
                     .max_time = of_workers.max_time.value_or(0),
                     .settings = {period, asked.skip, asked.keep},
                     .adapt = adapt,
                     .form = {.columns = {}, .points_of = "theta"},
                     .make_columns = [&](const SweepResults& results, const std::vector<std::size_t>& points) {
                         return samples_as_rows(grid, results, points, keep);
                     }}));
}

SweepTask task_of(const lua::Options& options, int function, const PointGrid& grid) {
    SweepOptions asked;
    options.fill(asked);
    check_file_of_sweep(options, asked);
    SweepTask task{.call = sweep_call.name,
                   .grid = grid,
                   .function = function,
                   .workers = asked.workers,
                   .seed = asked.seed,
                   .file = asked.file,
                   .max_time = asked.max_time.value_or(0)};
    for (const DataColumn& parameter : grid.parameters()) task.form.parameters.push_back(parameter.name);
    if (asked.points.empty()) return task;
    const double first = asked.points.front(), last = asked.points.back();
    if (asked.points.size() != 2 || !(first >= 1 && last >= first && last <= static_cast<double>(grid.size()))) {
        options.fail("points", "points must be the first and the last one, of 1 to {}", grid.size());
    }
    if (!asked.file.empty()) options.fail("points", "points and file exclude each other: save the data");
    task.points = {static_cast<std::size_t>(first) - 1, static_cast<std::size_t>(last)};
    return task;
}

}  // namespace

int run_sweep(lua_State* L) {
    const lua::Options options(L, 1, sweep_call);
    const int function = push_function(L, options, "run");
    const PointGrid grid(asked_parameters(L, options));
    return push_data(L, swept(L, task_of(options, function, grid)));
}

int sweep_in_parts(lua_State* L) {
    const std::string mark(lua::text_at(L, 2));
    lua_settop(L, 1);
    const lua::Options options(L, 1, sweep_call);
    const int function = push_function(L, options, "run");
    push_parted(L, asked_parameters(L, options), [&](const PointGrid& grid) {
        SweepTask task = task_of(options, function, grid);
        task.mark = mark;
        return task;
    });
    return 1;
}

namespace {

constexpr lua::Member sweep_members[] = {
    {lua::a_function<run_sweep>, sweep_doc},
    {lua::a_function<bifurcation>, bifurcation_doc},
    {lua::a_function<minimise>, minimise_doc},
};

void add_sweep(lua_State* L, const lua::Class& functions) {
    register_parted_sweep(L);
    lua::add_functions(L, functions);
}

}  // namespace

const lua::Class sweep_functions = {
    "sweep",
    {"sweep{ ... } -> data", "Many points in parallel.",
     "print(#sweep{ over = { x = { 1, 2, 3 } }, run = function(p) return { y = p.x^2 } end })  --> 3"},
    sweep_members,
    add_sweep};

// minimise{ over, run }: the minimum of a function of one or two parameters within limits. A coarse grid locates the
// valley; golden sections follow it in one parameter, the method of Nelder and Mead (1965) in two.

namespace {

constexpr double accuracy = 1.5e-8;  // fraction of the range: closer to the minimum, values differ by rounding only

struct Range {
    std::string name;
    double low = 0, high = 0;
    double at(double part) const { return low + (high - low) * part; }
};

/// A place as fractions of the ranges, and its value.
struct Spot {
    std::array<double, 2> at{};
    double value = 0;
};
using Cost = std::function<double(const std::array<double, 2>& at)>;

/// Golden sections between two fractions of the range.
Spot golden_section(const Cost& cost, double a, double b) {
    constexpr double part = 0.6180339887498949;
    Spot left{{b - part * (b - a)}, 0}, right{{a + part * (b - a)}, 0};
    left.value = cost(left.at), right.value = cost(right.at);
    while (b - a > 2 * accuracy) {
        const bool lower = left.value <= right.value;
        (lower ? b : a) = (lower ? right : left).at[0];
        std::swap(left, right);
        Spot& added = lower ? left : right;
        added.at[0] = lower ? b - part * (b - a) : a + part * (b - a);
        added.value = cost(added.at);
    }
    return left.value <= right.value ? left : right;
}

/// The simplex method of Nelder and Mead within the ranges.
Spot nelder_mead(const Cost& cost, const Spot& start, double size) {
    const auto evaluated = [&](std::array<double, 2> at) {
        for (double& x : at) x = std::clamp(x, 0.0, 1.0);
        return Spot{at, cost(at)};
    };
    std::array<Spot, 3> corner{start, {}, {}};
    for (std::size_t i = 0; i < 2; ++i) {
        std::array<double, 2> at = start.at;
        at[i] += at[i] + size <= 1 ? size : -size;
        corner[i + 1] = evaluated(at);
    }
    constexpr int most = 400;
    for (int i = 0; i < most; ++i) {
        std::ranges::sort(corner, {}, &Spot::value);
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
            return evaluated(at);
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
            corner[c] = evaluated({(corner[0].at[0] + corner[c].at[0]) / 2, (corner[0].at[1] + corner[c].at[1]) / 2});
        }
    }
    return *std::ranges::min_element(corner, {}, &Spot::value);
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
    const Spot found = golden_section(cost, std::max(0.0, x - width), std::min(1.0, x + width));
    return found.value < best.value ? found : best;
}

std::vector<Range> asked_ranges(lua_State* L, const lua::Options& options) {
    std::vector<Range> ranges;
    for (const DataColumn& parameter : asked_parameters(L, options)) {
        const lua::Vector* limits = parameter.numbers();
        if (limits == nullptr || limits->size() != 2 || !(limits->begin()[0] < limits->begin()[1])) {
            options.fail("over", "over.{0} must be the two limits of {0}, such as {{ 0.1, 2 }}", parameter.name);
        }
        ranges.push_back({parameter.name, limits->begin()[0], limits->begin()[1]});
    }
    if (ranges.size() > 2) options.fail("over", "over has more than two parameters; minimise takes one or two");
    for (const Range& range : ranges) {
        if (range.name != "value" && range.name != "calls") continue;
        options.fail("over", "'{}' is a field of the result: give the parameter another name", range.name);
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
            options.fail("run", "run returned {} at {}; it must return a number, math.huge if there is none",
                         lua::describe(L, -1), place);
        }
        lua_pop(L, 1);
        return value;
    };
    const Spot best = least(cost, ranges.size());
    lua_createtable(L, 0, 4);
    for (std::size_t i = 0; i < ranges.size(); ++i)
        lua::set_number(L, ranges[i].name.c_str(), ranges[i].at(best.at[i]));
    lua::set_value(L, "value", best.value);
    lua::set_value(L, "calls", calls);
    return 1;
}

}  // namespace dinal::sweep
