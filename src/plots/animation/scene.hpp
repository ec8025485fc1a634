// A run in motion as an SVG with SMIL, without scripts: bodies at equal time steps, with surface, springs and walls.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/drive.hpp"
#include "plots/figure.hpp"
#include "plots/run_figure.hpp"

namespace dinal::plots::animation {

struct Frame {
    double t = 0;
    double theta = 0;
    bool stuck = false;
    double surface = 0;  ///< displacement of the belt, unit of theta
};

/// The motion of a body, or of a link: the angle between its bodies.
struct Track {
    std::vector<Frame> frames;  ///< at equal time steps; the last one is the end
    Interval reach;             ///< range of theta, walls included
    std::optional<model::Walls> walls = {};
    bool spring = true;
    bool belt = false;
    std::string name = {};  ///< empty for a single unnamed body
    model::Units units = {};

    double at(double theta) const { return (theta - reach.low) / reach.length(); }
    /// The displacement of the surface, as a fraction of the reach.
    double shift(const Frame& frame) const { return frame.surface / reach.length(); }
};

struct Link {
    Track track;
    std::size_t first = 0, second = 0;  ///< its bodies
};

/// Bodies at the same times: side by side, or as discs on one axis if one of them rotates.
struct Scene {
    std::vector<Track> bodies;  ///< all have the same reach
    std::vector<Link> links;
    double seconds = 10;  ///< duration of the animation
    bool discs = false;
};

/// The part of the run to be shown, and its duration in the animation.
struct Take {
    double from = 0, to = 1;
    double seconds = 10;
    static constexpr double frames_per_second = 25;
    double steps() const { return seconds * frames_per_second; }
};

/// Makes frames, using the motion between rows. `belt` is the velocity of the surface, or nullptr. Fails if the run
/// lacks its motion, or go_on() returns false.
text::Expected<Track> track_of(const RunData& run, const model::Excitation* belt, const Take& take,
                               const std::function<bool()>& go_on);

/// Orders bodies so that linked ones are neighbours, and gives all a common reach.
Scene scene_of(std::vector<Track> bodies, std::vector<Link> links, double seconds);

/// Blocks on a floor or belts with their links, or discs on one axis; below, the angles over t. Repeats for ever.
std::string animated_svg(const Scene& scene);

/// "A run in motion, t = 0 to 10"
std::string title_of(const Scene& scene);

}  // namespace dinal::plots::animation
