#include "plots/animation/gif_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dinal::plots::animation {
namespace {

// Pixels of the sheet, from the lower left corner.
constexpr double gif_width = 480, gif_height = 150;
constexpr double gif_mass = 44, gif_floor = 34, gif_top = gif_floor + 44;
constexpr double gif_pattern = 12;

constexpr const char* gif_ink = "#444444";

std::string rectangle(double left, double bottom, double right, double upper, const char* colour) {
    return fmt::format("set object rectangle from {:.1f},{:.1f} to {:.1f},{:.1f} fc rgb '{}' fs solid noborder\n", left,
                       bottom, right, upper, colour);
}

}  // namespace

std::string gif_input(const Scene& scene) {
    const double first = scene.spring ? 110 : 40, last = gif_width - (scene.walls ? 44 : 32);
    const auto x = [&](double theta) { return first + scene.at(theta) * (last - first); };
    const double hundredths = 100 * scene.seconds / static_cast<double>(scene.frames.size() - 1);
    std::string text = fmt::format(
        "set terminal gif animate delay {:.0f} loop 0 size {:.0f},{:.0f} noenhanced\n"
        "unset key\nunset tics\nunset border\nset margins 0,0,0,0\nset xrange [0:{}]\nset yrange [0:{}]\n",
        std::max(2.0, std::round(hundredths)), gif_width, gif_height, gif_width, gif_height);
    std::string still = rectangle(4, gif_floor - 1, gif_width - 4, gif_floor + 1, gif_ink);
    constexpr double post = 6;
    if (scene.walls && std::isfinite(scene.walls->lower)) {
        const double right = x(scene.walls->lower) - gif_mass / 2;
        still += rectangle(right - post, gif_floor, right, gif_floor + 12, gif_ink);
    }
    if (scene.walls && std::isfinite(scene.walls->upper)) {
        const double left = x(scene.walls->upper) + gif_mass / 2;
        still += rectangle(left, gif_floor, left + post, gif_top, gif_ink);
    }
    constexpr double anchor = 8;
    if (scene.spring) still += rectangle(anchor - 2, gif_floor, anchor + 1, gif_top + 4, gif_ink);
    const std::vector<Point> corners = spring_corners(9);
    const double step = (scene.frames.back().t - scene.frames.front().t) / static_cast<double>(scene.frames.size() - 1);
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(std::max(step, 1e-12)) - 1e-9)), 0, 9);
    for (const Frame& frame : scene.frames) {
        const double middle = x(frame.theta);
        text += "unset object\nunset label\n" + still;
        text += rectangle(middle - gif_mass / 2, gif_floor + 1, middle + gif_mass / 2, gif_top,
                          frame.stuck ? "#D55E00" : "#0072B2");
        text += fmt::format("set label 't = {:.{}f}' at 14,{} textcolor rgb '{}'\n", frame.t, digits, gif_height - 16,
                            gif_ink);
        text += fmt::format("set label 'theta = {:+.3g}' at 150,{} textcolor rgb '{}'\n", frame.theta, gif_height - 16,
                            gif_ink);
        if (frame.stuck) text += fmt::format("set label 'stuck' at 320,{} textcolor rgb '#D55E00'\n", gif_height - 16);
        // The hatching of the surface, and the spring: strokes with gaps between them.
        text += "plot '-' using 1:2 with lines lt 1 lw 1 lc rgb '#444444'\n";
        const double shift = std::fmod(scene.shift(frame) * (last - first), gif_pattern);
        for (int stroke = -1; stroke * gif_pattern < gif_width + gif_pattern; ++stroke) {
            const double at = stroke * gif_pattern + shift;
            if (at < 4 || at + 8 > gif_width - 4) continue;
            text += fmt::format("{:.1f} {:.1f}\n{:.1f} {:.1f}\n\n", at, gif_floor - 10, at + 8, gif_floor - 1);
        }
        const double length = middle - gif_mass / 2 - anchor;
        for (const Point& corner : corners) {
            if (!scene.spring) break;
            text +=
                fmt::format("{:.1f} {:.1f}\n", anchor + length * corner.x, (gif_floor + gif_top) / 2 + 9 * corner.y);
        }
        text += "e\n";
    }
    return text;
}

}  // namespace dinal::plots::animation
