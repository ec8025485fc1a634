// Short words for tests of systems with walls.
#pragma once

#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/catch.hpp"
#include "support/measure.hpp"

namespace dinal::truth {

using model::Event;
using model::EventKind;
using model::Excitation;
using model::Oscillator;
using model::Walls;
using motion::Integrator;
using motion::Trajectory;

inline constexpr double pi = std::numbers::pi;
inline constexpr double none = std::numeric_limits<double>::infinity();

inline Oscillator walled(const Walls& walls, double k = 0, double Rd = 0, double Re = 0) {
    return system_of({.inertia = 1, .stiffness = k, .kinetic_friction = Rd, .breakaway = Re, .walls = walls});
}
inline Excitation constant(double level) {
    return Excitation::make(model::Constant{level}).value();
}
inline Excitation ramp(double slope, double at) {
    return Excitation::make(model::Ramp{.slope = slope, .at = at}).value();
}
inline std::vector<Event> of_kind(const Trajectory& run, EventKind kind) {
    std::vector<Event> found;
    for (const Event& event : run.events) {
        if (event.kind == kind) found.push_back(event);
    }
    return found;
}
inline std::string kinds_told(const Trajectory& run) {
    std::string text;
    for (const Event& event : run.events) text.append(name(event.kind)) += ' ';
    return text;
}

/// With what each is right to: times and velocities of impacts, for spectral and for rk4.
inline const std::vector<std::pair<Integrator, double>> methods_at_walls = {{motion::Spectral{}, 1e-12},
                                                                            {motion::Rk4{0.002}, 1e-8}};

}  // namespace dinal::truth
