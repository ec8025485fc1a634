// The present of a run: its time, its state and the modes of its contacts.
#pragma once

#include <cstddef>
#include <vector>

#include "motion/belt_slope.hpp"
#include "motion/clock.hpp"
#include "motion/engine/mechanics.hpp"

namespace dinal::motion::engine {

/// A value type without any logic of decisions or reports.
struct Now {
    Clock t;
    bool after_break = false;              ///< functions are evaluated from the right of a break
    std::vector<double> y{};               ///< angles, velocities, states
    std::vector<double> low{};             ///< rounding errors of the angles
    Mode mode{};                           ///< mode of the contacts
    std::vector<double> rigid_at{};        ///< the fixed angle of each rigid joint
    std::vector<BeltSlope> belt_slopes{};  ///< the acceleration of each joint's belt

    Side side() const { return after_break ? Side::after : Side::at; }
    Moment here() const { return {t.hi, side(), y}; }
    /// Returns whether the joint has dry friction and is not open.
    bool rubs(std::size_t joint) const { return mode.rubs[joint] != 0; }
    double slip(const Mechanics& mechanics, std::size_t joint) const {
        return mechanics.velocity(joint, y) - mechanics.belt(joint, t.hi, side());
    }
    /// Returns the distance from the angle of a joint to `place`, including the rounding errors of the angles.
    double gap(const model::Joint& joint, double place) const { return (place - joint.sum(y)) - joint.sum(low); }
    double greatest_of_state() const;
    /// Returns the state for functions that jump at slip 0: joints that leave slip 0 get the smallest velocity in their
    /// direction. The result is y if none leaves, otherwise `made`.
    const std::vector<double>& departing(const model::System& system, std::vector<double>& made) const;
    /// Returns the velocity of the belt, or, if it passes zero, the smallest velocity in its direction.
    double belt_heading(const Mechanics& mechanics, std::size_t joint) const;
    /// Returns whether the velocity of the belt is zero within the rounding of the time.
    bool belt_sets_off(const Mechanics& mechanics, std::size_t joint) const;

    /// Fixes the angles of rigid joints at their present values.
    void keep_rigid_places(const model::System& system);
    /// Sets the angle of the body `child` so that the joint is at `place`.
    void put_child(const model::Joint& joint, std::size_t child, double weight, double place);
};

}  // namespace dinal::motion::engine
