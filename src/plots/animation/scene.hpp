// A run as a sequence of frames, independent of their output: the mass at equal time steps, with surface, spring and
// walls.
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
    double surface = 0;  ///< displacement of the belt, unit of theta
};

struct Scene {
    std::vector<Frame> frames;  ///< at equal time steps; the last one is the end
    double seconds = 10;        ///< duration of the animation
    Interval reach;             ///< range of theta, walls included
    std::optional<model::Walls> walls = {};
    bool spring = true;
    bool belt = false;
    std::string name = {};  ///< name of a body among several
    std::string theta_unit = "rad", t_unit = {};

    [[nodiscard]] double at(double theta) const { return (theta - reach.low) / reach.length(); }
    /// The displacement of a pattern at rest, as a part of the reach.
    [[nodiscard]] double shift(const Frame& frame) const { return frame.surface / reach.length(); }
};

/// The part of the run to be shown, and its speed.
struct Take {
    double from = 0, to = 1;
    double seconds = 10;
    double frames_per_second = 25;
    [[nodiscard]] double count() const { return seconds * frames_per_second; }
};

/// Several bodies at the same times: side by side, or as discs on one axis if one of them rotates.
struct RigScene {
    struct Link {
        Scene scene;  ///< the angle between its bodies
        std::size_t first = 0, second = 0;
    };
    std::vector<Scene> bodies;  ///< all have the same reach
    std::vector<Link> links;
    bool discs = false;
};

/// Orders bodies so that linked ones are neighbours, and gives all a common reach; disc angles are reduced to one turn.
RigScene side_by_side(std::vector<Scene> bodies, std::vector<RigScene::Link> links);

/// Makes frames, using the motion between rows. `belt` is the velocity of the surface, or nullptr. Fails if the run
/// lacks its motion, or go_on() returns false.
text::Expected<Scene> scene_of(const RunData& run, const model::Excitation* belt, const Take& take,
                               const std::function<bool()>& go_on);

/// The corners of a spring with these windings: fractions of its length, and of its width from -1 to 1.
std::vector<Point> spring_corners(int windings);

// Animations as SVG with SMIL, without scripts.

/// The mass with spring, walls and surface; below, theta over t with a moving dot. Repeats for ever.
std::string animated_svg(const Scene& scene);

/// Blocks on a floor or belts with their links, or discs on one axis; below, the angles over t.
std::string animated_svg(const RigScene& rig);

/// "A run in motion, t = 0 to 10"
std::string title_of(const Scene& scene);

// One frame of an animation as text.

struct FrameFormat {
    int columns = 80;  ///< maximum length of a line
    Charset charset = Charset::braille;
    bool colours = false;
};

/// A fixed number of lines: time and place, two for mass, spring and walls, the surface, a scale.
std::vector<std::string> text_frame(const Scene& scene, const Frame& frame, const FrameFormat& format);

}  // namespace dinal::plots::animation
