// Named systems with an exact answer: every integrator is measured against every one of them.
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
    std::vector<Piece> drives;  ///< the same excitation, for the closed form
    model::State initial;
    motion::Window window;
    double size;  ///< the greatest angle to expect: errors are counted in it
    /// Whose motion it is, where a feedback does what friction would do.
    std::optional<model::Oscillator> same_as = {};

    /// The system whose closed form it is.
    [[nodiscard]] const model::Oscillator& law() const { return same_as ? *same_as : oscillator; }
    [[nodiscard]] ExactMotion exact() const { return ExactMotion(law(), drives, initial, window.start, window.end); }
    /// The fastest thing that goes on, rad per time unit: swing, load, or the creep of an overdamped system.
    [[nodiscard]] double fastest_rate() const;
    /// w0 times the length of the window.
    [[nodiscard]] double radians() const { return oscillator.natural_frequency() * (window.end - window.start); }
};

/// k = 1, T0 = 1: the form in which the report states its cases.
model::Oscillator nondimensional(double zeta, double friction_ratio, double breakaway_ratio);
inline model::Oscillator nondimensional(double zeta, double friction_ratio) {
    return nondimensional(zeta, friction_ratio, friction_ratio);
}
model::Oscillator system_of(const model::OscillatorParameters& parameters);

/// amplitude sin(omega t + phase), as dinal and as the closed form have it.
model::Excitation harmonic(double amplitude, double omega, double phase = 0);
std::vector<Piece> harmonic_drive(double amplitude, double omega, double phase = 0);
/// M = sin 2 pi t.
inline constexpr double resonance = 6.283185307179586;

const std::vector<ReferenceSystem>& reference_systems();
const ReferenceSystem& reference_system(std::string_view name);

/// Systems in which M takes over a part of sliding friction: it jumps when the velocity is zero.
const std::vector<ReferenceSystem>& jumping_feedback_systems();

}  // namespace dinal::truth
