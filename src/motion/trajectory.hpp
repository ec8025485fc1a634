// What a run leaves behind: named columns, events, how it ended, and the motion between the rows.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/contradiction.hpp"
#include "model/event.hpp"
#include "model/friction.hpp"
#include "model/oscillator.hpp"
#include "model/outcome.hpp"
#include "motion/course.hpp"
#include "motion/growing.hpp"
#include "text/expected.hpp"

namespace dinal::motion {

/// The columns of a computed run, in this order: theta rad, velocity rad per time unit, the rest torques on the mass.
enum class Column : int { t, theta, velocity, M, friction, damping };
inline constexpr int column_count = 6;
const std::vector<std::string>& column_names();

/// A table of numbers, in which every column is contiguous.
class Rows {
public:
    using Matrix = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

    Rows() = default;
    explicit Rows(Growing<double> table) : table_(std::move(table)) {}
    explicit Rows(Eigen::MatrixXd values);

    [[nodiscard]] Eigen::Index rows() const { return static_cast<Eigen::Index>(table_.size()); }
    [[nodiscard]] Eigen::Index cols() const { return static_cast<Eigen::Index>(table_.columns()); }
    [[nodiscard]] double operator()(Eigen::Index row, Eigen::Index column) const {
        return table_(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
    }
    [[nodiscard]] Eigen::Map<const Eigen::VectorXd> col(Eigen::Index column) const {
        return {table_.column(static_cast<std::size_t>(column)).data(), rows()};
    }
    [[nodiscard]] Matrix matrix() const {
        return {rows() == 0 ? nullptr : table_.column(0).data(), rows(), cols(),
                Eigen::OuterStride<>(static_cast<Eigen::Index>(table_.stride()))};
    }
    [[nodiscard]] const Growing<double>& table() const { return table_; }
    friend bool operator==(const Rows& a, const Rows& b) { return a.matrix() == b.matrix(); }

private:
    Growing<double> table_;
};

/// What a run leaves to the one that goes on from there, besides the state of the mass: the states of its own.
struct Carried {
    Carried() = default;
    Carried(const Carried&) = default;
    Carried& operator=(const Carried&) = default;
    virtual ~Carried() = default;

    std::vector<double> states;
};

/// What was so rough on every scale that a run got nowhere.
struct Rough {
    std::string who;
    double by = 0, part = 0;        ///< in its own units, and as a part of what it is and acts beside
    bool other_integrators = true;  ///< may take the run
};

namespace engine {
struct Run;
}

struct Trajectory {
    std::vector<std::string> own_names = {};  ///< where these are not the six of every run: see names()
    Rows rows;                                ///< never NaN
    Growing<model::Event> events;             ///< in order of time
    model::Outcome outcome = model::Outcome::reached_end;
    model::State initial;  ///< at t_start
    double t_start = 0;
    double t_stop = 0;  ///< how far it came: t_end unless the outcome says otherwise
    model::State state_at_stop;
    model::Motion motion_at_stop = model::Motion::stuck;
    bool began_stuck = false;  ///< until something moved it
    bool began_open = false;   ///< nothing pressed on the contact until it closed
    bool on_belt = false;      ///< where a turn of theta is no event
    double restitution = 1;    ///< of the walls: what an impact left of the velocity
    bool computed = true;      ///< false when it was read from a file
    double gap = 0;  ///< the longest between two looks at a function M, time units; 0 where M tells when it changes
    double unproven = 0;    ///< the longest stretch in which functions that are read may do more than was seen
    double noise = 0;       ///< what keeps a function M from being smooth on any scale, torque
    std::size_t jumps = 0;  ///< of a function M along the motion, each of which was located
    bool located = false;   ///< conditions of the motion in functions that were read
    std::optional<Rough> rough = {};                         ///< of Outcome::unresolved, where it is known
    std::vector<std::string> event_names = {};               ///< of the user's events, by Event::user
    std::shared_ptr<const Carried> carried = nullptr;        ///< of a run with more in it
    std::optional<model::Contradiction> contradiction = {};  ///< of Outcome::not_a_function
    std::shared_ptr<const Course> course;  ///< none when it was declined, or the trajectory read from a file
    /// The run of all bodies that this one is, or is seen from one of them; none of a plain system.
    std::shared_ptr<const engine::Run> bodies = {};

    /// Jumps so many that they are what the run takes long for.
    [[nodiscard]] bool jumps_often() const {
        constexpr std::size_t often = 10000;
        return jumps >= often;
    }
    [[nodiscard]] Eigen::Index size() const { return rows.rows(); }
    /// One for each column of `rows`.
    [[nodiscard]] const std::vector<std::string>& names() const {
        return computed && own_names.empty() ? column_names() : own_names;
    }
    [[nodiscard]] std::optional<Eigen::Index> find(std::string_view name) const;
    [[nodiscard]] auto column(Column which) const { return rows.col(static_cast<Eigen::Index>(which)); }

    /// theta and velocity at t: from the integrator when it can, else by cubic interpolation of the rows.
    /// Fails when t is outside the run or there are no such columns.
    [[nodiscard]] text::Expected<model::State> at(double t) const;
    /// How many columns are states of the run: the last ones.
    [[nodiscard]] std::size_t state_count() const { return carried ? carried->states.size() : 0; }
    [[nodiscard]] std::size_t first_state() const { return names().size() - state_count(); }
};

/// theta and velocity at t by cubic interpolation of the rows, for want of anything better.
text::Expected<model::State> between_rows(const Trajectory& trajectory, double t);

/// How it ended, and what to do about that.
std::string outcome_text(const Trajectory& trajectory);

/// A remark if there are fewer than four rows an event, so that the rows do not show the motion; otherwise empty.
std::string too_few_rows(std::size_t rows, std::size_t events);

/// The one-line summary: "2001 rows, t 0 … 20; 41 events (39 turns, 1 stick, 1 slip); moving at the end; peak
/// |theta| 1.96".
std::string summary(const Trajectory& trajectory);

}  // namespace dinal::motion
