// dinal at the same work as its peers.
#pragma once

#include "motion/simulate.hpp"
#include "peers.hpp"

namespace bench {

extern const Peer dinal_spectral;
extern const Peer dinal_rk4;         ///< h = .001
extern const Peer dinal_rk4_coarse;  ///< h = .01
extern const Peer dinal_1989;        ///< h = .001

dinal::Oscillator oscillator(const Workload& work);

/// A run of the work with rows; ends the program with the reason when dinal refuses it.
dinal::Trajectory trajectory(const Workload& work, const dinal::Integrator& integrator, const dinal::Grid& rows);

}  // namespace bench
