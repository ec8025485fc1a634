// The period map of one plain body that is linear between events, with its exact derivative. Searches use it because it
// is fast.
//
// A slide is linear, so its derivative is that of the free motion, whatever M is; an event contributes its jump matrix
// (Aizerman and Gantmakher). With walls the derivative is computed by differences.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/forced_search.hpp"
#include "analysis/recurrence.hpp"
#include "analysis/steady.hpp"
#include "model/lowered.hpp"
#include "motion/integrators.hpp"
#include "motion/simulate.hpp"

namespace dinal::analysis {

/// theta and velocity/omega: the distance of two places is the root of an energy.
using Place = Eigen::Vector2d;

/// Its norm without overflow or underflow.
inline double length_of(const Place& place) {
    return std::hypot(place[0], place[1]);
}

/// Moves a place between the walls.
inline Place inside(const model::Oscillator& system, Place place) {
    if (const auto& walls = system.walls()) place[0] = std::clamp(place[0], walls->lower, walls->upper);
    return place;
}

/// One return of a period map.
struct MapStep {
    Place to = Place::Zero();
    Eigen::Matrix2d derivative = Eigen::Matrix2d::Identity();
    bool differentiable = true;    ///< whether `derivative` is valid; otherwise use differences
    bool finished = true;          ///< whether the run reached its end with finite numbers
    bool moved = true;             ///< whether the mass moved at any time
    bool has_corner = false;       ///< whether the map is not smooth here: the mass turns exactly as M jumps
    bool on_edge = false;          ///< whether the mass rests at the limit of friction: the derivative is one-sided
    double low = 0, high = 0;      ///< the extremes of theta
    double t_low = 0, t_high = 0;  ///< times of the extremes
    std::size_t stops = 0;
    double stuck = 0;  ///< total time at rest, time units
    model::Outcome outcome = model::Outcome::reached_end;
};

class PeriodMap final : public Map {
public:
    /// Returns whether this map applies: one plain body that is linear between events, under an M of time alone.
    static bool applies_to(const SteadyQuestion& question);

    /// A map over `periods` of M. The question must outlive it.
    PeriodMap(const SteadyQuestion& question, double periods, const motion::Monitor& monitor);
    /// A map to the opposite of the state half a period later, for a symmetric problem.
    static PeriodMap half(const SteadyQuestion& question, const motion::Monitor& monitor);

    /// Makes one return and determines all its properties.
    MapStep step(const Place& from) const;

    // As a Map; places are divided by the size of the motion.
    Return operator()(const Eigen::VectorXd& from, const std::optional<HeldMode>& mode, int returns) override;
    std::optional<Derivative> derivative(const Eigen::VectorXd& at, const std::optional<HeldMode>& mode, int returns,
                                         int order) override;
    double rounding() const override { return rounding_of_place() / unit_; }
    /// Sets the unit of places to the size of the motion that begins here; returns its first place.
    Return measured(const Place& from);
    Place place(const Eigen::VectorXd& of_map) const { return inside(system_, unit_ * of_map); }
    /// The size of the motion of a step.
    static double size_of(const Place& from, const MapStep& step);

    double length() const { return length_; }
    bool is_half() const { return sign_ < 0; }
    /// The rounding of a place at which a linear spring and friction are in balance.
    double rounding_of_place() const;
    model::State state(const Place& place) const { return {place[0], place[1] * omega_}; }
    Place place(const model::State& state) const { return {state.theta, state.velocity / omega_}; }
    /// A contradiction of a user's function found in any run so far.
    const std::optional<model::Contradiction>& contradiction() const { return contradiction_; }

private:
    PeriodMap(const SteadyQuestion& question, double length, double sign, const motion::Monitor& monitor);
    MapStep computed(const Place& from) const;
    MapStep step_of_run(const motion::Run& run, const std::vector<Stretch>& parts) const;
    void differentiate(const std::vector<Stretch>& parts, MapStep& step) const;
    Eigen::Matrix2d free_motion(double length) const;
    double M_around(double t) const;
    double slope_before(double t) const;
    bool jumps_at(double t, double pull) const;

    const model::Oscillator& system_;
    model::Lowered lowered_;
    mutable model::Drive drive_;     // drive of the last run
    motion::Integrator integrator_;  // the default
    double start_, length_, sign_, omega_;
    double unit_ = 1;
    motion::Monitor monitor_;
    mutable std::optional<model::Contradiction> contradiction_;
    mutable std::optional<std::pair<Place, MapStep>> last_;
};

/// Finds the motion that a run from the start of the question leads to, by the period map. `near`: the start is near
/// the answer, and a stable motion there is wanted. Requires PeriodMap::applies_to().
SteadyMotion motion_by_periods(const SteadyQuestion& question, bool near, const motion::Monitor& monitor);

}  // namespace dinal::analysis
