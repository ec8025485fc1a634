// Systems and loads for tests, in few words, and runs that must succeed.
#pragma once

#include <numbers>
#include <utility>

#include "motion/integrators.hpp"
#include "motion/simulate.hpp"
#include "support/catch.hpp"
#include "support/written.hpp"

namespace dinal::truth {

inline model::Oscillator system_of(const model::OscillatorParameters& parameters) {
    return model::Oscillator::make(parameters).value();
}

/// k = 1, T0 = 1: the form of the report's cases.
inline model::Oscillator nondimensional(double zeta, double friction_ratio, double breakaway_ratio) {
    return system_of({.inertia = 1 / (4 * std::numbers::pi * std::numbers::pi),
                      .stiffness = 1,
                      .damping = zeta / std::numbers::pi,  // 2 zeta sqrt(I k)
                      .kinetic_friction = friction_ratio,
                      .breakaway = breakaway_ratio});
}
inline model::Oscillator nondimensional(double zeta, double friction_ratio) {
    return nondimensional(zeta, friction_ratio, friction_ratio);
}

/// amplitude sin(omega t + phase)
inline model::Excitation harmonic(double amplitude, double omega, double phase = 0) {
    return native(model::Harmonic{.amplitude = amplitude, .omega = omega, .phase = phase});
}

inline motion::Run must_run(const model::Oscillator& oscillator, const model::Excitation& excitation,
                            const model::State& initial, const motion::Window& window, const motion::Grid& rows,
                            motion::MethodView method) {
    auto run = motion::simulate(oscillator, {excitation, initial}, window, rows, method);
    if (!run) FAIL(run.error().sentence);
    return std::move(run).value();
}

}  // namespace dinal::truth
