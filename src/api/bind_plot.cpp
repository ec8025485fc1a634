// plot{ ... } and the pictures it can return; run:plot and run:phase_plot, which bind_run.cpp lists.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <vector>

#include "api/classes.hpp"
#include "api/picture.hpp"
#include "api/plot_docs.hpp"
#include "api/plot_options.hpp"
#include "api/run.hpp"
#include "api/units_option.hpp"
#include "files/table.hpp"
#include "lua/options.hpp"
#include "lua/vector.hpp"
#include "plots/figure.hpp"
#include "plots/run_figure.hpp"

namespace dinal::api {
namespace {

/// The list part of plot{ ... }: curves made of vectors, runs, or pictures to set side by side.
struct PlotItems {
    std::vector<plots::Curve> curves = {};
    std::vector<plots::Figure> panels = {};  ///< of pictures
    RunHandle run = {};                      ///< the first one, when each of the curves is theta over t of a run
};

/// Copies the table at `from` without its first `listed` places to a new table on the top, where Options can check it.
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
            lua::raise(L, {.sentence = call + ": base is the second edge of a filled area; add style = \"fill\"",
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

plots::RunData data_of(lua_State* L, const lua::Options& options, const RunHandle& run) {
    return {run, &run->trajectory, run->origin ? &run->origin->system : nullptr,
            asked_units(L, options).value_or(units_of(*run))};
}

/// The name or number of a column on the top of the stack, as a name. "M/k" is left to those who know it.
std::string column_on_top(lua_State* L, const lua::Options& options, std::string_view what, const RunHandle& run) {
    if (lua_type(L, -1) == LUA_TSTRING) {
        return lua_tostring(L, -1);
    }
    const Eigen::Index column = options.value_or_fail(column_at(L, -1, run->trajectory.names(), what));
    return run->trajectory.names()[static_cast<std::size_t>(column)];
}

std::vector<std::string> asked_columns(lua_State* L, const lua::Options& options, std::string_view option,
                                       const RunHandle& run) {
    std::vector<std::string> names;
    options.push(option);
    if (lua_istable(L, -1)) {
        const auto count = static_cast<lua_Integer>(lua_rawlen(L, -1));
        if (count == 0) {
            options.fail(option,
                         fmt::format("{} must name a column at least, such as {{ \"theta\", \"friction\" }}", option));
        }
        for (lua_Integer i = 1; i <= count; ++i) {
            lua_rawgeti(L, -1, i);
            names.push_back(column_on_top(L, options, fmt::format("{}[{}]", option, i), run));
            lua_pop(L, 1);
        }
    } else if (!lua_isnil(L, -1)) {
        names.push_back(column_on_top(L, options, option, run));
    }
    lua_pop(L, 1);
    return names;
}

/// What the option `labels` calls the curves, in the order of their columns.
std::vector<std::string> asked_labels(lua_State* L, const lua::Options& options) {
    std::vector<std::string> labels;
    options.push("labels");
    if (!lua_isnil(L, -1) && !lua_istable(L, -1)) {
        options.wrong("labels", options.row("labels").wanted);
    }
    for (lua_Integer i = 1; lua_istable(L, -1) && i <= static_cast<lua_Integer>(lua_rawlen(L, -1)); ++i) {
        if (lua_rawgeti(L, -1, i) != LUA_TSTRING) {
            options.wrong("labels", options.row("labels").wanted);
        }
        labels.emplace_back(lua_tostring(L, -1));
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return labels;
}

void refuse_empty(const lua::Options& options, const RunHandle& run) {
    if (run->trajectory.size() == 0) {
        options.fail({"the run has no rows to draw; simulate it with dt = ... or times = { ... }"});
    }
}

int picture_text(lua_State* L) {
    return lua::push_text(L, text_of_picture(lua::self<Picture>(L, 1, "tostring(picture)")));
}

constexpr lua::Member plot_module_members[] = {
    {lua::a_function<plot_vectors>, plot_doc},
};

constexpr lua::Member picture_members[] = {
    {lua::a_metamethod<picture_text>("__tostring"),
     {"tostring(picture) -> string", "The picture as text, without colours; print(picture) shows it.",
      "x = vector.linspace(-2, 2, 9)\n"
      "p = plot{ { x, x^2 }, width = 40, height = 10, show = false }\n"
      "print(select(2, tostring(p):gsub(\"\\n\", \"\")))  --> 9"}},
};

}  // namespace

namespace {

bool is_column(lua_State* L, int index) {
    if (lua::test<lua::Vector>(L, index) != nullptr) return true;
    const bool number = lua_istable(L, index) && lua_rawgeti(L, index, 1) == LUA_TNUMBER;
    if (lua_istable(L, index)) lua_pop(L, 1);
    return number;
}

/// plot(x, y) and plot(x, y, { options }) become plot{ { x, y }, options }.
void join_columns(lua_State* L) {
    const int given = lua_gettop(L);
    if (given < 2 || given > 3 || !is_column(L, 1) || !is_column(L, 2) || (given == 3 && !lua_istable(L, 3))) return;
    lua_settop(L, 3);
    lua_newtable(L);
    if (lua_istable(L, 3)) {
        lua_pushnil(L);
        while (lua_next(L, 3) != 0) {
            lua_pushvalue(L, -2);
            lua_insert(L, -2);
            lua_rawset(L, 4);
        }
    }
    lua_createtable(L, 2, 0);
    for (const int i : {1, 2}) {
        lua_pushvalue(L, i);
        lua_rawseti(L, -2, i);
    }
    lua_rawseti(L, 4, 1);
    lua_replace(L, 1);
    lua_settop(L, 1);
}

}  // namespace

int plot_vectors(lua_State* L) {
    join_columns(L);
    if (lua_gettop(L) != 1 || !lua_istable(L, 1)) {
        lua::raise(L, {.sentence = fmt::format("plot takes one table of curves and named options, for example {}",
                                               plot_call.example),
                       .call = "plot"});
    }
    PlotItems items = plot_items(L, 1);
    if (items.curves.empty() && items.panels.empty()) {
        lua::raise(L, {.sentence = fmt::format("plot needs a curve, for example {}", plot_call.example),
                       .call = "plot",
                       .culprit = "nil"});  // what has no value in a table is not there
    }
    constexpr std::size_t most_curves = 1000;
    if (items.curves.size() > most_curves) {
        lua::raise(L, {.sentence = fmt::format(
                           "plot: {} curves are too many, {} can be drawn; one curve may have pieces with 0/0 (nan) "
                           "between them",
                           items.curves.size(), most_curves),
                       .call = "plot"});
    }
    push_named(L, 1, static_cast<lua_Integer>(lua_rawlen(L, 1)));
    lua_replace(L, 1);
    if (items.panels.empty()) {
        const lua::Options options(L, 1, plot_call);
        plots::Figure figure;
        figure.curves = std::move(items.curves);
        if (items.run) {
            const model::Units& units = units_of(*items.run);
            figure.x.label = model::of_unit("t", units.t);
            figure.y.label = model::of_unit("theta", units.theta);
        }
        apply_options(L, options, figure);
        std::vector<plots::Figure> figures{std::move(figure)};
        return deliver(L, options, std::move(figures));
    }
    const lua::Options options(L, 1, pictures_call);
    if (!items.curves.empty()) {
        options.fail(
            {"curves and pictures cannot be combined: put the curves into a picture of their own, "
             "plot{ ..., show = false }"});
    }
    constexpr std::size_t most = 6;
    if (items.panels.size() > most) {
        options.fail({fmt::format("{} pictures side by side are too many, {} fit", items.panels.size(), most)});
    }
    return deliver(L, options, std::move(items.panels));
}

int plot_run(lua_State* L) {
    const RunHandle run = lua::self<RunHandle>(L, 1, "run:plot()");
    const lua::Options options(L, 2, plot_run_call);
    refuse_empty(options, run);
    const std::vector<std::string> x = asked_columns(L, options, "x", run);
    if (x.size() > 1) {
        options.fail("x", "x must be one column");
    }
    // Who names the axis has decided that there is one.
    const plots::Axes axes = options.has("ylabel") ? plots::Axes::one : plots::Axes::one_a_unit;
    std::vector<plots::Figure> figures = options.value_or_fail(
        plots::column_figures(data_of(L, options, run), {.x = x.empty() ? "" : x.front(),
                                                         .ys = asked_columns(L, options, "y", run),
                                                         .labels = asked_labels(L, options),
                                                         .axes = axes}));
    apply_options(L, options, figures);
    return deliver(L, options, std::move(figures));
}

int phase_plot_run(lua_State* L) {
    const RunHandle run = lua::self<RunHandle>(L, 1, "run:phase_plot()");
    const lua::Options options(L, 2, phase_plot_call);
    refuse_empty(options, run);
    if (run->whole) {
        options.fail(
            {"the phase plane is that of a system of one body with constant Rd and Re; use run:plot{ x = \"theta\", "
             "y = \"velocity\" }"});
    }
    plots::Figure figure = options.value_or_fail(plots::phase_figure(data_of(L, options, run)));
    apply_options(L, options, figure);
    std::vector<plots::Figure> figures{std::move(figure)};
    return deliver(L, options, std::move(figures));
}

const lua::Class plot_functions = {
    "plot",
    {"plot{ { x, y }, ... }", "Draws vectors; run:plot and run:phase_plot draw runs.",
     "t = vector.linspace(0, 1, 50)\nprint(plot{ { t, (6*t):sin() }, show = false } ~= nil)  --> true"},
    plot_module_members};

const lua::Class picture_class = {
    "picture",
    {"plot{ ..., show = false }, run:plot{ show = false } -> picture",
     "A picture that is not drawn yet: print(picture) shows it, and plot{ left, right, file = \"both.svg\" } "
     "draws pictures side by side.",
     "run = nondimensional{}:simulate{ theta0 = 1, t_end = 2, dt = 0.01 }\n"
     "both = plot{ run:plot{ show = false }, run:phase_plot{ show = false }, show = false }\n"
     "print(#tostring(both) > 1000)  --> true"},
    picture_members};

void register_plot(lua_State* L) {
    lua::add_class<Picture>(L, picture_class);
    lua::add_functions(L, plot_functions);
}

}  // namespace dinal::api
