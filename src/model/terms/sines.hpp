// Terms of sines: excitation.harmonic, half_sine and chirp.
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

    double angle(double t) const { return omega * (t - at) + phase; }
    double value(double t) const { return amplitude * std::sin(angle(t)); }
    double next_break(double) const { return never; }
    double constant_from() const { return omega == 0 ? -never : never; }
    double most() const { return std::fabs(amplitude); }
    double repeats_after() const { return omega == 0 ? 0 : two_pi / std::fabs(omega); }
    template <class Sum>
    void closed_form(double /*inside*/, Sum& sum) const {
        sum.add_sine(amplitude, omega, at, phase);
    }
    void delay_by(double d) { phase -= omega * d; }
    std::string formula(double gain) const {
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

/// one half wave of a sine over [at, at + width], otherwise 0
struct HalfSine {
    static const TermText about;

    double amplitude = 1, at = 0, width = 0;

    double value(double t, double rest = 0) const {
        if (t < at || t >= at + width) {
            return 0;
        }
        return amplitude * std::sin(std::numbers::pi * (((t - at) + rest) / width));
    }
    double next_break(double t) const { return first_after(t, {at, at + width}); }
    double constant_from() const { return at + width; }
    double most() const { return std::fabs(amplitude); }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        if (inside >= at && inside < at + width) sum.add_sine(amplitude, std::numbers::pi / width, at, 0);
    }
    std::string formula(double gain) const {
        return factor(gain * amplitude) + "sin(pi " + since(at) + "/" + number(width) + ")" + between(at, at + width);
    }
};

inline constexpr text::Option half_sine_options[] = {
    rows::amplitude<HalfSine>(),
    rows::at<HalfSine>(),
    rows::width<HalfSine>(),
};
inline constexpr TermText HalfSine::about{
    {"excitation.half_sine", "excitation.half_sine{ at = 1, width = 0.2 }", half_sine_options},
    "One half wave of a sine from `at` to at + width, 0 elsewhere: a shock.",
    "print(excitation.half_sine{ amplitude = 3, width = 2 }(1))  --> 3.0"};

/// a sine whose frequency goes linearly from `from` to `to` (cycles per time unit) over [at, at + duration];
/// before and after it stays at the first and last frequency; sin(phase) at `at`
struct Chirp {
    static const TermText about;

    double amplitude = 1, from = 0, to = 0, duration = 0, at = 0, phase = 0;

    /// The phase is the integral of the frequency; it and its slope are continuous.
    double value(double t) const {
        const double tau = t - at;
        double cycles = 0;
        if (t < at) {
            cycles = from * tau;
        } else if (t < at + duration) {
            cycles = tau * (from + 0.5 * (to - from) * (tau / duration));
        } else {
            cycles = duration * (0.5 * (from + to)) + to * (tau - duration);
        }
        return amplitude * std::sin(two_pi * cycles + phase);
    }
    double next_break(double t) const { return first_after(t, {at, at + duration}); }
    double constant_from() const { return to > 0 ? never : from > 0 ? at + duration : -never; }
    double most() const { return std::fabs(amplitude); }
    std::string formula(double gain) const {
        return factor(gain * amplitude) + "sine of frequency " + number(from) + " ... " + number(to) +
               between(at, at + duration);
    }
};

inline constexpr text::Option chirp_options[] = {
    rows::amplitude<Chirp>(),
    {"from", rows::cycles, text::needed, text::not_negative, "the first frequency", text::fills<&Chirp::from>},
    {"to", rows::cycles, text::needed, text::not_negative, "the last frequency", text::fills<&Chirp::to>},
    {"duration", rows::time, text::needed, text::positive, "from the first to the last", text::fills<&Chirp::duration>},
    rows::at<Chirp>(),
    {.name = "phase", .unit = "rad", .meaning = "at the time `at`", .filled = text::fills<&Chirp::phase>},
};
inline constexpr TermText Chirp::about{
    {"excitation.chirp", "excitation.chirp{ from = 0.2, to = 2, duration = 20 }", chirp_options},
    "A sine whose frequency changes linearly from `from` to `to` (cycles per time unit) over `duration`, "
    "beginning at `at` with sin(phase). It keeps the first frequency before that and the last one after it.",
    "print(excitation.chirp{ from = 0, to = 1, duration = 2 }(1))  --> 1.0"};

}  // namespace dinal::model::terms
