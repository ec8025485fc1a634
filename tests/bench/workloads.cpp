// Every peer and dinal on W1-W4.
#include <benchmark/benchmark.h>

#include <string>

#include "dinal_runs.hpp"
#include "items.hpp"

namespace bench {
namespace {

struct Entry {
    const Peer* peer;
    double h;  // 0: the steps are its own affair
};

const Entry entries[] = {{&inlined_peer, 0.001}, {&odeint_peer, 0},         {&gsl_peer, 0},      {&cvode_peer, 0},
                         {&arcs_peer, 0},        {&rotated_arcs_peer, 0},   {&dinal_exact, 0},   {&dinal_spectral, 0},
                         {&dinal_rk4, 0.001},    {&dinal_rk4_coarse, 0.01}, {&dinal_1989, 0.001}};

void measure(benchmark::State& state, Results& results, const Workload& work, const Peer& peer) {
    Item& item = results.of(std::string(work.name), std::string(peer.name));
    if (item.error < 0) {
        item.error = peer.error(work);  // once, outside of the timing
    }
    for ([[maybe_unused]] auto iteration : state) {
        benchmark::DoNotOptimize(peer.run(work));
    }
}

}  // namespace

void register_workloads(Results& results) {
    for (const Workload& work : workloads) {
        for (const Entry& entry : entries) {
            Item& item = results.of(std::string(work.name), std::string(entry.peer->name));
            if (entry.h > 0) {
                item.per = "step";
                item.count = work.length / entry.h;
            }
            benchmark::RegisterBenchmark((item.group + "/" + item.name).c_str(),
                                         [&results, &work, peer = entry.peer](benchmark::State& state) {
                                             measure(state, results, work, *peer);
                                         });
        }
    }
}

}  // namespace bench
