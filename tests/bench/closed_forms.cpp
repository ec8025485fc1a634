// The integrator exact under loads of many terms: a record of samples, and Fourier series.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>

#include "dinal_runs.hpp"
#include "items.hpp"

namespace bench {

namespace {

using namespace dinal;

model::Excitation made(model::Term term) {
    auto excitation = model::Excitation::make(std::move(term));
    if (!excitation) {
        std::cerr << "bench: " << excitation.error().sentence << '\n';
        std::exit(1);
    }
    return std::move(excitation).value();
}

/// A smooth record, a hundred samples a natural period.
model::Excitation record(std::size_t samples) {
    model::Samples points;
    for (std::size_t i = 0; i <= samples; ++i) {
        const double t = static_cast<double>(i) / 100;
        points.t.push_back(t);
        points.M.push_back(std::sin(5.1 * t) + 0.4 * std::sin(7.7 * t + 1));
    }
    return made(model::Polyline(std::make_shared<const model::Samples>(std::move(points))));
}

model::Excitation series(int harmonics) {
    model::Excitation sum;
    for (int i = 1; i <= harmonics; ++i) {
        sum = sum + made(model::Harmonic{.amplitude = 1.0 / i / i, .omega = i * omega0});
    }
    return sum;
}

void run_exact(benchmark::State& state, const model::Excitation& M, double periods) {
    const model::Oscillator system = oscillator(workloads[3]);
    for ([[maybe_unused]] auto iteration : state) {
        const auto run = motion::simulate(system, {M, {1, 0}}, {0, periods}, motion::Grid::none(), motion::Exact{}, {},
                                          {.dense = false});
        if (!run) {
            state.SkipWithError(run.error().sentence.c_str());
            break;
        }
        benchmark::DoNotOptimize(run->t_stop);
    }
}

}  // namespace

void register_closed_forms(Results& results) {
    const auto add = [&](const std::string& name, double count, const char* per, const model::Excitation& M,
                         double periods) {
        Item& item = results.of(std::string(closed_forms_group), name);
        item.count = count;
        item.per = per;
        benchmark::RegisterBenchmark((item.group + "/" + name).c_str(),
                                     [M, periods](benchmark::State& state) { run_exact(state, M, periods); });
    };
    constexpr std::size_t samples = 1000000;
    add(std::string(samples_item), samples, "sample", record(samples), 1e4);
    for (const int harmonics : {10, 100, 1000}) {
        const double periods = harmonics == 1000 ? 20 : 100;
        add(std::string(harmonics_item) + std::to_string(harmonics), periods, "period", series(harmonics), periods);
    }
}

}  // namespace bench
