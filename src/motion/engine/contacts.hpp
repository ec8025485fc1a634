// What contacts remember from one decision to the next.
#pragma once

#include <vector>

#include "model/event.hpp"
#include "motion/engine/now.hpp"

namespace dinal::motion::engine {

/// A value type, like Now. The modes of the contacts are in Now.
struct Contacts {
    /// The last stick of a joint: its direction before, and its pull.
    struct Arrival {
        model::Motion slid = model::Motion::stuck;
        double pull = 0;
    };
    struct Contact {
        model::Motion arrived = model::Motion::stuck;  ///< direction of sliding until now; stuck: it did not slide
        Arrival arrival = {};
        /// the stick event of a creep, reported only if nothing moves the joint before the end
        model::Event creeping = {};
        int edge = 0;              ///< end of its speed range at which it is: -1 lower, 1 upper, 0 neither
        bool crept = false;        ///< whether its slip has fallen to rounding, so that it may creep
        bool leaves_wall = false;  ///< whether it begins at a wall and leaves it
        bool leaned = false;       ///< whether it stopped at a wall and that was reported
        int load_sign = 0;         ///< sign of its normal load; 0: unknown
        int bristle_sign = 0;      ///< sign of the slip of its bristles; 0: unknown
    };
    std::vector<Contact> of;               ///< one for each joint
    double size_at_stop = 0;               ///< magnitude of the torques when a joint last reached slip 0
    std::vector<std::size_t> last_full{};  ///< joints of loops that reached their limits last, at one instant
    double last_full_at = -model::never;

    /// Makes a joint slide in direction `way` from now on.
    void slide(const Mechanics& mechanics, Now& now, std::size_t joint, model::Motion way, bool leaving);
};

/// Makes the velocities of bodies that stick together exactly equal, and puts joints at a wall exactly onto it.
class Projection {
public:
    /// The joints from index `own_joints` on impose prescribed motions.
    Projection(const Mechanics& mechanics, std::size_t own_joints)
        : mechanics_(mechanics), own_joints_(own_joints), offsets_(mechanics.bodies()) {}
    void apply(Now& now, const Frame& frame, Side when);

private:
    double angle_given(std::size_t body, double t, Side when) const;

    const Mechanics& mechanics_;
    std::size_t own_joints_;
    std::vector<double> belts_, offsets_, momentum_, first_;
    std::vector<char> seen_, alike_;
};

}  // namespace dinal::motion::engine
