// The distance of a peer's motion from the truth, found at the times through which the peer itself passes.
#pragma once

#include "arcs.hpp"
#include "workload.hpp"

namespace bench {

template <class Real>
HarmonicProblem<Real> harmonic_problem(const Workload& work) {
    return {.zeta = Real(work.zeta),
            .friction_ratio = Real(work.friction_ratio),
            .amplitude = Real(work.driven ? 1 : 0),
            .u0 = Real(work.u0),
            .v0 = Real(work.v0),
            .end = Real(work.length)};
}

/// max |u - truth|, in units of Mc/k. Times must not go back.
class Comparison {
public:
    explicit Comparison(const Workload& work) : truth_(harmonic_problem<long double>(work)) {}

    void operator()(double t, double u) {
        // Two hundred looks a period show every error; small steps need not all be compared.
        if (t < next_look_) {
            return;
        }
        next_look_ = t + 0.004999;
        while (truth_.next() < static_cast<long double>(t) && !truth_.at_end()) {
            truth_.advance();
        }
        const double distance = std::fabs(static_cast<double>(truth_.position(t) - static_cast<long double>(u)));
        error_ = std::isnan(distance) ? HUGE_VAL : std::max(error_, distance);
    }

    double error() const { return error_; }

private:
    ArcWalker<long double> truth_;
    double next_look_ = 0;
    double error_ = 0;
};

}  // namespace bench
