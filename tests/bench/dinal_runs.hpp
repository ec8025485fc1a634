// dinal at the same work as its peers.
#pragma once

#include "motion/integrators.hpp"
#include "motion/simulate.hpp"
#include "peers.hpp"

namespace bench {

extern const Peer dinal_exact;
extern const Peer dinal_spectral;
extern const Peer dinal_rk4;         ///< h = .001
extern const Peer dinal_rk4_coarse;  ///< h = .01
extern const Peer dinal_1989;        ///< h = .001

dinal::model::Oscillator oscillator(const Workload& work);

/// A run of the work with rows; ends the program with the reason when dinal refuses it.
dinal::motion::Run trajectory(const Workload& work, const dinal::motion::Integrator& integrator,
                              const dinal::motion::Grid& rows);

}  // namespace bench
