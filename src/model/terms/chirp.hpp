// excitation.chirp: a sine whose frequency changes linearly.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// a sine whose frequency goes linearly from `from` to `to` (cycles per time unit) over [at, at + duration];
/// before and after it stays at the first and last frequency; sin(phase) at `at`
struct Chirp {
    static const TermText about;

    double amplitude = 1, from = 0, to = 0, duration = 0, at = 0, phase = 0;

    /// The phase is the integral of the frequency; it and its slope are continuous.
    [[nodiscard]] double value(double t) const {
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
    [[nodiscard]] double next_break(double t) const { return first_after(t, {at, at + duration}); }
    [[nodiscard]] double constant_from() const { return to > 0 ? never : from > 0 ? at + duration : -never; }
    [[nodiscard]] double most() const { return std::fabs(amplitude); }
    [[nodiscard]] Detail detail() const { return no_detail; }
    void delay_by(double d) { at += d; }
    [[nodiscard]] std::string formula(double gain) const {
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
