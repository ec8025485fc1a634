// A system as the integrators see it: a linear part, a constant friction each way, and a remainder for all else.
//
//     I theta'' + C theta' + k theta = M - braking(way) - remainder(way, state)    while it moves this way
//
// This is the one place where a model is lowered. An integrator solves the linear part and the constant its own fast
// way; a remainder that is not empty is asked along with a feedback.
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
        dry_ = !law.none();
        if (law.depends_on_speed()) remainder_ = &law;
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

    [[nodiscard]] bool has_remainder() const { return remainder_ != nullptr; }
    /// What the constant torque leaves out, 0 at velocity zero. Only while moving.
    [[nodiscard]] double remainder(Motion way, const State& state) const {
        if (remainder_ == nullptr) return 0;
        const double sign = sign_of(way);
        return sign * remainder_->sliding(way, sign * state.velocity) - braking(way);
    }

private:
    static constexpr std::size_t index(Motion way) {
        return way == Motion::backward ? 0 : way == Motion::stuck ? 1 : 2;
    }

    double inertia_, damping_, stiffness_;
    std::array<double, 3> braking_{}, holding_{};
    bool dry_ = false;
    const Friction* remainder_ = nullptr;
};

}  // namespace dinal::model
