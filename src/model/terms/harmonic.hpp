// excitation.harmonic: a sine.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// The angle omega (t - at) + phase at `t` + `rest`, in two doubles: one would lose digits far from `at`.
struct Angle {
    double rounded, lack;
};
inline Angle angle_at(double t, double rest, double omega, double at, double phase) {
    const double far = t - at, back = t - far;
    rest += (t - (far + back)) + (back - at);
    const double turned = omega * far, angle = turned + phase, part = angle - turned;
    return {angle, ((turned - (angle - part)) + (phase - part)) + (std::fma(omega, far, -turned) + omega * rest)};
}

/// amplitude sin(omega (t - at) + phase)
struct Harmonic {
    static const TermText about;

    double amplitude = 1, omega = 0, phase = 0, at = 0;

    [[nodiscard]] double angle(double t) const { return omega * (t - at) + phase; }
    [[nodiscard]] double value(double t) const { return amplitude * std::sin(angle(t)); }
    [[nodiscard]] double next_break(double) const { return never; }
    [[nodiscard]] double constant_from() const { return omega == 0 ? -never : never; }
    [[nodiscard]] double most() const { return std::fabs(amplitude); }
    [[nodiscard]] double repeats_after() const { return omega == 0 ? 0 : two_pi / std::fabs(omega); }
    [[nodiscard]] Detail detail() const { return no_detail; }
    template <class Sum>
    void closed_form(double /*inside*/, Sum& sum) const {
        sum.add_sine(amplitude, omega, at, phase);
    }
    void delay_by(double d) { phase -= omega * d; }
    [[nodiscard]] std::string formula(double gain) const {
        const std::string shift = phase == 0 ? "" : (phase < 0 ? " - " : " + ") + number(std::fabs(phase));
        return factor(gain * amplitude) + "sin(" + number(omega) + " " + since(at) + shift + ")";
    }
};

inline void omega_of_frequency(Harmonic& h, double frequency) {
    h.omega = two_pi * frequency;
}

inline void omega_of_period(Harmonic& h, double period) {
    h.omega = two_pi / period;
}

inline constexpr text::Option harmonic_options[] = {
    rows::amplitude<Harmonic>(),
    {"frequency", rows::cycles, text::needed, text::not_negative, "omega / (2 pi)", text::sets<omega_of_frequency>},
    {.name = "omega",
     .unit = "rad per time unit",
     .otherwise = text::needed,
     .range = text::not_negative,
     .meaning = "2 pi frequency",
     .filled = text::fills<&Harmonic::omega>,
     .instead_of_previous = true},
    {.name = "period",
     .unit = rows::time,
     .otherwise = text::needed,
     .range = text::positive,
     .meaning = "1/frequency",
     .filled = text::sets<omega_of_period>,
     .instead_of_previous = true},
    {.name = "phase", .unit = "rad", .meaning = "at t = 0", .filled = text::fills<&Harmonic::phase>},
};
inline constexpr TermText Harmonic::about{
    {"excitation.harmonic", "excitation.harmonic{ amplitude = 1, frequency = 1 }", harmonic_options},
    "amplitude sin(omega t + phase). Give frequency (cycles per time unit), "
    "omega (rad per time unit) or period; phase is in rad.",
    "print(excitation.harmonic{ amplitude = 3, frequency = 0.25 }(1))  --> 3.0"};

}  // namespace dinal::model::terms
