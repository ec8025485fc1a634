#include "theory/theory_steps.hpp"

#include <cmath>
#include <numbers>

namespace dinal::theory {

namespace {

double greatest_velocity(const model::Oscillator& system, const model::State& initial) {
    return std::hypot(system.natural_frequency() * initial.theta, initial.velocity);
}

/// Without friction what divides by the velocity is 0, also when nothing moves.
double friction_term(double friction, double velocity) {
    return friction == 0 ? 0 : friction / velocity;
}

}  // namespace

double printed_step_limit(const model::Oscillator& system, const model::State& initial, double characteristic_torque) {
    const double gamma = system.kinetic_friction() == 0 ? 0 : system.friction_ratio(characteristic_torque);
    return system.natural_period() *
           (system.damping_ratio() + friction_term(gamma, greatest_velocity(system, initial)));
}

double euler_step_limit(const model::Oscillator& system, const model::State& initial) {
    return system.natural_period() * system.damping_ratio() / std::numbers::pi +
           friction_term(system.kinetic_friction() / system.stiffness(), greatest_velocity(system, initial));
}

}  // namespace dinal::theory
