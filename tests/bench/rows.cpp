// The cost of keeping rows, and of writing them to a file.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include <unistd.h>

#include "dinal_runs.hpp"
#include "files/csv.hpp"
#include "items.hpp"

namespace bench {
namespace {

const Workload& free_motion = workloads[0];
const Workload& driven_motion = workloads[3];

void keep_rows(benchmark::State& state, const dinal::motion::Grid& grid) {
    benchmark::DoNotOptimize(
        trajectory(free_motion, dinal::motion::Rk4{0.001}, grid).rows.col(0).data());  // warms the memory
    for ([[maybe_unused]] auto iteration : state) {
        benchmark::DoNotOptimize(trajectory(free_motion, dinal::motion::Rk4{0.001}, grid).rows.col(0).data());
    }
}

/// A folder that needs no disk, where there is one.
std::filesystem::path memory_folder() {
    return access("/dev/shm", W_OK) == 0 ? "/dev/shm" : std::filesystem::temp_directory_path();
}

enum class Timed { writing, reading };

void csv(benchmark::State& state, const std::filesystem::path& folder, Timed timed) {
    const dinal::motion::Run run =
        trajectory(driven_motion, dinal::motion::Rk4{0.001}, dinal::motion::Grid::every(0.001));
    const auto columns = dinal::files::named_columns(run.names(), run.rows.matrix());
    const std::string path = (folder / ("dinal-bench-" + std::to_string(getpid()) + ".csv")).string();
    const auto good = [&](const auto& done) {
        if (!done) state.SkipWithError(done.error().sentence.c_str());
        return static_cast<bool>(done);
    };
    if (timed == Timed::reading && !good(dinal::files::write_csv(path, columns))) return;
    for ([[maybe_unused]] auto iteration : state) {
        if (!(timed == Timed::writing ? good(dinal::files::write_csv(path, columns))
                                      : good(dinal::files::read_columns(path)))) {
            break;
        }
    }
    std::remove(path.c_str());
}

}  // namespace

void register_rows(Results& results) {
    const auto add = [&](std::string_view group, const std::string& name, double count, const char* per, auto run) {
        Item& item = results.of(std::string(group), name);
        item.count = count;
        item.per = per;
        benchmark::RegisterBenchmark((item.group + "/" + name).c_str(), run);
    };
    add(rows_group, "W1 without rows", 1e7, "step",
        [](benchmark::State& state) { keep_rows(state, dinal::motion::Grid::none()); });
    add(rows_group, "W1 with a row a step", 1e7, "step",
        [](benchmark::State& state) { keep_rows(state, dinal::motion::Grid::every(0.001)); });
    add(files_group, std::string(csv_in_memory), 1e6, "row",
        [](benchmark::State& state) { csv(state, memory_folder(), Timed::writing); });
    add(files_group, std::string(csv_on_disk), 1e6, "row",
        [](benchmark::State& state) { csv(state, std::filesystem::temp_directory_path(), Timed::writing); });
    add(files_group, std::string(csv_read), 1e6, "row",
        [](benchmark::State& state) { csv(state, memory_folder(), Timed::reading); });
}

}  // namespace bench
