// The guards of a stretch: quantities whose zero ends it early.
#pragma once

#include <array>
#include <vector>

#include "motion/engine/balance.hpp"
#include "motion/engine/conditions.hpp"
#include "motion/engine/contacts.hpp"
#include "motion/engine/crossing.hpp"
#include "motion/engine/segment.hpp"
#include "motion/engine/torque_sizes.hpp"
#include "motion/engine/user_events.hpp"
#include "motion/engine/walls.hpp"

namespace dinal::motion::engine {

/// Searches one stretch for its first end, by a table of all kinds of ends: a new kind is a row there, and a case of
/// Engine::handle(). Makes no decision, but notes the signs of watched values and which contacts creep.
class Guards {
public:
    struct Parts {
        const Mechanics& mechanics;
        const Segment& segment;
        const Frame& frame;
        const Now& begin;
        const Walls& walls;
        const TorqueSizes& sizes;
        const Flow& solver;
        Balances& balances;
        Contacts& contacts;
        Conditions& conditions;
        UserEvents& users;
    };
    explicit Guards(const Parts& parts)
        : mechanics_(parts.mechanics), segment_(parts.segment), frame_(parts.frame), now_(parts.begin), parts_(parts) {}

    Ending first();
    /// The released joints that do not move: they stick again, and need a clearly larger pull.
    [[nodiscard]] const std::vector<std::size_t>& stay() const { return stay_; }
    /// Returns false if a limit, or the value of a user's event, was not finite.
    [[nodiscard]] bool good() const { return good_; }
    /// The user event that would be thrown back again at once; empty if there is none.
    [[nodiscard]] std::optional<std::size_t> thrown_back() const { return thrown_back_; }

private:
    enum class Per { joint, slider, load, motion };
    /// A row of the table: a kind of end, watched for each joint, slider or load, or once for the motion.
    struct Row {
        Per per;
        By by;
        void (Guards::*watch)(std::size_t which);  ///< calls end_at() with the first end of this kind, if there is one
    };
    static const std::array<Row, 11> table;
    [[nodiscard]] std::size_t count(Per per) const;

    /// Ends the stretch at x by the present row's cause, unless it already ends earlier.
    void end_at(std::optional<double> x, int side = 0);
    /// Ends the stretch at the first zero of a curve that starts positive or, if `zero`, at zero. `floor` is its
    /// rounding, `slope_floor` that of its slope.
    void watch(const Series& left, double floor, bool zero, int side, double slope_floor = 0);
    /// Returns the point at which a function of the moment, given its values at the nodes, leaves its half.
    template <class Value>
    std::optional<double> leaves(const Nodes& values, const Value& value, Half& half, double rounded = 0) {
        return Watched(values, segment_.function_of_x(value, point_), rounded).leaves(half, -1);
    }
    std::optional<double> slip_leaves(std::size_t joint, Half& half);
    [[nodiscard]] double fastest(std::size_t joint) const;
    [[nodiscard]] bool is_kept(std::size_t joint) const;
    [[nodiscard]] double least_inertia(std::size_t joint) const;
    [[nodiscard]] double uncertain(std::size_t joint) const;
    [[nodiscard]] bool none_leaves() const;
    [[nodiscard]] bool slides(std::size_t joint) const;
    [[nodiscard]] bool may_creep(std::size_t joint) const;
    [[nodiscard]] Nodes limit(std::size_t joint, model::Motion side) const;
    void watch_walls(std::size_t joint, const model::Walls& walls);
    [[nodiscard]] std::optional<double> switches(double sign, double level, std::size_t k) const;

    // The functions of the table's rows.
    void watch_release(std::size_t joint);
    void watch_slip(std::size_t joint);
    void watch_corner(std::size_t joint);
    void watch_wall(std::size_t joint);
    void watch_stop(std::size_t joint);
    void watch_normal(std::size_t joint);
    void watch_bristles(std::size_t joint);
    void watch_slider(std::size_t slider);
    void watch_relays(std::size_t load);
    void watch_conditions(std::size_t /*motion*/);
    void watch_users(std::size_t /*motion*/);

    [[nodiscard]] const model::Joint& joint_at(std::size_t joint) const { return mechanics_.system().joints[joint]; }
    [[nodiscard]] std::size_t n() const { return mechanics_.bodies(); }

    const Mechanics& mechanics_;
    const Segment& segment_;
    const Frame& frame_;
    const Now& now_;
    const Parts& parts_;
    Ending ending_;
    By by_ = By::nobody;     ///< cause in the row that is being watched
    std::size_t which_ = 0;  ///< index of the joint, slider or load that is being watched
    std::vector<std::size_t> stay_;
    std::optional<std::size_t> thrown_back_;
    bool good_ = true;
    std::vector<double> point_;
};

}  // namespace dinal::motion::engine
