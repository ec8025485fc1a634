// Motions that come back to themselves, of one body or of several, with all that a run may have: fixed points of a map
// of the whole state, from one period to the next, or from one passage of an angle to the next where nothing depends on
// the time. docs/theory.md, section 10.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/steady.hpp"
#include "motion/engine/run.hpp"

namespace dinal::analysis {

/// Discrete part of a moment: no number that may change a little.
struct HeldMode {
    motion::engine::Mode mode;
    std::vector<std::vector<motion::engine::Signal::Memory>> controllers;

    friend bool operator==(const HeldMode& a, const HeldMode& b);
};

/// Everything that decides how the motion goes on: all of y, and the mode; none where it follows from y.
struct Moment {
    Eigen::VectorXd y;
    std::optional<HeldMode> mode = {};
};

/// Runs of the question that begin at any moment.
class Runs {
public:
    using Run = motion::engine::Run;
    Runs(const SteadyQuestion& question, const motion::Monitor& monitor) : question_(question), monitor_(monitor) {}

    [[nodiscard]] const SteadyQuestion& question() const { return question_; }
    [[nodiscard]] const model::System& system() const { return *question_.system; }
    [[nodiscard]] Eigen::Index bodies() const { return static_cast<Eigen::Index>(system().bodies.size()); }
    [[nodiscard]] const std::optional<model::Contradiction>& contradiction() const { return contradiction_; }
    [[nodiscard]] Moment first() const;
    /// The drive of a run that begins at this moment and time.
    [[nodiscard]] model::Drive from(const Moment& moment, double start) const;
    [[nodiscard]] Run run(const Moment& from, double start, double end, const motion::Grid& rows, bool dense,
                          const std::optional<model::WantedEvent>& section = {});
    /// From where another run ended, with all that its controllers and delays remember; none: from the start.
    [[nodiscard]] Run go_on(std::shared_ptr<const motion::engine::Carry> before, double start, double end,
                            const motion::Grid& rows, const std::optional<model::WantedEvent>& section = {});
    [[nodiscard]] static Moment at_stop(const Run& run);
    /// The longest natural period of a body on the stiffness around it; 0 where there is none.
    [[nodiscard]] double natural_period() const;
    /// Directions in which a moment may be disturbed without leaving its mode: orthonormal columns.
    [[nodiscard]] Eigen::MatrixXd allowed(const HeldMode& mode, Eigen::Index size) const;

private:
    [[nodiscard]] Run run(const model::Drive& drive, double start, double end, const motion::Grid& rows, bool dense,
                          std::shared_ptr<const motion::engine::Carry> before);

    const SteadyQuestion& question_;
    const motion::Monitor& monitor_;
    std::optional<model::Contradiction> contradiction_;
    motion::engine::Floor floor_;  ///< what the last run found, for those that begin where hardly anything moves
};

/// How the state is measured where the motion returns: angles of bodies that go round are those from another body.
class Chart {
public:
    /// `from` of each body: the body from which its angle is measured; -1: the ground; itself: not at all.
    explicit Chart(std::vector<Eigen::Index> from) : from_(std::move(from)) {}

    [[nodiscard]] bool measures(Eigen::Index k) const {
        return k >= static_cast<Eigen::Index>(from_.size()) || from_[static_cast<std::size_t>(k)] != k;
    }
    [[nodiscard]] bool goes_round(Eigen::Index body) const { return from_[static_cast<std::size_t>(body)] >= 0; }
    [[nodiscard]] std::size_t bodies() const { return from_.size(); }
    [[nodiscard]] bool any_goes_round() const;
    /// Of all of y: angles from another body where they are measured so, and 0 where not at all.
    [[nodiscard]] Eigen::VectorXd measured(const Eigen::VectorXd& y) const;
    /// The reverse, for bodies from which others are measured at these angles.
    [[nodiscard]] Eigen::VectorXd state(const Eigen::VectorXd& x, const Eigen::VectorXd& there) const;
    [[nodiscard]] double value(Eigen::Index k, std::span<const double> y) const;

private:
    std::vector<Eigen::Index> from_;
};

/// Bodies between which nothing depends on where they are go round together, and are measured from each other.
Chart chart_of(Runs& runs);

/// From one return of the motion to the next: from period to period, or from passage to passage of a section. A place
/// is the measured numbers but for that of the section, each in its unit.
class Returns {
public:
    struct Return {
        Eigen::VectorXd to;
        double time = 0;
        bool finished = false;
        model::Outcome outcome = model::Outcome::reached_end;
        std::optional<HeldMode> mode = {};
        std::vector<std::pair<model::EventKind, int>> events = {};  ///< on the way: what, and at which joint
    };
    /// A value that a measured number passes, upwards (way = 1) or downwards (-1).
    struct Section {
        Eigen::Index measured = 0;
        double place = 0, way = 1;
    };

    /// A passage must come within `length`. What a place does not have is that of `there`.
    Returns(Runs& runs, const Chart& chart, double start, double length, const std::optional<Section>& section,
            Eigen::VectorXd units, Eigen::VectorXd there);

    [[nodiscard]] Eigen::VectorXd place(const Eigen::VectorXd& y) const;
    [[nodiscard]] Moment moment(const Eigen::VectorXd& place, const std::optional<HeldMode>& mode) const;
    /// Some returns on.
    [[nodiscard]] Return operator()(const Eigen::VectorXd& from, const std::optional<HeldMode>& mode, int returns = 1);
    /// The first return after a moment that need not be one.
    [[nodiscard]] Return arrival(const Moment& from);
    struct Derivative {
        Eigen::MatrixXd by_place;
        double bend = 0;  ///< by how much the slopes to both sides differ from their mean
    };
    /// D of the map of so many returns at a place to which they lead back, by differences of this order in what the
    /// mode allows. Those of order 4 are made smaller where the motions to both sides do not have the same events; none
    /// where that does not help and the slopes differ.
    [[nodiscard]] std::optional<Derivative> derivative(const Eigen::VectorXd& at, const HeldMode& mode, int returns,
                                                       int order);
    [[nodiscard]] double start() const { return start_; }
    /// Which numbers of all of y a place has.
    [[nodiscard]] const std::vector<Eigen::Index>& own() const { return own_; }

private:
    void once(const Moment& from, Return& sum);

    Runs& runs_;
    const Chart& chart_;
    double start_, length_;
    std::optional<Section> section_;
    Eigen::VectorXd units_, there_;
    std::vector<Eigen::Index> own_;  // of all of y: what a place has
    std::optional<model::WantedEvent> passage_;
};

/// Ends a run that passes the section.
model::WantedEvent passage(const Chart& chart, const Returns::Section& section, bool named);

/// M with relays that begin switched on or off as they are there.
std::vector<bool> relays_of(const model::Excitation& excitation);
model::Excitation with_relays(const model::Excitation& excitation, const std::vector<bool>& on);

/// How far one stretch of a run gets, at so many looks: of each measured number.
struct Reach {
    Eigen::VectorXd low, high;
    [[nodiscard]] Eigen::VectorXd range() const { return high - low; }
};
Reach reach_of(const Runs::Run& run, const Chart& chart, int looks = 512);
/// The same of the rows of a run, of angles and velocities only.
Reach reach_of_rows(const Runs::Run& run, const Chart& chart);
/// The angle that changes most beside its size, or a velocity where no angle is measured; -1: none changes.
Eigen::Index widest_of(const Reach& reach, const Chart& chart, Eigen::Index bodies);
/// How the bodies move in a run of one period, or stand and go round evenly.
std::vector<BodyMotion> bodies_of(const Runs::Run& run, const Chart& chart, const Reach& reach);
std::vector<BodyMotion> bodies_at(const Eigen::VectorXd& y, const Chart& chart, Eigen::Index n);

inline constexpr double largest_stable = 1 + 1e-5;  ///< multiplier
/// The greatest one first.
std::vector<std::complex<double>> multipliers_of(const Eigen::MatrixXd& derivative);
/// A motion beside which others are neutral is not the only one.
void note_family(SteadyMotion& motion);
Eigen::VectorXd vector_of(const std::vector<double>& values);
/// Its greatest number.
double size_of_step(const Eigen::VectorXd& step);

/// Of its range, the place of a section: off the middle, where many motions have an end of something.
inline constexpr double section_at = 0.42;

/// What drives a run, and what a user calls it.
struct Acting {
    const char* name;
    const model::Excitation* what;
};
std::vector<Acting> acting_in(const SteadyQuestion& question);

/// When all that drives the run repeats itself: period 0 where nothing depends on the time; none where no period is
/// known. What is a function is looked at at some times: only its user knows its period.
std::optional<Repetition> repetition_of(const SteadyQuestion& question);
/// Asks all of it at times all over the period and one period later: the sentence that names the worst two that differ.
std::optional<text::Error> not_periodic(const SteadyQuestion& question, const Repetition& repeats);
/// `settles` of the question; none where its controllers and what else drives the bodies have no common period, or too
/// long a one.
std::optional<double> settles_after(const SteadyQuestion& question);
/// The question as the search for returns asks it: of a plain system with the longest stretch that its spring allows.
SteadyQuestion for_returns(const SteadyQuestion& question);

/// The motion of all bodies that a run from the start of the question leads to, seen from none of them.
SteadyMotion whole_motion(const SteadyQuestion& question, const motion::Monitor& monitor = {});

}  // namespace dinal::analysis
