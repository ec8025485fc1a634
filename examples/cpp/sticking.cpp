// A mass on a spring is let go at 1 rad and pushed to and fro: what happened, the angle between two rows, the story.
#include <dinal/analysis/explain.hpp>
#include <dinal/motion/integrators.hpp>
#include <dinal/motion/simulate.hpp>
#include <iostream>

int main() {
    using namespace dinal;
    const auto system = model::Oscillator::make({.inertia = 1, .stiffness = 4, .kinetic_friction = 0.3, .breakaway = 0.5});
    const auto M = model::Excitation::make(model::Harmonic{.amplitude = 0.6, .omega = 0.5});
    if (!system || !M) return 1;
    const motion::Integrator integrator = motion::integrator_for(*system, *M);  // or motion::Rk4{.h = 0.01}
    const auto run = motion::simulate(*system, {*M, {.theta = 1}}, {0, 20}, motion::Grid::every(0.01), integrator);
    if (!run) {
        std::cerr << run.error().message() << '\n';
        return 1;
    }
    for (const model::Event& event : run->events)
        std::cout << name(event.kind) << " at t = " << event.t << ", theta = " << event.theta << '\n';
    std::cout << "theta(1.2345) = " << run->at(1.2345)->theta << "\n\n"
              << analysis::explain(*run, *system, *M, integrator) << '\n';
}
