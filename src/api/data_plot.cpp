// d:plot{ ... }: columns over a column, maps, and what data bring along to be drawn with them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "api/data.hpp"
#include "api/data_docs.hpp"
#include "api/map_figure.hpp"
#include "api/picture.hpp"
#include "lua/options.hpp"

namespace dinal::api::data_functions {
namespace {

/// The names that stand under `option`: one or a list of them.
std::vector<std::string> asked_names(lua_State* L, const lua::Options& options, const char* option) {
    std::vector<std::string> names;
    options.push(option);
    const int place = lua_gettop(L);
    if (lua_type(L, place) == LUA_TSTRING) {
        names.emplace_back(lua_tostring(L, place));
    } else if (lua_istable(L, place) && lua_rawlen(L, place) > 0) {
        for (lua_Integer i = 1; i <= static_cast<lua_Integer>(lua_rawlen(L, place)); ++i) {
            if (lua_rawgeti(L, place, i) != LUA_TSTRING) {
                options.fail(option, fmt::format("{}[{}] must be the name of a column, got {}", option, i,
                                                 lua::describe(L, -1)));
            }
            names.emplace_back(lua_tostring(L, -1));
            lua_pop(L, 1);
        }
    } else if (!lua_isnil(L, place)) {
        options.wrong(option, "the name of a column or a list of them");
    }
    lua_pop(L, 1);
    return names;
}

plots::Numbers drawn(lua_State* L, const Data& data, const std::string& name) {
    const DataColumn& column = column_or_fail(L, data, "d:plot", name);
    if (column.numbers() == nullptr) {
        lua::raise(L, {.sentence = fmt::format("d:plot: the column '{}' holds words, not numbers", name),
                       .call = "d:plot",
                       .culprit = name});
    }
    const auto kept = std::make_shared<const lua::Vector>(*column.numbers());
    return {kept, kept->values()};
}

std::string label_of(const Data& data, const std::string& name) {
    const DataColumn* column = data.find(name);
    return column != nullptr ? column->label() : name;
}

/// The line broken where its data are, and a dotted one of what is unstable.
std::vector<plots::Curve> curve_in_pieces(const Data& data, const std::string& pieces, const plots::Curve& whole) {
    constexpr double gap = std::numeric_limits<double>::quiet_NaN();
    const auto numbers_of = [&data](const std::string& name) -> const lua::Vector* {
        const DataColumn* column = data.find(name);
        return column != nullptr ? column->numbers() : nullptr;
    };
    const lua::Vector* piece = numbers_of(pieces);
    const lua::Vector* solid = numbers_of(data.dotted_of);
    std::array<std::vector<double>, 2> x, y;  // of the dotted line, of the other one
    std::array<bool, 2> any{};
    std::size_t before = 1;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const std::size_t line = solid == nullptr || solid->begin()[i] != 0 ? 1 : 0;
        const bool new_piece = i > 0 && piece != nullptr && piece->begin()[i] != piece->begin()[i - 1];
        const auto put = [&](std::size_t of, double px, double py) {
            x[of].push_back(px);
            y[of].push_back(py);
        };
        if (i > 0 && (new_piece || line != before)) {
            put(before, gap, gap);
            // The one goes on where the other ends.
            if (!new_piece) put(line, whole.x.values[i - 1], whole.y.values[i - 1]);
        }
        put(line, whole.x.values[i], whole.y.values[i]);
        any[line] = true;
        before = line;
    }
    std::vector<plots::Curve> curves;
    for (const std::size_t line : {std::size_t{1}, std::size_t{0}}) {
        if (!any[line]) continue;
        plots::Curve curve = whole;
        curve.x = plots::Numbers::own(std::move(x[line]));
        curve.y = plots::Numbers::own(std::move(y[line]));
        if (line == 0) {
            curve.dashes = plots::Dashes::dotted;
            curve.label = "unstable";
        } else if (any[0] && curve.label.empty()) {
            curve.label = "stable";
        }
        curves.push_back(std::move(curve));
    }
    return curves;
}

/// What data bring along, as a curve of the same columns.
plots::Curve overlay_curve(const lua::Options& options, const Data& data, const std::string& name, const std::string& x,
                           const std::string& y) {
    const DataCompanion* companion = data.companion(name);
    if (companion == nullptr) {
        std::vector<std::string_view> names;
        for (const DataCompanion& known : data.companions) names.emplace_back(known.name);
        options.fail({.sentence = names.empty()
                                      ? fmt::format("these data have no overlay '{}', nor any other", name)
                                      : fmt::format("there is no overlay '{}' among {}", name, fmt::join(names, ", ")),
                      .option = "overlay",
                      .culprit = name,
                      .cure = text::did_you_mean(name, names)});
    }
    const Data drawn = companion->drawn ? companion->drawn() : companion->made();
    plots::Curve curve;
    for (const auto& [column, numbers] : {std::pair(&x, &curve.x), std::pair(&y, &curve.y)}) {
        const DataColumn* found = drawn.find(*column);
        if (found == nullptr || found->numbers() == nullptr) {
            options.fail({.sentence = fmt::format("the overlay '{}' has no {}", name, *column), .option = "overlay"});
        }
        const std::span<const double> values = found->numbers()->values();
        *numbers = plots::Numbers::own({values.begin(), values.end()});
    }
    curve.label = name;
    return curve;
}

/// Those that are not the same in all rows.
std::vector<std::string> different_parameters(const Data& data) {
    std::vector<std::string> names;
    for (const std::string& name : data.parameters) {
        const DataColumn* column = data.find(name);
        if (column == nullptr) continue;
        const auto differ = [](const auto& values) {
            return std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) != values.end();
        };
        const lua::Vector* numbers = column->numbers();
        if (numbers != nullptr ? differ(*numbers) : differ(*std::get<Words>(column->values))) names.push_back(name);
    }
    return names;
}

/// The columns of numbers that are neither x nor parameters of a grid.
std::vector<std::string> drawable_results(const Data& data, const std::string& x) {
    std::vector<std::string> names;
    for (const DataColumn& column : data.columns) {
        const bool given =
            std::find(data.parameters.begin(), data.parameters.end(), column.name) != data.parameters.end();
        if (!given && column.name != x && column.numbers() != nullptr) names.push_back(column.name);
    }
    return names;
}

}  // namespace

int plot(lua_State* L) {
    const DataHandle data = self(L, "d:plot{ x = \"r\", y = \"A\" }");
    const lua::Options options(L, 2, plot_data_call);
    std::vector<std::string> x = asked_names(L, options, "x"), y = asked_names(L, options, "y");
    if (x.size() > 1) options.fail("x", "x must be one column");
    std::vector<std::string> z = asked_names(L, options, "z");
    // Points over two parameters are a map, of the first result where none is named, or a curve for each of the first.
    const std::vector<std::string> over = different_parameters(*data);
    const bool curves = !y.empty() || options.has("style") || options.has("overlay");
    const bool is_map = over.size() > 1 && (!z.empty() || (x.empty() && !curves));
    if (is_map && z.empty() && over.size() > 2) {
        options.fail(
            {fmt::format("points over {} are not a map: pick those of one {} with d:filter, or name x, y and z",
                         fmt::join(over, ", "), over.front())});
    }
    if (x.empty() && !over.empty()) x = {over.size() == 2 && !is_map ? over[1] : over[0]};
    if (x.empty()) x.push_back(data->points_over.empty() ? data->columns.front().name : data->points_over);
    const std::vector<std::string> results = drawable_results(*data, x.front());
    if (y.empty() && results.empty()) options.fail({"there is no other column of numbers to draw"});
    if (is_map && z.empty()) z = {results.front()};
    if (y.empty()) y = {is_map ? over[x.front() == over[1] ? 0 : 1] : results.front()};
    if (data->size() == 0) options.fail({"there are no rows to draw"});
    if (!z.empty()) {
        for (const char* option : {"style", "overlay"}) {
            if (options.has(option)) options.fail(option, fmt::format("{} is for curves: leave it out, or z", option));
        }
        if (z.size() > 1) options.fail("z", "z must be one column");
        if (options.has("y") && y.size() > 1) options.fail("y", "y must be one column where z is drawn over x and y");
        std::vector<plots::Figure> map{
            figure_of_map(options, {x.front(), y.front(), z.front()},
                          {drawn(L, *data, x.front()), drawn(L, *data, y.front()), drawn(L, *data, z.front())})};
        apply_options(L, options, map.front());
        return deliver(L, options, std::move(map));
    }
    for (const char* option : {"zlim", "contours"}) {
        if (!options.numbers(option).empty()) {
            options.fail(option, fmt::format("{} is for maps: name a column z, too", option));
        }
    }
    plots::Figure figure;
    figure.x.label = label_of(*data, x.front());
    plots::Curve curve;
    if (!data->points_of.empty() && !options.has("y") && x.front() != data->points_of) y = {data->points_of};
    const bool leaps = over.size() == 2 && x.front() == over[0];  // from row to row
    if (!data->points_of.empty() || leaps) curve.style = plots::Style::points;
    figure.y.label = y.size() == 1 ? label_of(*data, y.front()) : "";
    options.fill(curve);
    for (const std::string& name : y) {
        curve.x = drawn(L, *data, x.front());
        curve.y = drawn(L, *data, name);
        curve.label = y.size() == 1 ? "" : name;
        const std::string pieces = over.size() == 2 ? over[0] : data->pieces_of;
        if (pieces.empty() || curve.style != plots::Style::line) {
            figure.curves.push_back(curve);
        } else {
            for (plots::Curve& piece : curve_in_pieces(*data, pieces, curve)) figure.curves.push_back(std::move(piece));
        }
    }
    std::size_t overlays = 0;
    for (const std::string& name : asked_names(L, options, "overlay")) {
        if (figure.curves.front().label.empty()) figure.curves.front().label = label_of(*data, y.front());
        constexpr std::array<plots::Dashes, 3> dashes{plots::Dashes::dashed, plots::Dashes::dash_dotted,
                                                      plots::Dashes::dotted};
        figure.curves.push_back(overlay_curve(options, *data, name, x.front(), y.front()));
        figure.curves.back().dashes = dashes[overlays++ % dashes.size()];
    }
    apply_options(L, options, figure);
    std::vector<plots::Figure> figures{std::move(figure)};
    return deliver(L, options, std::move(figures));
}

}  // namespace dinal::api::data_functions
