// plot{ ... } and its pictures; run:plot and run:phase_plot, which bind_run.cpp lists.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "api/bodies.hpp"
#include "api/classes.hpp"
#include "api/lua_run.hpp"
#include "api/picture.hpp"
#include "files/file.hpp"
#include "lua/interrupt.hpp"
#include "lua/memory_limit.hpp"
#include "lua/options.hpp"
#include "lua/values.hpp"
#include "lua/vector.hpp"
#include "lua/worker_state.hpp"
#include "model/controller.hpp"
#include "plots/figure.hpp"
#include "plots/painter.hpp"
#include "plots/run_figure.hpp"
#include "plots/svg_words.hpp"
#include "terminal/display.hpp"
#include "text/words.hpp"

namespace dinal::api {

namespace {

/// The list part of plot{ ... }: curves from vectors or runs, or pictures to be placed side by side.
struct PlotItems {
    std::vector<plots::Curve> curves = {};
    std::vector<plots::Figure> panels = {};  ///< from pictures
    RunHandle run = {};                      ///< the first run if every curve is theta over t of a run
};

plots::Numbers numbers_on_top(lua_State* L, std::string_view what) {
    if (const auto* vector = lua::test<lua::Vector>(L, -1)) {
        const auto kept = std::make_shared<const lua::Vector>(*vector);  // a view without copying
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
        values[i] = lua_tonumber(L, -1);  // nan marks a gap
        lua_pop(L, 1);
    }
    return plots::Numbers::own(std::move(values));
}

plots::Numbers numbers_of_run(lua_State* L, const std::shared_ptr<const motion::Run>& run, const char* name,
                              const std::string& call) {
    if (run->size() == 0) {
        lua::raise(L, {.sentence = call + ": the run has no rows to draw; simulate it with dt = ... or times = { ... }",
                       .call = call});
    }
    const auto column = run->find(name);
    if (!column) {
        lua::fail(L, call,
                  "the run has no column '{}'; its columns are vectors, and a curve is "
                  "{{ run.{}, run.{} }}",
                  name, run->names().front(), run->names().back());
    }
    const auto values = run->rows.col(*column);
    return {run, {values.data(), static_cast<std::size_t>(values.size())}};
}

plots::Curve curve_with_options(lua_State* L, int item, lua_Integer listed, const std::string& call) {
    lua::push_copy(L, item, listed);
    // errors contain the name of the curve
    const text::Call named{call.c_str(), curve_call.example, curve_call.options};
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

/// The run on the top of the stack, or first in the table there; otherwise null.
RunHandle run_on_top(lua_State* L) {
    if (const auto* run = lua::test<RunHandle>(L, -1)) return *run;
    if (!lua_istable(L, -1)) return nullptr;
    lua_rawgeti(L, -1, 1);
    const auto* run = lua::test<RunHandle>(L, -1);
    RunHandle found = run ? *run : nullptr;
    lua_pop(L, 1);
    return found;
}

/// The curve theta over t of a run, alone or in a table with options.
plots::Curve curve_of_run(lua_State* L, const RunHandle& run, const std::string& call) {
    plots::Curve curve;
    if (lua_istable(L, -1)) curve = curve_with_options(L, lua_gettop(L), 1, call);
    check_one(L, *run, ".theta");
    const auto drawn = drawn_run(L, run);
    curve.x = numbers_of_run(L, drawn, "t", call);
    curve.y = numbers_of_run(L, drawn, "theta", call);
    return curve;
}

/// The curve described by the table on the top of the stack, which stays.
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
            lua::fail(L, call,
                      {.sentence = fmt::format("x has {} numbers, but {} has {}", curve.x.values.size(), name,
                                               numbers.values.size()),
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

/// Returns whether the braces around x and y are missing: plot{ { 0, 1 }, { 2, 3 } } has items that are not curves.
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

/// The value of an excitation that is constant from this time on, otherwise none.
std::optional<double> constant_value(const model::Excitation& excitation, double t) {
    if (excitation.components().empty()) return 0;
    return excitation.constant_from() <= t ? std::optional(excitation.value(t)) : std::nullopt;
}

/// The constant load on the mass; none if it varies, or if the mass would rest on a moving belt.
std::optional<double> constant_load(const LuaRun& run) {
    if (!run.origin || run.system().joints.size() > 1) return {};
    const source::Task& task = *run.origin;
    const double t = task.window.start;
    const auto M = constant_value(run.terms ? *run.terms : task.drive.M(), t);
    const auto belt = constant_value(task.drive.belt(), t), base = constant_value(task.drive.base, t);
    if (!M || !base || belt != 0.0) return {};
    return *M - run.system().bodies.front().inertia * *base;
}

/// A copy without events, which belong to all bodies.
std::shared_ptr<const motion::Run> without_events(const motion::Run& result) {
    auto rows = std::make_shared<motion::Run>(result);
    rows->events = {};
    return rows;
}

plots::RunData data_of(lua_State* L, const lua::Options& options, const RunHandle& run,
                       const std::vector<double>& window = {}) {
    const auto drawn = run->of_all() ? without_events(run->result) : drawn_run(L, run, window);
    if (drawn->size() == 0) {
        options.fail({"the run has no rows to draw; simulate it with dt = ... or times = { ... }"});
    }
    return {drawn, drawn.get(), alone(*run), asked_units(L, options).value_or(units_of(*run)), constant_load(*run)};
}

/// The name of the column on the top of the stack, given by name or number. "M/k" is resolved elsewhere.
std::string column_on_top(lua_State* L, const lua::Options& options, std::string_view what, const RunHandle& run) {
    if (lua_type(L, -1) == LUA_TSTRING) {
        return lua_tostring(L, -1);
    }
    const Eigen::Index column = options.value_or_fail(column_at(L, -1, run->result.names(), what));
    return run->result.names()[static_cast<std::size_t>(column)];
}

std::vector<std::string> asked_columns(lua_State* L, const lua::Options& options, std::string_view option,
                                       const RunHandle& run) {
    std::vector<std::string> names;
    options.push(option);
    if (lua_istable(L, -1)) {
        const auto count = static_cast<lua_Integer>(lua_rawlen(L, -1));
        if (count == 0) {
            options.fail(option, "{} must name a column at least, such as {{ \"theta\", \"friction\" }}", option);
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

/// The labels of the curves from the option `labels`, in the order of their columns.
std::vector<std::string> asked_labels(lua_State* L, const lua::Options& options, std::size_t curves) {
    options.push("labels");
    const auto labels = lua_type(L, -1) == LUA_TSTRING ? std::nullopt : lua::strings_at(L, -1);
    if (!labels) options.wrong("labels");
    if (labels->empty() && lua_istable(L, -1)) {
        lua_pushnil(L);
        if (lua_next(L, -2) != 0) lua_pop(L, 2), options.wrong("labels");  // { theta = "angle" }
    }
    if (curves > 0 && labels->size() > curves) {
        options.fail("labels", "labels has {} names for {}", labels->size(), text::counted(curves, "column"));
    }
    lua_pop(L, 1);
    return *labels;
}

constexpr lua::Member plot_module_members[] = {
    {lua::a_function<plot_vectors>, plot_doc},
};

constexpr lua::Member picture_members[] = {
    {lua::a_text<Picture, text_of_picture>,
     {"tostring(picture) -> string", "The picture as text, without colours; print(picture) shows it.",
      "x = vector.linspace(-2, 2, 9)\n"
      "p = plot{ { x, x^2 }, width = 40, height = 10, show = false }\n"
      "print(select(2, tostring(p):gsub(\"\\n\", \"\")))  --> 9"}},
};

bool is_column(lua_State* L, int index) {
    if (lua::test<lua::Vector>(L, index) != nullptr) return true;
    const bool number = lua_istable(L, index) && lua_rawgeti(L, index, 1) == LUA_TNUMBER;
    if (lua_istable(L, index)) lua_pop(L, 1);
    return number;
}

/// The number of columns in the table at `index`; 0 for other values.
lua_Integer columns_in(lua_State* L, int index) {
    const auto count = lua_istable(L, index) ? static_cast<lua_Integer>(lua_rawlen(L, index)) : 0;
    for (lua_Integer i = 1; i <= count; ++i) {
        const bool column = lua_rawgeti(L, index, i) != LUA_TNUMBER && is_column(L, lua_gettop(L));
        lua_pop(L, 1);
        if (!column) return 0;
    }
    return count;
}

/// Rewrites plot(run), plot(x, y), plot(x, { y, z }) and the same with options as plot{ run, options } and plot{ { x, y
/// }, { x, z }, options }.
void join_columns(lua_State* L) {
    const bool run = lua::test<RunHandle>(L, 1) != nullptr;
    const int given = lua_gettop(L), columns = run ? 1 : 2;
    const lua_Integer several = run || given < 2 ? 0 : columns_in(L, 2);
    const bool fits = run || (given >= 2 && is_column(L, 1) && (several > 0 || is_column(L, 2)));
    if (!fits || given > columns + 1 || (given == columns + 1 && !lua_istable(L, given))) return;
    if (given == columns) lua_newtable(L);
    lua::push_copy(L, columns + 1);
    const int joined = lua_gettop(L);
    if (run) {
        lua_pushvalue(L, 1);
        lua_rawseti(L, joined, 1);
    }
    for (lua_Integer curve = 1; !run && curve <= std::max<lua_Integer>(several, 1); ++curve) {
        lua_createtable(L, 2, 0);
        lua_pushvalue(L, 1);
        lua_rawseti(L, -2, 1);
        several > 0 ? static_cast<void>(lua_rawgeti(L, 2, curve)) : lua_pushvalue(L, 2);
        lua_rawseti(L, -2, 2);
        lua_rawseti(L, joined, curve);
    }
    lua_replace(L, 1);
    lua_settop(L, 1);
}

}  // namespace

motion::BetweenRows between_rows(const LuaRun& run) {
    const model::Excitation* M = nullptr;
    if (run.of_body()) M = run.terms ? &*run.terms : &run.origin->drive.loads[run.place()];
    const bool of_state =
        // whether theta and velocity determine M
        run.origin && run.system().is_plain() && run.origin->drive.states.empty();
    const bool known = M != nullptr && model::is_whole(run.result.outcome) && !model::has_memory(*M) &&
                       (of_state || !M->has_feedback());
    return {run.result, known ? M : nullptr};
}

std::shared_ptr<const motion::Run> drawn_run(lua_State* L, const RunHandle& run, const std::vector<double>& window) {
    RunCall call(L, *run);  // M may call user functions
    const motion::Run& whole = run->result;
    const motion::BetweenRows between = between_rows(*run);
    if (!between.any()) return {run, &whole};
    double from = whole.t_start, to = whole.t_stop;
    if (window.size() == 2 && window[0] < to && window[1] > from) {
        from = std::max(from, window[0]);
        to = std::min(to, window[1]);
    }
    const motion::Monitor monitor = [](double) { return !lua::interrupt_requested(); };
    auto drawn = std::make_shared<const motion::Run>(between.drawn(from, to, monitor));
    if (lua::interrupt_requested()) lua::raise_interrupted(L);
    call.check();
    return drawn;
}

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
                       .culprit = "nil"});  // nil values are absent from a table
    }
    constexpr std::size_t most_curves = 1000;
    if (items.curves.size() > most_curves) {
        lua::fail(L, "plot",
                  "{} curves are too many, {} can be drawn; one curve may have pieces with 0/0 (nan) "
                  "between them",
                  items.curves.size(), most_curves);
    }
    lua::push_copy(L, 1, static_cast<lua_Integer>(lua_rawlen(L, 1)));
    lua_replace(L, 1);
    if (items.panels.empty()) {
        const lua::Options options(L, 1, plot_call);
        plots::Figure figure;
        figure.curves = std::move(items.curves);
        if (items.run) {
            const model::Units& units = units_of(*items.run);
            figure.x.label = model::name_with_unit("t", units.t);
            figure.y.label = model::name_with_unit("theta", units.theta);
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
        options.fail(text::error("{} pictures side by side are too many, {} fit", items.panels.size(), most));
    }
    return deliver(L, options, std::move(items.panels));
}

namespace {

/// The parts in drawing order: bodies along their links, then the links.
std::vector<RunHandle> parts_to_draw(const RunHandle& run) {
    const std::vector<RunHandle> parts = parts_of(run);
    const model::System& system = run->system();
    std::vector<std::pair<std::size_t, std::size_t>> links;
    for (std::size_t j = system.bodies.size(); j < system.joints.size(); ++j) {
        links.emplace_back(system.joints[j].first(), system.joints[j].of.back().body);
    }
    std::vector<RunHandle> ordered;
    for (const std::size_t body : plots::neighbours(system.bodies.size(), links)) ordered.push_back(parts[body]);
    for (std::size_t j = system.bodies.size(); j < parts.size(); ++j) ordered.push_back(parts[j]);
    return ordered;
}

/// Figures of all bodies' angles, one below the other, and of links with friction, with bars where they stick.
std::vector<plots::Figure> angles_of_all(lua_State* L, const lua::Options& options, const RunHandle& run) {
    std::vector<plots::Figure> figures;
    for (const RunHandle& part : parts_to_draw(run)) {
        const model::Joint& joint = part->system().joints[part->place()];
        if (!part->of_body() && joint.friction.none()) continue;
        std::vector<plots::Figure> own = options.value_or_fail(
            plots::column_figures(data_of(L, options, part, options.numbers("xlim")), {.ys = {"theta"}}));
        own.front().y.label = joint.name + " " + own.front().y.label;
        own.front().below = !figures.empty();
        figures.push_back(std::move(own.front()));
    }
    return figures;
}

}  // namespace

int plot_run(lua_State* L) {
    RunHandle run = lua::self<RunHandle>(L, 1, "run:plot()");
    const lua::Options options(L, 2, plot_run_call);
    const bool usual = run->of_all() && !options.has("x") && !options.has("y");
    if (usual && run->system().joints.size() == 1) {
        run = part_of(run, 0);
    } else if (usual) {
        std::vector<plots::Figure> figures = angles_of_all(L, options, run);
        apply_options(L, options, figures);
        return deliver(L, options, std::move(figures));
    }
    const std::vector<std::string> x = asked_columns(L, options, "x", run);
    if (x.size() > 1) {
        options.fail("x", "x must be one column");
    }
    const std::vector<std::string> ys = asked_columns(L, options, "y", run);
    const bool over_time = x.empty() || x.front() == "t";
    const plots::RunData data = data_of(L, options, run, over_time ? options.numbers("xlim") : std::vector<double>());
    // One label means one axis.
    const plots::Axes axes = options.has("ylabel") ? plots::Axes::one : plots::Axes::one_a_unit;
    std::vector<plots::Figure> figures = options.value_or_fail(plots::column_figures(
        data,
        {.x = x.empty() ? "" : x.front(), .ys = ys, .labels = asked_labels(L, options, ys.size()), .axes = axes}));
    apply_options(L, options, figures);
    return deliver(L, options, std::move(figures));
}

int phase_plot_run(lua_State* L) {
    const RunHandle run = lua::self<RunHandle>(L, 1, "run:phase_plot()");
    const lua::Options options(L, 2, phase_plot_call);
    if (run->origin && !(run->system().joints.size() == 1 && run->system().joints.front().is_plain())) {
        options.fail(
            text::error("the phase plane is that of a system of one body with constant Rd and Re; use run{}:plot{{ x = "
                        "\"theta\", y = \"velocity\" }}",
                        run->of_all() ? "." + run->system().joints.front().name : ""));
    }
    plots::Figure figure = options.value_or_fail(plots::phase_figure(data_of(L, options, part_of(run, 0))));
    apply_options(L, options, figure);
    std::vector<plots::Figure> figures{std::move(figure)};
    return deliver(L, options, std::move(figures));
}

const lua::Class plot_functions = {
    "plot",
    {"plot{ { x, y }, ... }", "Draws vectors; run:plot and run:phase_plot draw runs.",
     "t = vector.linspace(0, 1, 50)\nprint(plot{ { t, (6*t):sin() }, show = false } ~= nil)  --> true"},
    plot_module_members,
    lua::add_functions};

const lua::Class picture_class = {
    "picture",
    {"plot{ ..., show = false }, run:plot{ show = false } -> picture",
     "A picture that is not drawn yet: print(picture) shows it, and plot{ left, right, file = \"both.svg\" } "
     "draws pictures side by side.",
     "run = nondimensional{}:simulate{ theta0 = 1, t_end = 2, dt = 0.01 }\n"
     "both = plot{ run:plot{ show = false }, run:phase_plot{ show = false }, show = false }\n"
     "print(#tostring(both) > 1000)  --> true"},
    picture_members,
    lua::add_class<Picture>};

namespace {

plots::Interval asked_range(const lua::Options& options, std::string_view name, const std::vector<double>& ends,
                            bool logarithmic) {
    if (ends.size() != 2 || !(ends[0] < ends[1])) {
        options.fail(name, "{} must be two increasing numbers such as {{ 0, 10 }}", name);
    }
    if (logarithmic && ends[0] <= 0) {
        options.fail(name, "{} = {{ {:.6g}, {:.6g} }} must be positive on a logarithmic axis", name, ends[0], ends[1]);
    }
    // Fractions of an axis this long or this short cannot be computed.
    if (!(ends[1] - ends[0] <= 1e300) || ends[1] - ends[0] < plots::shortest_axis ||
        ends[1] - ends[0] < 1e-13 * std::max(std::fabs(ends[0]), std::fabs(ends[1]))) {
        options.fail(name,
                     "{} = {{ {}, {} }} cannot be drawn: its ends must differ by more than 1e-13 of "
                     "their size, by more than 1e-305 and by less than 1e300",
                     name, ends[0], ends[1]);
    }
    return {ends[0], ends[1]};
}

/// xticks = 0.5: ticks at multiples of it; xticks = { 0, 1, 4 }: ticks at these values.
void set_ticks(lua_State* L, const lua::Options& options, std::string_view name, plots::Axis& axis) {
    if (!options.has(name)) {
        return;
    }
    options.push(name);
    const bool is_number = lua_type(L, -1) == LUA_TNUMBER;
    lua_pop(L, 1);
    if (!is_number) {
        axis.ticks = options.numbers(name);
        return;
    }
    axis.division = options.number(name);
    if (axis.logarithmic) {
        options.fail(name, "{} must be a list of numbers such as {{ 0.1, 1, 10 }} on a logarithmic axis", name);
    }
}

/// The width of the screen within readable limits, and a height that leaves the typed line visible.
plots::TextFormat asked_format(const TargetOptions& asked, bool phase) {
    const terminal::Display seen = terminal::display_of(STDOUT_FILENO);
    constexpr int widest = 120;
    plots::TextFormat format;
    format.columns = asked.width.value_or(std::clamp(seen.columns - 1, 20, widest));
    format.rows = asked.height.value_or(std::clamp(seen.rows - 2, 10, phase ? 40 : 24));
    format.charset = asked.ascii.value_or(!seen.draws) ? plots::Charset::ascii : plots::Charset::braille;
    format.colours = seen.colour;
    return format;
}

plots::PaperSize asked_size(const lua::Options& options, const TargetOptions& asked) {
    if (!asked.size) {
        return {};
    }
    const std::vector<double>& size = *asked.size;
    if (size.size() != 2 || *std::ranges::min_element(size) < 2 || *std::ranges::max_element(size) > 100) {
        options.fail("size", "size must be width and height in cm, each from 2 to 100, such as { 8.5, 6 }");
    }
    return {size[0], size[1]};
}

enum class FileKind { svg, png, pdf, txt };  // the first three are in the order of plots::PictureKind

FileKind kind_of(const lua::Options& options, std::string_view file) {
    constexpr std::array<std::string_view, 4> endings{".svg", ".png", ".pdf", ".txt"};
    const auto* const known = std::ranges::find(endings, text::ending_of(file));
    if (known == endings.end()) {
        options.fail({.sentence = fmt::format("the name '{}' must end in .svg, .png, .pdf or .txt", file),
                      .option = "file",
                      .culprit = std::string(file)});
    }
    return static_cast<FileKind>(known - endings.begin());
}

text::Expected<std::string> content(const std::vector<plots::Figure>& figures, FileKind kind, plots::PaperSize size,
                                    plots::TextFormat format) {
    if (kind == FileKind::txt) {
        format.colours = false;
        return plots::text_plot(figures, format);
    }
    return plots::paint(figures, static_cast<plots::PictureKind>(kind), size,
                        [] { return !lua::interrupt_requested(); });
}

void write_picture(lua_State* L, const lua::Options& options, const TargetOptions& asked,
                   const std::vector<plots::Figure>& figures, const plots::TextFormat& format) {
    const FileKind kind = kind_of(options, *asked.file);
    const bool is_text = kind == FileKind::txt;
    for (const char* option : {"width", "height", "ascii"}) {
        if (is_text || !options.has(option)) continue;
        options.fail(
            option,
            "{} is for text, in the terminal or a .txt file; a file of this kind takes size = {{ 15, 10 }} (cm)",
            option);
    }
    if (is_text && asked.size)
        options.fail("size", "size is for .svg, .png and .pdf; give width and height for a .txt file");
    const plots::PaperSize size = asked_size(options, asked);
    // created before the work, so that errors come early
    files::OutputFile file = options.value_or_fail(files::OutputFile::create(*asked.file));
    const auto bytes = content(figures, kind, size, format);
    if (lua::interrupt_requested()) {
        lua::raise_interrupted(L);
    }
    file.write(options.value_or_fail(bytes));
    options.value_or_fail(file.commit());
}

/// The memory that figures may keep alive outside of Lua.
std::size_t bytes_of(const std::vector<plots::Figure>& figures) {
    std::size_t numbers = 0;
    for (const plots::Figure& figure : figures) {
        for (const plots::Curve& curve : figure.curves) {
            numbers += curve.x.values.size() + curve.y.values.size();
        }
    }
    return numbers * sizeof(double);
}

/// Raises an error if the user's ticks are too many to be legible.
void check_ticks(const lua::Options& options, std::string_view name, const plots::Axis& axis,
                 const plots::Scale& scale) {
    constexpr double most = 200;
    const double count =
        axis.division ? scale.range().length() / *axis.division : static_cast<double>(axis.ticks.size());
    if (count > most) {
        options.fail(name, "{} makes {:.3g} ticks from {:.6g} to {:.6g}, more than {:.0f}: give a larger distance",
                     name, count, scale.range().low, scale.range().high, most);
    }
}

PictureViewer picture_viewer = nullptr;

}  // namespace

void show_pictures_by(PictureViewer viewer) {
    picture_viewer = viewer;
}

text::Expected<std::string> svg_of(const Picture& picture) {
    auto svg = content(picture.figures, FileKind::svg, {}, picture.format);
    if (!svg) return svg;
    return plots::element_of(std::move(svg).value());
}

void apply_options(lua_State* L, const lua::Options& options, plots::Figure& figure) {
    FigureOptions asked;
    options.fill(asked);
    figure.title = asked.title.value_or(figure.title);
    figure.x.label = asked.xlabel.value_or(figure.x.label);
    figure.y.label = asked.ylabel.value_or(figure.y.label);
    figure.y.names_curves = figure.y.names_curves && !asked.ylabel;
    figure.x.logarithmic = asked.xlog.value_or(figure.x.logarithmic);
    figure.y.logarithmic = asked.ylog.value_or(figure.y.logarithmic);
    if (asked.xlim) {
        figure.x.limits = asked_range(options, "xlim", *asked.xlim, figure.x.logarithmic);
    }
    if (asked.ylim) {
        figure.y.limits = asked_range(options, "ylim", *asked.ylim, figure.y.logarithmic);
    }
    set_ticks(L, options, "xticks", figure.x);
    set_ticks(L, options, "yticks", figure.y);
    figure.equal = asked.equal.value_or(figure.equal);
    figure.axes = asked.axes.value_or(figure.axes);
    figure.ends = asked.ends;
    if (options.has("xticks") || options.has("yticks")) {
        const plots::View view = plots::view_of(figure);
        check_ticks(options, "xticks", figure.x, view.x);
        check_ticks(options, "yticks", figure.y, view.y);
    }
    if (figure.equal && (figure.x.logarithmic || figure.y.logarithmic)) {
        options.fail("equal", "equal = true needs linear axes: leave out xlog and ylog");
    }
}

void apply_options(lua_State* L, const lua::Options& options, std::vector<plots::Figure>& figures) {
    for (plots::Figure& figure : figures) {
        apply_options(L, options, figure);
        if (&figure != &figures.front()) figure.title.clear();
        if (&figure != &figures.back()) figure.x.label.clear();
    }
    if (figures.size() > 1) {
        for (const char* name : {"ylim", "yticks", "ylog", "equal"}) {
            if (options.has(name)) {
                options.fail(name,
                             "{} is for one unit, and these columns have {}: give ylabel to draw them on one axis, or "
                             "draw them one by one",
                             name, figures.size());
            }
        }
    }
}

int deliver(lua_State* L, const lua::Options& options, std::vector<plots::Figure> figures) {
    const bool phase = std::ranges::any_of(figures, [](const plots::Figure& figure) { return figure.equal; });
    TargetOptions asked;
    options.fill(asked);
    if (asked.show || asked.file) lua::refuse_in_worker(L, "a plot");
    const plots::TextFormat format = asked_format(asked, phase);
    if (asked.file) {
        if (!asked.show) {
            options.fail("show", "file and show = false exclude each other");
        }
        write_picture(L, options, asked, figures, format);
        if (picture_viewer != nullptr) picture_viewer({std::move(figures), format}, Shown::in_file);
        return 0;
    }
    if (asked.size) {
        options.fail("size", "size is for files; give width and height for a picture in the terminal");
    }
    if (!asked.show) {
        const std::size_t bytes = bytes_of(figures);
        lua::push(L, Picture{std::move(figures), format});
        lua::note_external_memory(L, bytes);
        return 1;
    }
    if (picture_viewer != nullptr) {
        picture_viewer({std::move(figures), format}, Shown::here);
        return 0;
    }
    const std::string text = plots::text_plot(figures, format);
    lua_writestring(text.data(), text.size());  // Lua's own output, as in print()
    return 0;
}

std::string text_of_picture(const Picture& picture) {
    plots::TextFormat format = picture.format;
    format.colours = false;
    std::string text = plots::text_plot(picture.figures, format);
    if (text.ends_with('\n')) {
        text.pop_back();
    }
    return text;
}

}  // namespace dinal::api
