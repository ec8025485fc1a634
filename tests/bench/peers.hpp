// Other solvers for the same work: each peer in a file of its own.
#pragma once

#include <array>
#include <string_view>

#include "comparison.hpp"
#include "workload.hpp"

namespace bench {

/// run() is timed and returns the last position; error() does the same work watched by a Comparison.
struct Peer {
    std::string_view name;
    double (*run)(const Workload&);
    double (*error)(const Workload&);
};

inline constexpr std::string_view baseline = "hand-inlined RK4, h = .001";

extern const Peer inlined_peer;  ///< the scheme of 1989, double precision, everything inlined
extern const Peer odeint_peer;
extern const Peer gsl_peer;
extern const Peer cvode_peer;
extern const Peer arcs_peer;          ///< written as it is written down: sin, cos, Newton
extern const Peer rotated_arcs_peer;  ///< as fast as by hand can be

/// Makes both functions of a peer from integrate<Watch>(work, watch) -> last position.
#define BENCH_PEER(id, title, integrate)                \
    const Peer id = {title,                             \
                     [](const Workload& work) {         \
                         NoWatch watch;                 \
                         return integrate(work, watch); \
                     },                                 \
                     [](const Workload& work) {         \
                         Comparison watch(work);        \
                         integrate(work, watch);        \
                         return watch.error();          \
                     }}

}  // namespace bench
