// dinal at the same work as its peers.
#pragma once

#include "peers.hpp"

namespace bench {

extern const Peer dinal_exact;
extern const Peer dinal_spectral;
extern const Peer dinal_rk4;         ///< h = .001
extern const Peer dinal_rk4_coarse;  ///< h = .01
extern const Peer dinal_1989;        ///< h = .001

}  // namespace bench
