// The guards of a stretch: everything whose zero ends it before its time.
#pragma once

#include <array>
#include <vector>

#include "motion/engine/balance.hpp"
#include "motion/engine/conditions.hpp"
#include "motion/engine/contacts.hpp"
#include "motion/engine/crossing.hpp"
#include "motion/engine/ending.hpp"
#include "motion/engine/torque_sizes.hpp"
#include "motion/engine/user_events.hpp"
#include "motion/engine/walls.hpp"

namespace dinal::motion::engine {

/// Searches one stretch for its first end, by a table of all kinds of ends: a new kind is a row there, and a case of
/// Engine::handle(). It decides nothing: it notes only on which side of zero values are, and which contacts creep.
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
        Conditions& conditions;
        UserEvents& users;
        std::vector<Half>& normal_halves;  ///< of each joint: the sign of its normal load, or of the slip of bristles
    };
    explicit Guards(const Of& of)
        : mechanics_(of.mechanics), segment_(of.segment), frame_(of.frame), now_(of.begin), of_(of) {}

    /// Returns the first end.
    Ending first();
    /// Joints that were let go and do not leave: they hold, and must be pulled clearly farther.
    [[nodiscard]] const std::vector<std::size_t>& stay() const { return stay_; }
    /// Returns false if a limit, or the value of a user's event, was not finite.
    [[nodiscard]] bool good() const { return good_; }
    /// The user's event that would be thrown back at once, and again, if there is one.
    [[nodiscard]] std::optional<std::size_t> thrown_back() const { return thrown_back_; }

private:
    enum class Per { joint, slider, load, motion };
    /// A row of the table: one kind of what ends a stretch, of which each joint or the like has one.
    struct Row {
        Per per;
        By by;
        void (Guards::*watch)(std::size_t which);  ///< calls see() where it happens first, if it can happen at all
    };
    static const std::array<Row, 11> table;
    [[nodiscard]] std::size_t count(Per per) const;

    /// The stretch ends here by what is being watched, if nothing ends it before.
    void see(std::optional<double> x, int side = 0);
    /// Watches a curve that is positive, or begins at a known `zero`, until it ends the stretch. `floor`: its rounding.
    void watch(const Series& left, double floor, bool zero, int side);
    /// Returns the place at which a function of the moment with these values at the nodes leaves its half.
    template <class Value>
    std::optional<double> leaves(const Nodes& values, const Value& value, Half& half, double rounded = 0) {
        return Watched(values, segment_.anywhere(value, point_), rounded).leaves(half, -1);
    }
    std::optional<double> slip_leaves(std::size_t joint, Half& half);
    [[nodiscard]] double fastest(std::size_t joint) const;
    [[nodiscard]] bool slides(std::size_t joint) const;
    [[nodiscard]] bool may_creep(std::size_t joint) const;
    [[nodiscard]] Nodes limit(std::size_t joint, model::Motion side) const;
    void watch_walls(std::size_t joint, const model::Walls& walls);
    [[nodiscard]] std::optional<double> switches(double sign, double level, std::size_t k) const;

    // What the rows of the table call.
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
    const Of& of_;
    Ending ending_;
    By by_ = By::nobody;     ///< of the row that is being watched
    std::size_t which_ = 0;  ///< of those that have it
    std::vector<std::size_t> stay_;
    std::optional<std::size_t> thrown_back_;
    bool good_ = true;
    std::vector<double> point_;
};

}  // namespace dinal::motion::engine
