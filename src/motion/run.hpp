// The result of a run: named columns, events, outcome, and the motion between the rows.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/event.hpp"
#include "model/friction.hpp"
#include "model/oscillator.hpp"
#include "motion/columns.hpp"
#include "motion/course.hpp"
#include "motion/growing.hpp"
#include "text/expected.hpp"

namespace dinal::motion {

/// The names of a body's columns.
const std::vector<std::string>& column_names();

/// A table of numbers whose columns are contiguous.
class Rows {
public:
    using Matrix = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

    Rows() = default;
    explicit Rows(Growing<double> table) : table_(std::move(table)) {}
    explicit Rows(Eigen::MatrixXd values);

    Eigen::Index rows() const { return static_cast<Eigen::Index>(table_.size()); }
    Eigen::Index cols() const { return static_cast<Eigen::Index>(table_.columns()); }
    [[nodiscard]] double operator()(Eigen::Index row, Eigen::Index column) const {
        return table_(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
    }
    Eigen::Map<const Eigen::VectorXd> col(Eigen::Index column) const {
        return {table_.column(static_cast<std::size_t>(column)).data(), rows()};
    }
    Matrix matrix() const {
        return {rows() == 0 ? nullptr : table_.column(0).data(), rows(), cols(),
                Eigen::OuterStride<>(static_cast<Eigen::Index>(table_.stride()))};
    }
    const Growing<double>& table() const { return table_; }
    friend bool operator==(const Rows& a, const Rows& b) { return a.matrix() == b.matrix(); }

private:
    Growing<double> table_;
};

/// The function whose roughness on every scale stopped a run.
struct Rough {
    std::string who;
    double by = 0, part = 0;        ///< the roughness in its own units, and relative to the quantities it acts on
    bool other_integrators = true;  ///< whether other integrators may succeed
};

namespace engine {
struct Left;
}

/// The motion of a system or, as a view, of one of its bodies or links. The members from `initial` on belong to that
/// body or link. For several bodies they belong to the first one, and there is no course.
struct Run {
    std::vector<std::string> own_names = {};    ///< if they differ from the usual six: see names()
    Rows rows;                                  ///< never NaN; columns of accelerations may follow the named ones
    Growing<model::Event> events;               ///< ordered by time; a user's event appears once for each joint
    std::vector<std::string> event_names = {};  ///< names of the user's events, by Event::user
    std::size_t states = 0;                     ///< the number of the run's own states, its last columns
    model::Outcome outcome = model::Outcome::reached_end;
    std::optional<Rough> rough = {};                         ///< cause of Outcome::unresolved, if known
    std::optional<model::Contradiction> contradiction = {};  ///< cause of Outcome::not_a_function
    double t_start = 0;
    double t_stop = 0;  ///< the time reached: t_end unless the run ended early
    double gap = 0;  ///< longest distance between two samples of a function M, time units; 0 if M declares its breaks
    double unproven = 0;    ///< longest interval in which formulas were not proven to follow their samples
    double noise = 0;       ///< torque by which M deviates from a smooth function on every scale
    std::size_t jumps = 0;  ///< located jumps of a function M along the motion
    bool located = false;   ///< whether formulas have conditions on the motion, which were located
    bool computed = true;   ///< whether it was simulated; otherwise read from a file
    /// state of the general engine at the end; null for other integrators
    std::shared_ptr<const engine::Left> left = {};

    model::State initial;  ///< at t_start
    model::State state_at_stop;
    model::Motion motion_at_stop = model::Motion::stuck;
    bool began_stuck = false;              ///< whether it was stuck until something moved it
    bool began_open = false;               ///< whether nothing pressed on the contact until it closed
    bool on_belt = false;                  ///< whether turns of theta are not recorded as events, as on a belt
    double restitution = 1;                ///< fraction of the speed kept at an impact on a wall
    std::shared_ptr<const Course> course;  ///< the motion between the rows; null if it was not kept

    /// Returns whether the jumps dominate the duration of the computation.
    bool jumps_often() const {
        constexpr std::size_t often = 10000;
        return jumps >= often;
    }
    Eigen::Index size() const { return rows.rows(); }
    /// The events; a user's events only once.
    Growing<model::Event> events_once() const;
    /// One name for each column of `rows` that users see.
    const std::vector<std::string>& names() const { return computed && own_names.empty() ? column_names() : own_names; }
    std::optional<Eigen::Index> find(std::string_view name) const;
    auto column(Column which) const { return rows.col(static_cast<Eigen::Index>(which)); }

    /// theta and velocity at t: from the integrator if available, otherwise by cubic interpolation of the rows.
    /// Fails if t is outside the run or the columns are missing.
    text::Expected<model::State> at(double t) const;
    std::size_t first_state() const { return names().size() - states; }
    /// Returns whether it keeps its motion between the rows.
    bool is_dense() const;
};

/// theta and velocity at t by cubic interpolation of the rows alone.
text::Expected<model::State> between_rows(const Run& run, double t);

/// The outcome as a sentence with a remedy.
std::string outcome_text(const Run& run);

/// A remark if there are fewer than four rows an event, so that the rows do not show the motion; otherwise empty.
std::string too_few_rows(std::size_t rows, std::size_t events);

/// The one-line summary: "2001 rows, t 0 … 20; 41 events (39 turns, 1 stick, 1 slip); moving at the end; peak
/// |theta| 1.96".
std::string summary(const Run& run);

}  // namespace dinal::motion
