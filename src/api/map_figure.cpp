#include "api/map_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "plots/shades.hpp"

namespace dinal::api {
namespace {

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

}  // namespace

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
        constexpr int vermilion = 2;  // is seen on the dark and on the bright end
        line.colour = vermilion;
        figure.curves.push_back(std::move(line));
    }
    figure.shades = std::make_shared<const plots::Shades>(std::move(shades));
    return figure;
}

}  // namespace dinal::api
