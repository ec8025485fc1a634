// Periodic motions of any system as fixed points of a map of the whole state: from period to period, or for an
// autonomous system from passage to passage of an angle. docs/theory.md, section 10.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/forced_search.hpp"
#include "analysis/steady.hpp"
#include "motion/engine/history.hpp"

namespace dinal::analysis {

/// The complete state: all of y and the mode; without a mode, it follows from y.
struct FullState {
    Eigen::VectorXd y;
    std::optional<HeldMode> mode = {};
};

/// Runs of the question from any moment.
class Runs {
public:
    Runs(const SteadyQuestion& question, const motion::Monitor& monitor) : question_(question), monitor_(monitor) {}

    const SteadyQuestion& question() const { return question_; }
    const model::System& system() const { return *question_.system; }
    Eigen::Index bodies() const { return static_cast<Eigen::Index>(system().bodies.size()); }
    const std::optional<model::Contradiction>& contradiction() const { return contradiction_; }
    FullState first() const;
    /// The drive of a run that begins at this moment and time.
    model::Drive from(const FullState& moment, double start) const;
    [[nodiscard]] motion::Run run(const FullState& from, double start, double end, const motion::Grid& rows, bool dense,
                                  const std::optional<model::WantedEvent>& section = {});
    /// Continues another run with the memory of its controllers and delays; an empty run means a run from the start.
    [[nodiscard]] motion::Run continued(const motion::Run& before, double start, double end, const motion::Grid& rows,
                                        const std::optional<model::WantedEvent>& section = {});
    [[nodiscard]] static FullState at_stop(const motion::Run& run);
    /// The longest natural period of a body on the stiffness around it; 0 without stiffness.
    double natural_period() const;
    /// The directions in which a moment may be disturbed without leaving its mode: orthonormal columns.
    Eigen::MatrixXd allowed(const HeldMode& mode, Eigen::Index size) const;

private:
    [[nodiscard]] motion::Run run(const model::Drive& drive, double start, double end, const motion::Grid& rows,
                                  bool dense, std::shared_ptr<const motion::engine::Carry> before);

    const SteadyQuestion& question_;
    const motion::Monitor& monitor_;
    std::optional<model::Contradiction> contradiction_;
    motion::engine::Floor floor_;  ///< noise of the last run, for runs that begin almost at rest
};

/// The coordinates of the return map; angles of rotating bodies are measured from another body.
class Chart {
public:
    /// `from` has for each body the body from which its angle is measured; -1: the ground; the body itself: not
    /// measured.
    explicit Chart(std::vector<Eigen::Index> from) : from_(std::move(from)) {}

    bool measures(Eigen::Index k) const {
        return k >= static_cast<Eigen::Index>(from_.size()) || from_[static_cast<std::size_t>(k)] != k;
    }
    bool rotates(Eigen::Index body) const { return from_[static_cast<std::size_t>(body)] >= 0; }
    std::size_t bodies() const { return from_.size(); }
    bool any_rotates() const;
    /// The measured numbers of all of y; 0 for angles that are not measured.
    Eigen::VectorXd measured(const Eigen::VectorXd& y) const;
    /// The reverse of measured(); `there` provides the angles that are not measured.
    Eigen::VectorXd state(const Eigen::VectorXd& x, const Eigen::VectorXd& there) const;
    double value(Eigen::Index k, std::span<const double> y) const;

private:
    std::vector<Eigen::Index> from_;
};

/// Measures bodies from each other if they rotate together and nothing depends on their position. A plain body under M
/// alone is measured from the ground, where a drift is growth, unless the question says that its angle advances.
Chart chart_of(Runs& runs);

/// The map from one return to the next: from period to period, or from passage to passage of a section. A place
/// consists of the measured numbers except that of the section, each in its unit.
class Returns final : public Map {
public:
    /// The surface where a measured number has this value, passed upwards (way = 1) or downwards (-1).
    struct Section {
        Eigen::Index measured = 0;
        double place = 0, way = 1;
    };

    /// A passage must come within `length`. `there` supplies the numbers that a place does not contain.
    Returns(Runs& runs, const Chart& chart, double start, double length, const std::optional<Section>& section,
            Eigen::VectorXd units, Eigen::VectorXd there);

    Eigen::VectorXd place(const Eigen::VectorXd& y) const;
    FullState full_state(const Eigen::VectorXd& place, const std::optional<HeldMode>& mode) const;
    Return operator()(const Eigen::VectorXd& from, const std::optional<HeldMode>& mode, int returns) override;
    /// The first return from a moment that need not be on the section.
    [[nodiscard]] Return arrival(const FullState& from);
    /// If the motions on both sides of a difference have different events, order 4 reduces its step; empty if that does
    /// not help and the slopes differ.
    std::optional<Derivative> derivative(const Eigen::VectorXd& at, const std::optional<HeldMode>& mode, int returns,
                                         int order) override;
    double start() const { return start_; }
    /// Takes the angles and velocities of these bodies from `there` instead of from a place; a return fails if one of
    /// them moves.
    void hold(const std::vector<Eigen::Index>& bodies);
    /// Makes each return end at the opposite of its last place, as after half a period of a symmetric motion.
    void end_at_opposites() { sign_ = -1; }
    /// The indices in y of the numbers of a place.
    const std::vector<Eigen::Index>& own() const { return own_; }

private:
    void once(const FullState& from, Return& sum);

    Runs& runs_;
    const Chart& chart_;
    double start_, length_, sign_ = 1;
    std::optional<Section> section_;
    Eigen::VectorXd units_, there_;
    std::vector<Eigen::Index> own_;   // indices in y of the numbers of a place
    std::vector<Eigen::Index> held_;  // bodies
    std::optional<model::WantedEvent> passage_;
};

/// An event that ends a run at the section.
model::WantedEvent passage(const Chart& chart, const Returns::Section& section, bool named);

/// The switch positions of M's relays; and M with relays that begin in these positions.
std::vector<bool> relays_of(const model::Excitation& excitation);
model::Excitation with_relays(const model::Excitation& excitation, const std::vector<bool>& on);

/// Lowest and highest value of each measured number over a run, sampled at looks + 1 times.
struct Reach {
    Eigen::VectorXd low, high;
    Eigen::VectorXd range() const { return high - low; }
};
Reach reach_of(const motion::Run& run, const Chart& chart, int looks = 512);
/// The same from the rows of a run, for angles and velocities only.
Reach reach_of_rows(const motion::Run& run, const Chart& chart);
/// The angle with the greatest relative change, or a velocity if no angle is measured; -1: nothing changes.
Eigen::Index widest_of(const Reach& reach, const Chart& chart, Eigen::Index bodies);
/// The motion of each body in a run of one period, or its rest or steady rotation.
std::vector<BodyMotion> bodies_of(const motion::Run& run, const Chart& chart, const Reach& reach);
std::vector<BodyMotion> bodies_at(const Eigen::VectorXd& y, const Chart& chart, Eigen::Index n);

inline constexpr double largest_stable = 1 + 1e-5;  ///< greatest stable multiplier
/// The multipliers, the greatest first.
std::vector<std::complex<double>> multipliers_of(const Eigen::MatrixXd& derivative);
/// Marks a motion as one of a family if neighbouring motions are neutral.
void note_family(SteadyMotion& motion);
Eigen::VectorXd vector_of(const std::vector<double>& values);
/// The position of a section within the range: off the middle, where many motions have special points.
inline constexpr double section_at = 0.42;

/// A load or belt of a run, with the user's name for it.
struct Acting {
    const char* name;
    const model::Excitation* what;
};
std::vector<Acting> acting_in(const SteadyQuestion& question);
/// The name of an excitation or a rate that depends on t; empty if there is none. Functions are sampled.
std::string timed_in(const SteadyQuestion& question);

/// The common repetition of everything that drives the run: period 0 if nothing depends on time; empty if unknown.
/// Functions are sampled, as only the user knows their period.
std::optional<Repetition> repetition_of(const SteadyQuestion& question);
/// Compares everything that drives the run over one period with the next; the error names the two values that differ
/// most.
std::optional<text::Error> not_periodic(const SteadyQuestion& question, const Repetition& repeats);
/// The question's `settles`; empty if controllers and drive have no common period, or one that is too long.
std::optional<double> settles_after(const SteadyQuestion& question);
/// The question as searched by returns: for a plain system with the longest stretch that its spring allows.
SteadyQuestion for_returns(const SteadyQuestion& question);

/// The motion that a run from the start of the question leads to: of all bodies, or as seen from the joint of the
/// question.
SteadyMotion motion_by_returns(const SteadyQuestion& question, const motion::Monitor& monitor);

}  // namespace dinal::analysis
