#include "plots/animation/text_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "plots/ticks.hpp"
#include "text/characters.hpp"

namespace dinal::plots::animation {
namespace {

struct FrameSigns {
    std::string_view mass, stuck, anchor, wall, coil[2], surface[4];
};

constexpr FrameSigns of_unicode{"█", "▓", "▐", "▌", {"/", "\\"}, {"─", "─", "─", "╱"}};
constexpr FrameSigns of_ascii{"#", "X", "|", "|", {"/", "\\"}, {"-", "-", "-", "/"}};

/// A row of cells, each one column wide.
class Row {
public:
    explicit Row(int columns) : cells_(static_cast<std::size_t>(std::max(columns, 0)), " ") {}
    void put(int column, std::string_view sign) {
        if (column >= 0 && column < static_cast<int>(cells_.size())) cells_[static_cast<std::size_t>(column)] = sign;
    }
    void fill(int from, int to, std::string_view sign) {
        for (int column = from; column < to; ++column) put(column, sign);
    }
    void write(int column, std::string_view ascii) {
        for (std::size_t i = 0; i < ascii.size(); ++i) put(column + static_cast<int>(i), ascii.substr(i, 1));
    }
    [[nodiscard]] std::string text() const {
        std::string all;
        for (const std::string_view cell : cells_) all += cell;
        all.erase(all.find_last_not_of(' ') + 1);
        return all;
    }

private:
    std::vector<std::string_view> cells_;
};

/// The columns of a line: the spring's anchor, the middle of the mass at both ends of its reach.
struct Places {
    int mass, first, last;
    [[nodiscard]] double middle(double part) const { return first + part * (last - first); }
};

Places places_of(const Scene& scene, int columns) {
    constexpr int narrow = 40;
    const int mass = columns < narrow ? 3 : 5;
    const int shortest_spring = columns < narrow ? 4 : 8;
    const int first = (scene.spring ? shortest_spring : 1) + mass / 2 + 1;
    return {mass, first, std::max(first + 1, columns - 2 - mass / 2)};
}

std::string status(const Scene& scene, const Frame& frame, const FrameFormat& format) {
    const double step = (scene.frames.back().t - scene.frames.front().t) / static_cast<double>(scene.frames.size() - 1);
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(std::max(step, 1e-12)) - 1e-9)), 0, 9);
    const std::string t_unit = scene.t_unit.empty() ? "" : " " + scene.t_unit;
    const std::string line =
        fmt::format("{}{}t = {:.{}f}{}  θ = {:+.3g} {}  {}", scene.name, scene.name.empty() ? "" : "  ", frame.t,
                    digits, t_unit, frame.theta, scene.theta_unit, frame.stuck ? "stuck" : "");
    const std::string clean = text::displayable(line);
    std::string shown = format.charset == Charset::braille ? clean : text::in_ascii(clean);
    if (text::columns(shown) <= static_cast<std::size_t>(format.columns)) return shown;
    const std::string brief =
        fmt::format("{:.{}f} {:+.2g} {}", frame.t, digits, frame.theta, frame.stuck ? "stuck" : "");
    return std::string(text::cut_to_columns(brief, static_cast<std::size_t>(format.columns)));
}

std::string scale_line(const Scene& scene, const Places& places, int columns) {
    const Scale scale(scene.reach, false);
    const Ticks ticks = ticks_of({}, scale, std::max(1, (places.last - places.first) / 10));
    Row row(columns);
    int free = 0;
    for (std::size_t i = 0; i < ticks.at.size(); ++i) {
        const std::string& text = ticks.text[i];
        const int length = static_cast<int>(text.size());
        const int column = nearest_dot(places.middle(scene.at(ticks.at[i]))) - length / 2;
        if (column < free || column + length > columns) continue;
        row.write(column, text);
        free = column + length + 1;
    }
    return row.text();
}

}  // namespace

std::vector<std::string> text_frame(const Scene& scene, const Frame& frame, const FrameFormat& format) {
    const FrameSigns& signs = format.charset == Charset::braille ? of_unicode : of_ascii;
    const int columns = std::max(format.columns, 12);
    const Places places = places_of(scene, columns);
    const int left = nearest_dot(places.middle(scene.at(frame.theta))) - places.mass / 2;
    Row upper(columns), lower(columns), surface(columns);
    if (scene.spring) {
        upper.put(0, signs.anchor);
        lower.put(0, signs.anchor);
        for (int column = 1; column < left; ++column) lower.put(column, signs.coil[column % 2]);
    }
    if (scene.walls) {
        // The spring goes past the lower wall.
        const int half = places.mass / 2 + 1;
        if (std::isfinite(scene.walls->lower)) {
            upper.put(nearest_dot(places.middle(scene.at(scene.walls->lower))) - half, signs.wall);
        }
        if (std::isfinite(scene.walls->upper)) {
            const int column = nearest_dot(places.middle(scene.at(scene.walls->upper))) + half;
            upper.put(column, signs.wall);
            lower.put(column, signs.wall);
        }
    }
    for (Row* row : {&upper, &lower}) row->fill(left, left + places.mass, frame.stuck ? signs.stuck : signs.mass);
    const int shift = nearest_dot(scene.shift(frame) * (places.last - places.first));
    for (int column = 0; column < columns; ++column) {
        surface.put(column, signs.surface[static_cast<std::size_t>(((column - shift) % 4 + 4) % 4)]);
    }
    std::vector<std::string> lines{status(scene, frame, {columns, format.charset, false}), upper.text(), lower.text(),
                                   surface.text(), scale_line(scene, places, columns)};
    if (format.colours && frame.stuck) lines[0] = "\x1b[33m" + lines[0] + "\x1b[0m";
    return lines;
}

}  // namespace dinal::plots::animation
