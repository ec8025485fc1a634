// Benchmarks of dinal beside its peers: interleaved repetitions, then one table and the bars.
//
// Options are those of Google Benchmark: --benchmark_filter=W3 for a part, --benchmark_repetitions=9 for more rounds.
#include <malloc.h>

#include "items.hpp"

int main(int argc, char** argv) {
    // Freed memory stays with the process, so that from the second iteration on rows go to pages that are already
    // there: what is timed is the storing of rows, not the page faults of the kernel (about 25 times as much).
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, -1);

    bench::Results results;
    bench::register_workloads(results);
    bench::register_work(results);

    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
        return 2;
    }
    bench::Collector collector(results);
    benchmark::RunSpecifiedBenchmarks(&collector);
    bench::print_table(results);
    bench::print_bars(results);
    return collector.failed() ? 1 : 0;
}
