// Plots of a million rows.
#include <benchmark/benchmark.h>

#include <chrono>
#include <memory>
#include <string>

#include "dinal_runs.hpp"
#include "items.hpp"
#include "plots/painter.hpp"
#include "plots/run_figure.hpp"
#include "plots/text_plot.hpp"

namespace bench {
namespace {

const Workload& driven_motion = workloads[3];

/// W4 with its 1e6 rows, and what run:plot() and run:phase_plot() draw of it.
struct Pictures {
    dinal::model::Oscillator system = oscillator(driven_motion);
    dinal::motion::Run run = trajectory(driven_motion, dinal::motion::Spectral{}, dinal::motion::Grid::every(0.001));
    dinal::plots::RunData data{nullptr, &run, system};
    dinal::plots::Figure response = dinal::plots::column_figures(data)->front();
    dinal::plots::Figure phase = *dinal::plots::phase_figure(data);
};

template <class Draw>
void measure(benchmark::State& state, const Draw& draw) {
    using Clock = std::chrono::steady_clock;
    static const auto pictures = std::make_unique<Pictures>();
    for ([[maybe_unused]] auto iteration : state) {
        const auto began = Clock::now();
        const bool drawn = draw(*pictures);
        state.SetIterationTime(std::chrono::duration<double>(Clock::now() - began).count());
        if (!drawn) {
            state.SkipWithError("nothing was drawn");
            break;
        }
    }
}

bool in_terminal(const dinal::plots::Figure& figure) {
    return !dinal::plots::text_plot({&figure, 1}, {}).empty();
}

bool in_svg(const dinal::plots::Figure& figure) {
    return static_cast<bool>(dinal::plots::paint({&figure, 1}, dinal::plots::PictureKind::svg, {}));
}

}  // namespace

void register_plots(Results& results) {
    const auto add = [&](std::string_view name, auto draw) {
        Item& item = results.of(std::string(plots_group), std::string(name));
        item.count = 1e6;
        item.per = "row";
        benchmark::RegisterBenchmark((item.group + "/" + item.name).c_str(), [draw](benchmark::State& state) {
            measure(state, draw);
        })->UseManualTime();
    };
    add(terminal_response, [](const Pictures& pictures) { return in_terminal(pictures.response); });
    add(terminal_phase, [](const Pictures& pictures) { return in_terminal(pictures.phase); });
    add(svg_response, [](const Pictures& pictures) { return in_svg(pictures.response); });
    add(svg_phase, [](const Pictures& pictures) { return in_svg(pictures.phase); });
}

}  // namespace bench
