#include "motion/engine/affine_block.hpp"

#include <algorithm>
#include <cmath>

namespace dinal::motion::engine {

StepTimes::StepTimes(const Window& of, double step) : window(of), h(step) {
    const double ratio = (window.end - window.start) / h;
    const double whole = std::round(ratio);
    // A remainder within the rounding of the division is ignored.
    const double steps = std::fabs(ratio - whole) <= 4e-16 * whole ? whole : std::ceil(ratio);
    count = static_cast<std::size_t>(std::clamp(steps, 1.0, 9e18));
}

std::size_t StepTimes::at(double t) const {
    auto step = static_cast<std::size_t>((t - window.start) / h);
    while (step > 0 && time(step) > t) --step;
    while (step < count && time(step + 1) <= t) ++step;
    return step;
}

std::size_t AffineBlock::sample(const model::Excitation& M_of_time, const StepTimes& steps, std::size_t n,
                                std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        times[2 * i] = steps.time(n + i) + map.h / 2;
        times[2 * i + 1] = steps.time(n + i + 1);
    }
    return M_of_time.fill({times.data(), 2 * count}, {samples.data(), 2 * count}) / 2;
}

void AffineBlock::begin(std::size_t i, std::size_t count, const model::State& y, double M_there, double friction) {
    const AffineStep full = map;
    const auto force = [friction, by = inverse_inertia](double torque) { return (torque - friction) * by; };
    M[i] = M_there;
    for (std::size_t j = i; j < count; ++j) M[j + 1] = samples[2 * j + 1];
    for (std::size_t j = i; j <= count; ++j) forcing[j] = force(M[j]);
    for (std::size_t j = i; j < count; ++j) {
        const double middle = force(samples[2 * j]);
        push_theta[j] = full.push_theta(forcing[j], middle);
        push_velocity[j] = full.push_velocity(forcing[j], middle, forcing[j + 1]);
    }
    theta[i] = y.theta;
    velocity[i] = y.velocity;
}

// NOTE: plain local doubles; with a State in the loop g++ 12 keeps the motion in memory and takes twice as long.
std::size_t AffineBlock::step(std::size_t i, std::size_t stop, double direction) {
    const AffineStep m = map;
    double q = theta[i], v = velocity[i];
    double uphill = direction * ((forcing[i] - m.c * v) - m.w * q);  // acceleration along the motion
    for (; i < stop; ++i) {
        const double q1 = (q + push_theta[i]) + (m.r11 * q + m.r12 * v);
        const double v1 = (v + push_velocity[i]) + (m.r21 * q + m.r22 * v);
        const double uphill1 = direction * ((forcing[i + 1] - m.c * v1) - m.w * q1);
        if (!(direction * v1 > 0) || (uphill < 0 && uphill1 > 0)) break;
        theta[i + 1] = q = q1;
        velocity[i + 1] = v = v1;
        uphill = uphill1;
    }
    return i;
}

}  // namespace dinal::motion::engine
