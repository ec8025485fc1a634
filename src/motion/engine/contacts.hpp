// The memory of contacts from one decision to the next.
#pragma once

#include <vector>

#include "model/event.hpp"
#include "motion/engine/now.hpp"

namespace dinal::motion::engine {

/// A value, as Now is. Their modes are in Now.
struct Contacts {
    /// The last time that a joint came to stick: the way in which it slid, and the pull.
    struct Arrival {
        model::Motion slid = model::Motion::stuck;
        double pull = 0;
    };
    struct Of {
        model::Motion arrived = model::Motion::stuck;  ///< the way in which it slid until now; stuck: it did not
        Arrival arrival = {};
        model::Event creeping = {};  ///< while it creeps: its stick, an event if nothing moves it before the end
        int edge = 0;                ///< the corner that its speed is at, 1 the upper one of its range
        bool crept = false;          ///< its slip has come down to rounding, and it may creep
        bool leaves_wall = false;    ///< it begins at a wall, and leaves it
        bool leaned = false;         ///< it came to stand at a wall, and that was reported
    };
    std::vector<Of> of;         ///< each joint
    double size_at_stop = 0;    ///< of the torques, where a joint came to slip 0 the last time
    std::size_t last_full = 0;  ///< the joint of a loop that came to its limit last
    double last_full_at = -model::never;

    /// Lets a joint slide this way from now on.
    void slide(const Mechanics& mechanics, Now& now, std::size_t joint, model::Motion way, bool leaving);
};

/// Makes what is held together have one velocity to the letter, and what leans stand at its wall.
class Projection {
public:
    /// The joints behind the first `told` ones move bodies.
    Projection(const Mechanics& mechanics, std::size_t told)
        : mechanics_(mechanics), told_(told), offsets_(mechanics.bodies()) {}
    void apply(Now& now, const Frame& frame, Side when);

private:
    [[nodiscard]] double angle_given(std::size_t body, double t, Side when) const;

    const Mechanics& mechanics_;
    std::size_t told_;
    std::vector<double> belts_, offsets_, momentum_, first_;
    std::vector<char> seen_, alike_;
};

}  // namespace dinal::motion::engine
