// A run seen in motion, before anybody decides how to show it: where the mass is at equal steps of time, and around it
// a surface, a spring and walls.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/drive.hpp"
#include "plots/canvas.hpp"
#include "plots/figure.hpp"
#include "plots/run_figure.hpp"

namespace dinal::plots::animation {

struct Frame {
    double t = 0;
    double theta = 0;
    bool stuck = false;
    double surface = 0;  ///< how far the belt has come, in the unit of theta
};

struct Scene {
    std::vector<Frame> frames;  ///< equal steps of time; the last one is the end
    double seconds = 10;        ///< from the first to the last
    Interval reach;             ///< of theta, walls included
    std::optional<model::Walls> walls = {};
    bool spring = true;
    bool belt = false;
    std::string name = {};  ///< of one among several bodies
    std::string theta_unit = "rad", t_unit = {};

    [[nodiscard]] double at(double theta) const { return (theta - reach.low) / reach.length(); }
    /// Of a pattern that lies still: a part of the reach.
    [[nodiscard]] double shift(const Frame& frame) const { return frame.surface / reach.length(); }
};

/// What part of the run is shown, and how fast.
struct Take {
    double from = 0, to = 1;
    double seconds = 10;
    double frames_per_second = 25;
    [[nodiscard]] double count() const { return seconds * frames_per_second; }
};

/// Several bodies at the same times: side by side, or discs on one axis where one goes round.
struct RigScene {
    struct Link {
        Scene scene;  ///< of the angle between its bodies
        std::size_t first = 0, second = 0;
    };
    std::vector<Scene> bodies;  ///< with one reach
    std::vector<Link> links;
    bool discs = false;
};

/// Puts neighbours side by side and gives all one reach; discs are turned into one turn.
RigScene side_by_side(std::vector<Scene> bodies, std::vector<RigScene::Link> links);

/// The motion of the run between its rows, too. `belt` is the velocity of the surface, if it has one. Fails when the
/// run does not tell where it was, or go_on() says no.
text::Expected<Scene> scene_of(const RunData& run, const model::Excitation* belt, const Take& take,
                               const std::function<bool()>& go_on);

/// Where a spring of that many windings has its corners: fractions of its length, and of its width from -1 to 1.
std::vector<Point> spring_corners(int windings);

// An animation as SVG that a browser plays by itself: SMIL, no script.

/// The mass, its spring, walls and surface, and below them theta over t with a dot that goes along. Repeats for ever.
std::string animated_svg(const Scene& scene);

/// Blocks on a floor, or on belts, with what links them; or discs on one axis. Below, the angles over t.
std::string animated_svg(const RigScene& rig);

/// "A run in motion, t = 0 to 10"
std::string title_of(const Scene& scene);

// One frame of an animation in characters.

struct FrameFormat {
    int columns = 80;  ///< no line is longer
    Charset charset = Charset::braille;
    bool colours = false;
};

/// Always as many lines: time and place, two of the mass on its spring between its walls, the surface, a scale.
std::vector<std::string> text_frame(const Scene& scene, const Frame& frame, const FrameFormat& format);

}  // namespace dinal::plots::animation
