// Peer: closed-form arcs written by hand for a harmonic, from event to event.
#include "peers.hpp"

namespace bench {
namespace {

template <Looks looks, class Watch>
double integrate(const Workload& work, Watch& watch) {
    ArcWalker<double, looks> arcs(harmonic_problem<double>(work));
    watch(0, arcs.position());
    while (!arcs.at_end()) {
        watch((arcs.start() + arcs.next()) / 2, arcs.position((arcs.start() + arcs.next()) / 2));
        arcs.advance();
        watch(arcs.start(), arcs.position());
    }
    const double last = arcs.position(work.length);
    watch(work.length, last);
    return last;
}

}  // namespace

BENCH_PEER(arcs_peer, "closed-form arcs by hand", integrate<Looks::by_sines>);
BENCH_PEER(rotated_arcs_peer, "the same, looks by rotating phasors", integrate<Looks::by_rotation>);

}  // namespace bench
