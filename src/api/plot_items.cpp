#include "api/plot_items.hpp"

#include <fmt/format.h>

#include <memory>

#include "api/picture.hpp"
#include "api/plot_options.hpp"
#include "lua/options.hpp"
#include "lua/vector.hpp"

namespace dinal::api {
namespace {

plots::Numbers numbers_on_top(lua_State* L, std::string_view what) {
    if (const auto* vector = lua::test<lua::Vector>(L, -1)) {
        const auto kept = std::make_shared<const lua::Vector>(*vector);  // a view; no number is copied
        return {kept, kept->values()};
    }
    if (!lua_istable(L, -1)) {
        lua::raise_got(L, -1, what, fmt::format("{} must be a vector or a table of numbers", what));
    }
    std::vector<double> values(lua_rawlen(L, -1));
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (lua_rawgeti(L, -1, static_cast<lua_Integer>(i) + 1) != LUA_TNUMBER) {
            lua::raise_got(L, -1, what, fmt::format("{}[{}] must be a number", what, i + 1));
        }
        values[i] = lua_tonumber(L, -1);  // nan is a gap
        lua_pop(L, 1);
    }
    return plots::Numbers::own(std::move(values));
}

plots::Numbers numbers_of_run(lua_State* L, const RunHandle& run, const char* name, const std::string& call) {
    if (run->trajectory.size() == 0) {
        lua::raise(L, {.sentence = call + ": the run has no rows to draw; simulate it with dt = ... or times = { ... }",
                       .call = call});
    }
    const auto column = run->trajectory.find(name);
    if (!column) {
        lua::raise(
            L, {.sentence = fmt::format("{}: the run has no column '{}'; its columns are vectors, and a curve is "
                                        "{{ run.{}, run.{} }}",
                                        call, name, run->trajectory.names().front(), run->trajectory.names().back()),
                .call = call});
    }
    const auto values = run->trajectory.rows.col(*column);
    return {run, {values.data(), static_cast<std::size_t>(values.size())}};
}

plots::Curve curve_with_options(lua_State* L, int item, lua_Integer listed, const std::string& call) {
    push_named(L, item, listed);
    const text::Call named{call.c_str(), curve_call.example, curve_call.options};  // which of the curves it is
    const lua::Options options(L, lua_gettop(L), named);
    plots::Curve curve;
    options.fill(curve);
    if (options.has("base")) {
        options.push("base");
        curve.base = numbers_on_top(L, call + ": base");
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return curve;
}

/// The run that stands first in the table on the top of the stack, or is itself there; none when there is none.
RunHandle run_on_top(lua_State* L) {
    if (const auto* run = lua::test<RunHandle>(L, -1)) return *run;
    if (!lua_istable(L, -1)) return nullptr;
    lua_rawgeti(L, -1, 1);
    const auto* run = lua::test<RunHandle>(L, -1);
    RunHandle found = run ? *run : nullptr;
    lua_pop(L, 1);
    return found;
}

/// theta over t of a run, which may have options beside it in a table.
plots::Curve curve_of_run(lua_State* L, const RunHandle& run, const std::string& call) {
    plots::Curve curve;
    if (lua_istable(L, -1)) curve = curve_with_options(L, lua_gettop(L), 1, call);
    curve.x = numbers_of_run(L, run, "t", call);
    curve.y = numbers_of_run(L, run, "theta", call);
    return curve;
}

/// The curve that the table on the top of the stack describes; the table stays.
plots::Curve curve_on_top(lua_State* L, const std::string& call) {
    const int item = lua_gettop(L);
    plots::Curve curve = curve_with_options(L, item, 2, call);
    const auto vector = [L, item, &call](lua_Integer place, std::string_view name) {
        lua_rawgeti(L, item, place);
        plots::Numbers numbers = numbers_on_top(L, fmt::format("{}: {}", call, name));
        lua_pop(L, 1);
        return numbers;
    };
    curve.x = vector(1, "x");
    curve.y = vector(2, "y");
    const auto same_length = [&](const plots::Numbers& numbers, std::string_view name) {
        if (numbers.values.size() != curve.x.values.size()) {
            lua::raise(L, {.sentence = fmt::format("{}: x has {} numbers, but {} has {}", call, curve.x.values.size(),
                                                   name, numbers.values.size()),
                           .call = call,
                           .option = std::string(name)});
        }
    };
    same_length(curve.y, "y");
    if (curve.base) {
        same_length(*curve.base, "base");
        if (curve.style != plots::Style::fill) {
            lua::raise(L, {.sentence = call + ": base is the other edge of a fill; add style = \"fill\"",
                           .call = call,
                           .option = "base"});
        }
    }
    return curve;
}

/// plot{ { 0, 1 }, { 2, 3 } } forgets the braces around x and y; its items are no curves.
bool is_table_of_items(lua_State* L) {
    if (!lua_istable(L, -1)) {
        return false;
    }
    const bool numbers = lua_rawgeti(L, -1, 1) == LUA_TNUMBER;
    lua_pop(L, 1);
    return !numbers;
}

}  // namespace

void push_named(lua_State* L, int from, lua_Integer listed) {
    lua_newtable(L);
    lua_pushnil(L);
    while (lua_next(L, from) != 0) {
        if (lua_isinteger(L, -2) != 0 && lua_tointeger(L, -2) >= 1 && lua_tointeger(L, -2) <= listed) {
            lua_pop(L, 1);
            continue;
        }
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, -4);
    }
}

PlotItems plot_items(lua_State* L, int table) {
    PlotItems items;
    bool of_runs = true;
    const auto count = static_cast<lua_Integer>(lua_rawlen(L, table));
    for (lua_Integer i = 1; i <= count; ++i) {
        lua_rawgeti(L, table, i);
        if (const auto* picture = lua::test<Picture>(L, -1)) {
            items.panels.insert(items.panels.end(), picture->figures.begin(), picture->figures.end());
        } else if (const RunHandle run = run_on_top(L)) {
            items.curves.push_back(curve_of_run(L, run, fmt::format("plot: curve {}", i)));
            if (!items.run) items.run = run;
        } else if (is_table_of_items(L)) {
            of_runs = false;
            items.curves.push_back(curve_on_top(L, fmt::format("plot: curve {}", i)));
        } else {
            lua::raise_got(L, -1, "plot",
                           fmt::format("plot: item {} must be a curve {{ x, y }}, a run or a picture", i),
                           fmt::format("; for example {}", plot_call.example));
        }
        lua_pop(L, 1);
    }
    if (!of_runs) items.run = nullptr;
    return items;
}

}  // namespace dinal::api
