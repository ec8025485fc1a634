// dinal at the same work as its peers: the whole simulate(), no rows kept.

#include <cstdlib>
#include <iostream>

#include "comparison.hpp"
#include "dinal_runs.hpp"
#include "motion/integrators.hpp"
#include "motion/simulate.hpp"

namespace bench {

using namespace dinal;
using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::text;

namespace {

template <class T>
T need(Expected<T> result) {
    if (!result) {
        std::cerr << "bench: " << result.error().sentence << '\n';
        std::exit(1);
    }
    return std::move(result).value();
}

Excitation excitation(const Workload& work) {
    return work.driven ? need(Excitation::make(Harmonic{.amplitude = 1, .omega = omega0})) : Excitation();
}

// k = 1 and I = 1/w0^2: times are in natural periods, angles in Mc/k.
Oscillator oscillator(const Workload& work) {
    const double inertia = 1 / (omega0 * omega0);
    return need(Oscillator::make({.inertia = inertia,
                                  .stiffness = 1,
                                  .damping = 2 * work.zeta * omega0 * inertia,
                                  .kinetic_friction = work.friction_ratio}));
}

Run run_of(const Workload& work, const Integrator& integrator, const Grid& rows) {
    return need(simulate(oscillator(work), {excitation(work), {work.u0, work.v0}}, {0, work.length}, rows, integrator));
}

double run(const Workload& work, const Integrator& integrator) {
    return run_of(work, integrator, Grid::none()).t_stop;
}

double error(const Workload& work, const Integrator& integrator) {
    const Run run = run_of(work, integrator, Grid::every(0.01));
    const auto t = run.column(Column::t), theta = run.column(Column::theta);
    Comparison watch(work);
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        watch(t[i], theta[i]);
    }
    return watch.error();
}

}  // namespace

const Peer dinal_exact = {"dinal exact", [](const Workload& work) { return run(work, Exact{}); },
                          [](const Workload& work) { return error(work, Exact{}); }};
const Peer dinal_spectral = {"dinal spectral", [](const Workload& work) { return run(work, Spectral{}); },
                             [](const Workload& work) { return error(work, Spectral{}); }};
const Peer dinal_rk4 = {"dinal rk4, h = .001", [](const Workload& work) { return run(work, Rk4{0.001}); },
                        [](const Workload& work) { return error(work, Rk4{0.001}); }};
const Peer dinal_rk4_coarse = {"dinal rk4, h = .01", [](const Workload& work) { return run(work, Rk4{0.01}); },
                               [](const Workload& work) { return error(work, Rk4{0.01}); }};
const Peer dinal_1989 = {"dinal dinal1989, h = .001",
                         [](const Workload& work) { return run(work, Dinal1989{.h = 0.001}); },
                         [](const Workload& work) { return error(work, Dinal1989{.h = 0.001}); }};

}  // namespace bench
