#include "motion/engine/modes.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "algebra/decompositions.hpp"

namespace dinal::motion::engine {

std::vector<model::Oscillator> modes_of(const model::System& system) {
    const auto n = static_cast<Eigen::Index>(system.bodies.size());
    // y' = A y for all angles followed by all velocities.
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    A.topRightCorner(n, n).setIdentity();
    for (const model::Joint& joint : system.joints) {
        for (const model::Weight& on : joint.of) {
            const auto row = n + static_cast<Eigen::Index>(on.body);
            if (system.bodies[on.body].moved) continue;
            for (const model::Weight& turned : joint.of) {
                const auto column = static_cast<Eigen::Index>(turned.body);
                const double share = -on.by * turned.by / system.bodies[on.body].inertia;
                A(row, column) += share * joint.stiffness;
                A(row, n + column) += share * joint.damping;
            }
        }
    }
    std::vector<model::Oscillator> modes;
    for (const std::complex<double>& value : algebra::eigenvalues(A)) {
        if (value.imag() < 0) continue;
        const bool swings = value.imag() > 0;
        const auto mode = model::Oscillator::make({.inertia = 1,
                                                   .stiffness = swings ? std::norm(value) : 0,
                                                   .damping = std::max(0.0, (swings ? -2 : -1) * value.real())});
        if (mode) modes.push_back(*mode);
    }
    return modes;
}

/// Uses the greatest row sum of stiffness over inertia (Gershgorin).
text::Expected<model::Oscillator> no_slower_than_modes(const model::System& system) {
    std::vector<double> sums(system.bodies.size(), 0);
    for (const model::Joint& joint : system.joints) {
        double all = 0;
        for (const model::Weight& turned : joint.of) all += std::fabs(turned.by);
        for (const model::Weight& on : joint.of) {
            if (system.bodies[on.body].moved) continue;
            sums[on.body] += std::fabs(on.by) * all * joint.stiffness / system.bodies[on.body].inertia;
        }
    }
    const double most = sums.empty() ? 0 : *std::max_element(sums.begin(), sums.end());
    return model::Oscillator::make({.inertia = 1, .stiffness = most});
}

}  // namespace dinal::motion::engine
