// A system as the integrators see it: a linear part, a constant friction each way, and a remainder.
//
//     I theta'' + C theta' + k theta = M - braking(way) - remainder(way, state)    while it moves this way
//
// The remainder is the friction beyond its constant, and a nonlinear spring. Models are lowered only here. An
// integrator solves the linear part with the constant in its own fast way and evaluates a non-empty remainder along
// with feedback.
#pragma once

#include <array>

#include "model/oscillator.hpp"

namespace dinal::model {

class Lowered {
public:
    /// The system must outlive it.
    Lowered(const Oscillator& system)  // NOLINT(google-explicit-constructor): a view of the same system
        : inertia_(system.inertia()), damping_(system.damping()), stiffness_(system.stiffness()) {
        const Friction& law = system.friction();
        for (const Motion way : {Motion::backward, Motion::forward}) {
            braking_[index(way)] = sign_of(way) * law.sliding(way, 0);
            holding_[index(way)] = law.holding(way);
        }
        if (law.depends_on_speed()) friction_ = &law;
        dry_ = friction_ != nullptr || greatest_holding() != 0;  // the law is not none()
        if (!system.spring().none()) spring_ = &system.spring();
    }

    double inertia() const { return inertia_; }
    double damping() const { return damping_; }
    double stiffness() const { return stiffness_; }
    /// The constant friction torque while moving this way, with the sign of the motion; 0 while stuck.
    double braking(Motion way) const { return braking_[index(way)]; }
    /// The largest pull this way that sticking can hold.
    double holding(Motion way) const { return holding_[index(way)]; }
    double greatest_holding() const { return std::max(holding(Motion::forward), holding(Motion::backward)); }
    /// Returns whether friction must be evaluated at velocity zero; otherwise the mass swings through.
    bool dry() const { return dry_; }

    bool has_remainder() const { return friction_ != nullptr || spring_ != nullptr; }
    /// The torque beyond the linear part and the constant. Only while moving.
    double remainder(Motion way, const State& state) const {
        return friction_remainder(way, state) + spring(state.theta);
    }
    bool has_spring() const { return spring_ != nullptr; }
    /// The friction part of the remainder; 0 at velocity zero.
    double friction_remainder(Motion way, const State& state) const {
        if (friction_ == nullptr) return 0;
        const double sign = sign_of(way);
        return sign * friction_->sliding(way, sign * state.velocity) - braking(way);
    }
    /// The nonlinear spring torque, positive against theta.
    double spring(double theta) const { return spring_ == nullptr ? 0 : spring_->torque(theta); }
    /// The energy stored in the nonlinear spring, torque times rad.
    double spring_energy(double theta) const { return spring_ == nullptr ? 0 : spring_->energy(theta); }
    /// The torque of all springs, k theta included.
    double pull_back(double theta) const {
        return spring_ == nullptr ? stiffness_ * theta : stiffness_ * theta + spring_->torque(theta);
    }

private:
    static constexpr std::size_t index(Motion way) {
        return way == Motion::backward ? 0 : way == Motion::stuck ? 1 : 2;
    }

    double inertia_, damping_, stiffness_;
    std::array<double, 3> braking_{}, holding_{};
    bool dry_ = false;
    const Friction* friction_ = nullptr;
    const Spring* spring_ = nullptr;
};

}  // namespace dinal::model
