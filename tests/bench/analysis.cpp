// The cost of analyses: steady motions over the plane of frequency and friction, natively and as a sweep in Lua, a
// response curve, and the fit of a free decay.
#include <benchmark/benchmark.h>

#include <memory>
#include <random>
#include <string>

#include "analysis/identification.hpp"
#include "analysis/steady.hpp"
#include "dinal_runs.hpp"
#include "items.hpp"
#include "lua_state.hpp"

namespace bench {
namespace {

using namespace dinal;

constexpr int side = 200;  // of the plane, in points

template <class T>
T good(text::Expected<T> result, benchmark::State& state) {
    if (!result) state.SkipWithError(result.error().sentence.c_str());
    return std::move(result).value();
}

model::Oscillator with_friction(double gamma) {
    Workload work = workloads[1];
    work.zeta = 0;
    work.friction_ratio = gamma;
    return oscillator(work);
}

void steady_plane(benchmark::State& state) {
    for ([[maybe_unused]] auto iteration : state) {
        double sum = 0;
        for (int i = 0; i < side; ++i) {
            const model::Oscillator system = with_friction(1.2 * i / (side - 1));
            for (int j = 0; j < side; ++j) {
                const double r = 0.2 + 2.8 * j / (side - 1);
                const auto M = model::Excitation::make(model::Harmonic{.amplitude = 1, .omega = r * omega0});
                sum += analysis::steady_motion(analysis::SteadyQuestion::of(system, *M, {0, 1 / r})).amplitude;
            }
        }
        benchmark::DoNotOptimize(sum);
    }
}

void free_decay(benchmark::State& state) {
    const auto system =
        model::Oscillator::make({.inertia = 1, .stiffness = 40, .damping = 0.3, .kinetic_friction = 0.8});
    const auto run = good(motion::simulate(*system, {model::Excitation(), {1, 0}}, {0, 8},
                                           motion::Grid::every(8. / 999), motion::Exact{}),
                          state);
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise(0, 0.01);
    analysis::IdentifyQuestion question;
    const auto t = run.column(motion::Column::t), theta = run.column(motion::Column::theta);
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        question.t.push_back(t[i]);
        question.theta.push_back(theta[i] + noise(random));
    }
    for ([[maybe_unused]] auto iteration : state) {
        benchmark::DoNotOptimize(analysis::identify(question)->noise);
    }
}

// The sweep of the plane with so many workers, a response of 300 points, and a sweep with nothing to do.
constexpr const char* questions = R"(
local r, g = vector.linspace(0.2, 3, 200), vector.linspace(0, 1.2, 200)
local function point(p)
    local s = nondimensional{ friction_ratio = p.g }:steady{ M = excitation.harmonic{ frequency = p.r } }
    return { A = s.amplitude, stops = s.stops }
end
local nothing = { 1 }
-- A point that fails is a row all the same, and a fast one.
local function whole(d)
    local errors = d.error
    for i = 1, #d do
        if errors[i] ~= "" then error(errors[i], 0) end
    end
end
return function(workers) whole(sweep{ over = { r = r, g = g }, workers = workers, run = point }) end,
       function() return nondimensional{ friction_ratio = 0.5 }:response{ over = { frequency = vector.linspace(0.1, 3, 300) }, between = true } end,
       function() return sweep{ over = { x = nothing }, workers = 1, run = function(p) return { y = p.x } end } end
)";

void ask(LuaState& lua, benchmark::State& state, int function, int workers) {
    for ([[maybe_unused]] auto iteration : state) {
        if (!lua.call(function, workers)) return state.SkipWithError(lua.failure().c_str());
    }
}

}  // namespace

void register_analysis(Results& results) {
    const auto add = [&](std::string_view name, double count, const char* per, auto run) {
        Item& item = results.of(std::string(analysis_group), std::string(name));
        item.count = count;
        item.per = per;
        return benchmark::RegisterBenchmark((item.group + "/" + item.name).c_str(), run);
    };
    constexpr double points = side * side;
    add(steady_native, points, "point", steady_plane);
    const auto own = std::make_shared<LuaState>(questions);
    const auto asking = [&](int function, int workers) {
        return [own, function, workers](benchmark::State& state) { ask(*own, state, function, workers); };
    };
    // By the wall clock: that of the process counts both workers.
    add(sweep_one_worker, points, "point", asking(1, 1))->UseRealTime();
    add(sweep_two_workers, points, "point", asking(1, 2))->UseRealTime();
    add(sweep_of_nothing, 1, "", asking(3, 1))->UseRealTime();
    add(response_300, 300, "point", asking(2, 0));
    add(identify_1000, 1000, "sample", free_decay);
}

}  // namespace bench
