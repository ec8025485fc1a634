// The guards of a stretch: quantities whose zero ends it early.
#pragma once

#include <vector>

#include "motion/engine/balance.hpp"
#include "motion/engine/contacts.hpp"
#include "motion/engine/crossing.hpp"
#include "motion/engine/ending.hpp"
#include "motion/engine/torque_sizes.hpp"
#include "motion/engine/walls.hpp"

namespace dinal::motion::engine {

/// Finds the first end of one stretch. Makes no decision, but notes the signs of normal loads and which contacts creep.
class Guards {
public:
    struct Of {
        const Mechanics& mechanics;
        const Segment& segment;
        const Frame& frame;
        const Now& begin;
        const Walls& walls;
        const TorqueSizes& sizes;
        const Flow& solver;
        Balances& balances;
        Contacts& contacts;
        std::vector<Half>& normal_halves;  ///< for each joint: sign of its normal load, or of the slip of its bristles
    };
    explicit Guards(const Of& of)
        : mechanics_(of.mechanics), segment_(of.segment), frame_(of.frame), now_(of.begin), of_(of) {}

    /// Returns the first end caused by a contact, a wall or a relay.
    Ending first();
    /// The released joints that do not move: they stick again, and need a clearly larger pull.
    [[nodiscard]] const std::vector<std::size_t>& stay() const { return stay_; }
    /// Returns false if a limit was not finite.
    [[nodiscard]] bool good() const { return good_; }

private:
    /// Ends the stretch at x if nothing ends it earlier.
    void see(std::optional<double> x, By by, std::size_t which, int side = 0);
    /// Ends the stretch at the first zero of a curve that is positive, or starts from a known `zero`. `floor` is its
    /// rounding.
    void watch(const Series& left, double floor, bool zero, By by, std::size_t which, int side);
    /// Returns the point at which a function of the moment, given its values at the nodes, leaves its half.
    template <class Value>
    std::optional<double> leaves(const Nodes& values, const Value& value, Half& half, double rounded = 0) {
        return Watched(values, segment_.anywhere(value, point_), rounded).leaves(half, -1);
    }
    std::optional<double> slip_leaves(std::size_t joint, Half& half);
    [[nodiscard]] double fastest(std::size_t joint) const;
    void watch_slip(std::size_t joint);
    [[nodiscard]] bool may_creep(std::size_t joint) const;
    void watch_release(std::size_t joint);
    [[nodiscard]] Nodes limit(std::size_t joint, model::Motion side) const;
    void watch_walls(std::size_t joint, const model::Walls& walls, By by);
    void watch_stop(std::size_t joint);
    void watch_slider(std::size_t slider);
    void watch_corner(std::size_t joint);
    void watch_normal(std::size_t joint);
    void watch_bristles(std::size_t joint);
    [[nodiscard]] std::optional<double> switches(double sign, double level, std::size_t k) const;
    void watch_relays();

    [[nodiscard]] const model::Joint& joint_at(std::size_t joint) const { return mechanics_.system().joints[joint]; }
    [[nodiscard]] std::size_t n() const { return mechanics_.bodies(); }

    const Mechanics& mechanics_;
    const Segment& segment_;
    const Frame& frame_;
    const Now& now_;
    const Of& of_;
    Ending ending_;
    std::vector<std::size_t> stay_;
    bool good_ = true;
    std::vector<double> point_;
};

}  // namespace dinal::motion::engine
