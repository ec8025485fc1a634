// d:plot{ ... }: columns over a column, maps, and what data bring along to be drawn with them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "api/data.hpp"
#include "api/data_docs.hpp"
#include "api/picture.hpp"
#include "lua/options.hpp"
#include "plots/figure.hpp"
#include "plots/run_figure.hpp"
#include "plots/shades.hpp"

namespace dinal::api::data_functions {
namespace {

// ---- maps: a column in shades over the grid of two others

constexpr int vermilion = 2;  // is seen on the dark and on the bright end

/// Has a place on the axis.
bool is_drawn(double value, bool logarithmic) {
    return std::fabs(value) <= 1e300 && (value > 0 || !logarithmic);
}

/// The different values, increasing.
std::vector<double> different_values(std::span<const double> all, bool logarithmic) {
    std::vector<double> values;
    std::copy_if(all.begin(), all.end(), std::back_inserter(values),
                 [logarithmic](double v) { return is_drawn(v, logarithmic); });
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

std::size_t place_among(const std::vector<double>& values, double value) {
    return static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), value) - values.begin());
}

plots::Shades shades_of(const lua::Options& options, const std::array<std::string, 3>& names,
                        const std::array<plots::Numbers, 3>& columns) {
    const auto [x, y, z] = std::array{columns[0].values, columns[1].values, columns[2].values};
    const auto is_asked = [&](const char* name) {
        return options.has(name) && std::get<bool>(options.value(options.row(name)));
    };
    const bool xlog = is_asked("xlog"), ylog = is_asked("ylog");
    plots::Shades shades{.x = different_values(x, xlog), .y = different_values(y, ylog), .z = {}, .label = names[2]};
    constexpr double sparse = 16;  // places for a row: what is scattered has no neighbours
    const double places = static_cast<double>(shades.x.size()) * static_cast<double>(shades.y.size());
    if (shades.x.empty() || shades.y.empty() || places > sparse * static_cast<double>(z.size())) {
        options.fail({.sentence = fmt::format(
                          "{} and {} form no grid: {} rows have {} different values of {} and {} of {}", names[0],
                          names[1], z.size(), shades.x.size(), names[0], shades.y.size(), names[1]),
                      .option = "z"});
    }
    shades.z.assign(shades.x.size() * shades.y.size(), std::numeric_limits<double>::quiet_NaN());
    std::vector<bool> filled(shades.z.size());
    for (std::size_t row = 0; row < z.size(); ++row) {
        if (!is_drawn(x[row], xlog) || !is_drawn(y[row], ylog)) continue;
        const std::size_t place = place_among(shades.y, y[row]) * shades.x.size() + place_among(shades.x, x[row]);
        if (filled[place]) {
            options.fail({.sentence = fmt::format("there are two rows with {} = {:.6g}, {} = {:.6g}: pick one, as with "
                                                  "d:filter",
                                                  names[0], x[row], names[1], y[row]),
                          .option = "z"});
        }
        filled[place] = true;
        shades.z[place] = z[row];
    }
    return shades;
}

/// Of x, y and z, with zlim and contours as the options say. Fails when x and y form no grid.
plots::Figure figure_of_map(const lua::Options& options, const std::array<std::string, 3>& names,
                            const std::array<plots::Numbers, 3>& columns) {
    plots::Shades shades = shades_of(options, names, columns);
    if (options.has("zlim")) {
        const std::vector<double> ends = options.numbers("zlim");
        if (ends.size() != 2 || !(ends[0] < ends[1])) {
            options.fail("zlim", "zlim must be two increasing numbers such as { 0, 10 }");
        }
        shades.limits = plots::Interval{ends[0], ends[1]};
    }
    plots::Figure figure;
    figure.x.label = names[0];
    figure.y.label = names[1];
    constexpr std::size_t most_contours = 20;
    const std::vector<double> levels = options.numbers("contours");
    if (levels.size() > most_contours) {
        options.fail("contours",
                     fmt::format("{} contours are too many, {} can be told apart", levels.size(), most_contours));
    }
    for (const double level : levels) {
        plots::Curve line = plots::contour(shades, level);
        line.label = fmt::format("{} = {:.6g}", names[2], level);
        line.colour = vermilion;
        figure.curves.push_back(std::move(line));
    }
    figure.shades = std::make_shared<const plots::Shades>(std::move(shades));
    return figure;
}

/// Of the branches of a response at one place a map shows the stable one with the greatest z.
std::array<plots::Numbers, 3> stable_rows(const Data& data, const std::array<plots::Numbers, 3>& columns) {
    const DataColumn* stable = data.pieces_of.empty() ? nullptr : data.find(data.dotted_of);
    if (stable == nullptr || stable->numbers() == nullptr) return columns;
    std::map<std::pair<double, double>, double> shown;
    for (std::size_t row = 0; row < columns[2].values.size(); ++row) {
        if (stable->numbers()->begin()[row] == 0) continue;
        const double z = columns[2].values[row];
        const auto place = shown.try_emplace({columns[0].values[row], columns[1].values[row]}, z).first;
        if (z > place->second) place->second = z;
    }
    std::array<std::vector<double>, 3> rows;
    for (const auto& [place, z] : shown) {
        rows[0].push_back(place.first);
        rows[1].push_back(place.second);
        rows[2].push_back(z);
    }
    return {plots::Numbers::own(std::move(rows[0])), plots::Numbers::own(std::move(rows[1])),
            plots::Numbers::own(std::move(rows[2]))};
}

// ---- curves

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
    return column != nullptr ? model::of_unit(plots::symbol_for(name), column->unit) : name;
}

constexpr double spectrum_decades = 1e-6;  // of the largest amplitude, that a plot of a spectrum shows

/// The frequencies at which a spectrum is that high, if it is lower at a good part of the others.
std::optional<plots::Interval> telling_frequencies(const Data& data, const plots::Curve& curve) {
    if (!data.is_spectrum || curve.size() == 0) return std::nullopt;
    double greatest = 0, last = 0;
    for (const double y : curve.y.values) greatest = y > greatest ? y : greatest;
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (curve.y.values[i] > spectrum_decades * greatest) last = curve.x.values[i];
    }
    constexpr double room = 1.2, good_part = 0.8;
    const double end = curve.x.values[curve.size() - 1];
    return last > 0 && room * last < good_part * end ? std::optional(plots::Interval{0, room * last}) : std::nullopt;
}

/// What is seen of a curve that says little in its full height: six decades of a spectrum, and of a response no more
/// than some times what most of it reaches, since near a pole it has no bound.
std::optional<plots::Interval> telling_limits(const Data& data, const plots::Curve& curve) {
    std::vector<double> values;
    std::copy_if(curve.y.values.begin(), curve.y.values.end(), std::back_inserter(values),
                 [](double y) { return std::isfinite(y); });
    if (values.empty() || (!data.is_spectrum && data.pieces_of.empty())) return std::nullopt;
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    const plots::Interval all{*least, *greatest};
    if (data.is_spectrum) {
        return all.high > 0 && all.low < spectrum_decades * all.high
                   ? std::optional(plots::Interval{spectrum_decades * all.high, 2 * all.high})
                   : std::nullopt;
    }
    constexpr double most = 0.9, much_higher = 10, shown = 4;
    const auto place = static_cast<std::ptrdiff_t>(most * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    const double usual = values[static_cast<std::size_t>(place)];
    return usual > 0 && all.high > much_higher * usual
               ? std::optional(plots::Interval{std::min(0.0, all.low), shown * usual})
               : std::nullopt;
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
    const bool curves = !y.empty() || options.has("style");
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
        if (options.has("style")) options.fail("style", "style is for curves: leave it out, or z");
        if (z.size() > 1) options.fail("z", "z must be one column");
        if (options.has("y") && y.size() > 1) options.fail("y", "y must be one column where z is drawn over x and y");
        std::vector<plots::Figure> map{figure_of_map(
            options, {x.front(), y.front(), z.front()},
            stable_rows(*data, {drawn(L, *data, x.front()), drawn(L, *data, y.front()), drawn(L, *data, z.front())}))};
        map.front().x.label = label_of(*data, x.front());
        map.front().y.label = label_of(*data, y.front());
        for (const std::string& name : asked_names(L, options, "overlay")) {
            map.front().curves.push_back(overlay_curve(options, *data, name, x.front(), y.front()));
            map.front().curves.back().colour = vermilion;
        }
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
        const std::string pieces = over.size() == 2 && data->pieces_of.empty() ? over[0] : data->pieces_of;
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
    figure.y.logarithmic = data->is_spectrum;
    if (y.size() == 1) {
        figure.x.limits = telling_frequencies(*data, curve);
        figure.y.limits = telling_limits(*data, curve);
    }
    apply_options(L, options, figure);
    if (!options.has("ylim") && figure.y.logarithmic != data->is_spectrum) figure.y.limits.reset();
    if (!options.has("xlim") && figure.x.logarithmic) figure.x.limits.reset();
    std::vector<plots::Figure> figures{std::move(figure)};
    return deliver(L, options, std::move(figures));
}

}  // namespace dinal::api::data_functions
