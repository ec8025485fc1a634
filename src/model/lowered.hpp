// A system as the integrators see it: a linear part, a constant friction each way, and a remainder for all else.
//
//     I theta'' + C theta' + k theta = M - braking(way) - remainder(way, state)    while it moves this way
//
// The remainder is what friction has beside its constant, and a spring of its own beside k theta. This is the one place
// where a model is lowered. An integrator solves the linear part and the constant its own fast way; a remainder that is
// not empty is asked along with a feedback.
#pragma once

#include <array>

#include "model/oscillator.hpp"

namespace dinal::model {

class Lowered {
public:
    /// The system must outlive it.
    Lowered(const Oscillator& system)  // NOLINT(google-explicit-constructor): the same system, seen from closer by
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

    [[nodiscard]] double inertia() const { return inertia_; }
    [[nodiscard]] double damping() const { return damping_; }
    [[nodiscard]] double stiffness() const { return stiffness_; }
    /// The constant torque of friction while the mass moves this way, with the sign of the motion; 0 while stuck.
    [[nodiscard]] double braking(Motion way) const { return braking_[index(way)]; }
    /// The most that sticking can hold against a pull this way.
    [[nodiscard]] double holding(Motion way) const { return holding_[index(way)]; }
    [[nodiscard]] double greatest_holding() const {
        return std::max(holding(Motion::forward), holding(Motion::backward));
    }
    /// Velocity zero means something: the friction law must be asked there. Without it the mass swings through.
    [[nodiscard]] bool dry() const { return dry_; }

    [[nodiscard]] bool has_remainder() const { return friction_ != nullptr || spring_ != nullptr; }
    /// What the linear part and the constant torque leave out. Only while moving.
    [[nodiscard]] double remainder(Motion way, const State& state) const {
        return friction_remainder(way, state) + spring(state.theta);
    }
    [[nodiscard]] bool has_spring() const { return spring_ != nullptr; }
    /// Of the friction alone, 0 at velocity zero.
    [[nodiscard]] double friction_remainder(Motion way, const State& state) const {
        if (friction_ == nullptr) return 0;
        const double sign = sign_of(way);
        return sign * friction_->sliding(way, sign * state.velocity) - braking(way);
    }
    /// The torque of the spring besides k theta, against theta where it is positive.
    [[nodiscard]] double spring(double theta) const { return spring_ == nullptr ? 0 : spring_->torque(theta); }
    /// What it has stored, torque times rad.
    [[nodiscard]] double spring_energy(double theta) const { return spring_ == nullptr ? 0 : spring_->energy(theta); }
    /// All that springs pull back with: k theta and that.
    [[nodiscard]] double pull_back(double theta) const {
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
