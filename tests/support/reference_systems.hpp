// Named systems with exact solutions, on which every integrator is tested.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/excitation.hpp"
#include "model/oscillator.hpp"
#include "motion/simulate.hpp"
#include "support/closed_form.hpp"

namespace dinal::truth {

struct ReferenceSystem {
    std::string name;
    model::Oscillator oscillator;
    model::Excitation excitation;
    std::vector<Piece> drives;  ///< the same excitation for the closed form
    model::State initial;
    motion::Window window;
    double size;  ///< the greatest expected angle, the unit of errors
    /// The system with the same motion, if a feedback replaces its friction.
    std::optional<model::Oscillator> same_as = {};

    /// The system of the closed form.
    [[nodiscard]] const model::Oscillator& law() const { return same_as ? *same_as : oscillator; }
    [[nodiscard]] ExactMotion exact() const { return ExactMotion(law(), drives, initial, window.start, window.end); }
    /// The fastest rate, rad per time unit: oscillation, load, or the creep of an overdamped system.
    [[nodiscard]] double fastest_rate() const;
    /// w0 times the length of the window.
    [[nodiscard]] double radians() const { return oscillator.natural_frequency() * (window.end - window.start); }
};

/// k = 1, T0 = 1: the form of the report's cases.
model::Oscillator nondimensional(double zeta, double friction_ratio, double breakaway_ratio);
inline model::Oscillator nondimensional(double zeta, double friction_ratio) {
    return nondimensional(zeta, friction_ratio, friction_ratio);
}
model::Oscillator system_of(const model::OscillatorParameters& parameters);

/// amplitude sin(omega t + phase), for dinal and for the closed form.
model::Excitation harmonic(double amplitude, double omega, double phase = 0);
std::vector<Piece> harmonic_drive(double amplitude, double omega, double phase = 0);
/// M = sin 2 pi t.
inline constexpr double resonance = 6.283185307179586;

const std::vector<ReferenceSystem>& reference_systems();
const ReferenceSystem& reference_system(std::string_view name);

/// Systems in which M replaces a part of sliding friction, so that it jumps at velocity zero.
const std::vector<ReferenceSystem>& jumping_feedback_systems();

}  // namespace dinal::truth
