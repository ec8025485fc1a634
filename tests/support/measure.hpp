// Runs for tests: simulate() that must succeed, and the error of a run.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "motion/integrators.hpp"
#include "motion/simulate.hpp"
#include "support/catch.hpp"
#include "support/reference_systems.hpp"

namespace dinal::truth {

inline motion::Run must_run(const model::Oscillator& oscillator, const model::Excitation& excitation,
                            const model::State& initial, const motion::Window& window, const motion::Grid& rows,
                            motion::MethodView method) {
    auto run = motion::simulate(oscillator, {excitation, initial}, window, rows, method);
    if (!run) FAIL(run.error().sentence);
    return std::move(run).value();
}

inline motion::Run must_run(const ReferenceSystem& s, const motion::Grid& rows, motion::MethodView method) {
    return must_run(s.oscillator, s.excitation, s.initial, s.window, rows, method);
}

/// The greatest error of a row in theta or velocity/w0, in the units of theta.
inline double error_of(const motion::Run& run, const ExactMotion& exact, const model::Oscillator& oscillator) {
    const double w0 = oscillator.natural_frequency();
    double worst = 0;
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        const Motion y = exact.at(run.rows(i, 0));
        worst = std::max({worst, std::fabs(static_cast<double>(run.rows(i, 1) - y.theta)),
                          std::fabs(static_cast<double>(run.rows(i, 2) - y.velocity)) / w0});
    }
    return worst;
}

}  // namespace dinal::truth
