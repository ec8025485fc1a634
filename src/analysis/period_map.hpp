// The period map: where a state of the mass gets in one period of M, with its exact derivative.
//
// A free or driven slide is linear, so its derivative is that of the free motion, whatever M is; the derivative of an
// event is a matrix of its own (Aizerman and Gantmakher's jump matrix). Where friction depends on speed, or M on the
// motion, the derivative is taken by differences.
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

/// theta and velocity/omega, which are of one kind: a distance of these is the root of an energy.
using Place = Eigen::Vector2d;

/// Its squares would be no numbers where it is very large, and none where it is very small.
inline double length_of(const Place& place) {
    return std::hypot(place[0], place[1]);
}

/// The nearest place between the walls.
inline Place inside(const model::Oscillator& system, Place place) {
    if (const auto& walls = system.walls()) place[0] = std::clamp(place[0], walls->lower, walls->upper);
    return place;
}

struct MapStep {
    Place to;
    Eigen::Matrix2d derivative = Eigen::Matrix2d::Identity();
    bool differentiable = true;    ///< else `derivative` says nothing, and differences must
    bool finished = true;          ///< the run reached its end, with finite numbers
    bool moved = true;             ///< at some time
    bool on_edge = false;          ///< it stands where friction can just hold it: the derivative is that of one side
    double low = 0, high = 0;      ///< the extremes of theta
    double t_low = 0, t_high = 0;  ///< of the lowest and the highest one
    std::size_t stops = 0;
    double stuck = 0;  ///< time
    model::Outcome outcome = model::Outcome::reached_end;
};

class PeriodMap {
public:
    /// Of `length` time units from `start`. All of it must outlive the map.
    PeriodMap(const model::Oscillator& system, const model::Excitation& excitation, double start, double length,
              const motion::Monitor& monitor);
    /// The same, of another length.
    PeriodMap(const PeriodMap& other, double length);

    [[nodiscard]] MapStep operator()(const Place& from) const;
    /// The step with its derivative by differences, when the step itself has none. `scale` of the motion.
    [[nodiscard]] MapStep with_derivative(const Place& from, double scale) const;

    [[nodiscard]] double length() const { return length_; }
    [[nodiscard]] double omega() const { return omega_; }  ///< of Place; w0 where there is a spring
    /// Of a place at which a linear spring and friction hold each other.
    [[nodiscard]] double rounding() const;
    [[nodiscard]] model::State state(const Place& place) const { return {place[0], place[1] * omega_}; }
    [[nodiscard]] motion::Trajectory run(const Place& from, double length, bool dense) const;
    /// All of a step but its derivative, from a run of any length.
    [[nodiscard]] MapStep told(const motion::Trajectory& run, const std::vector<Stretch>& parts) const;
    [[nodiscard]] const model::Oscillator& system() const { return system_; }
    [[nodiscard]] const model::Excitation& excitation() const { return drive_.M(); }
    [[nodiscard]] double start() const { return start_; }
    /// What was found of a function that is none, in any of the runs so far.
    [[nodiscard]] const std::optional<model::Contradiction>& contradiction() const { return contradiction_; }

private:
    void differentiate(const std::vector<Stretch>& parts, MapStep& step) const;
    [[nodiscard]] Eigen::Matrix2d free_motion(double length) const;
    [[nodiscard]] double slope_before(double t) const;

    const model::Oscillator& system_;
    model::Lowered lowered_;
    mutable model::Drive drive_;     // of the last run
    motion::Integrator integrator_;  // the usual one
    double start_, length_, omega_;
    motion::Monitor monitor_;
    mutable std::optional<model::Contradiction> contradiction_;
};

}  // namespace dinal::analysis
