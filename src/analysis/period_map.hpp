// The period map: the state after one period of M as a function of the initial state, with its exact derivative.
//
// A slide is linear, so its derivative is that of the free motion, whatever M is; an event contributes its jump matrix
// (Aizerman and Gantmakher). If friction depends on speed, or M on the motion, the derivative is computed by
// differences.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "analysis/stretches.hpp"
#include "model/excitation.hpp"
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

struct MapStep {
    Place to;
    Eigen::Matrix2d derivative = Eigen::Matrix2d::Identity();
    bool differentiable = true;    ///< whether `derivative` is valid; otherwise use differences
    bool finished = true;          ///< whether the run reached its end with finite numbers
    bool moved = true;             ///< whether the mass moved at any time
    bool on_edge = false;          ///< whether it stands at the limit of friction: the derivative is one-sided
    double low = 0, high = 0;      ///< the extremes of theta
    double t_low = 0, t_high = 0;  ///< times of the extremes
    std::size_t stops = 0;
    double stuck = 0;  ///< total time at rest, time units
    model::Outcome outcome = model::Outcome::reached_end;
};

class PeriodMap {
public:
    /// A map over `length` time units from `start`. The arguments must outlive it.
    PeriodMap(const model::Oscillator& system, const model::Excitation& excitation, double start, double length,
              const motion::Monitor& monitor);
    /// The same with another length.
    PeriodMap(const PeriodMap& other, double length);

    [[nodiscard]] MapStep operator()(const Place& from) const;
    /// The step; if it has no derivative, by differences. `scale`: size of the motion.
    [[nodiscard]] MapStep with_derivative(const Place& from, double scale) const;

    [[nodiscard]] double length() const { return length_; }
    [[nodiscard]] double omega() const { return omega_; }  ///< scale of a Place; w0 if there is a spring
    /// The rounding of a place at which a linear spring and friction are in balance.
    [[nodiscard]] double rounding() const;
    [[nodiscard]] model::State state(const Place& place) const { return {place[0], place[1] * omega_}; }
    [[nodiscard]] motion::Run run(const Place& from, double length, bool dense) const;
    /// Everything except the derivative of a step, from a run of any length.
    [[nodiscard]] MapStep step_of_run(const motion::Run& run, const std::vector<Stretch>& parts) const;
    [[nodiscard]] const model::Oscillator& system() const { return system_; }
    [[nodiscard]] const model::Excitation& excitation() const { return drive_.M(); }
    [[nodiscard]] double start() const { return start_; }
    /// A contradiction of a user's function found in any run so far.
    [[nodiscard]] const std::optional<model::Contradiction>& contradiction() const { return contradiction_; }

private:
    void differentiate(const std::vector<Stretch>& parts, MapStep& step) const;
    [[nodiscard]] Eigen::Matrix2d free_motion(double length) const;
    [[nodiscard]] double slope_before(double t) const;

    const model::Oscillator& system_;
    model::Lowered lowered_;
    mutable model::Drive drive_;     // drive of the last run
    motion::Integrator integrator_;  // the default
    double start_, length_, omega_;
    motion::Monitor monitor_;
    mutable std::optional<model::Contradiction> contradiction_;
};

}  // namespace dinal::analysis
