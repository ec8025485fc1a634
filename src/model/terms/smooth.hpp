// Smooth terms: excitation.polynomial, exponential and gaussian, and of sines harmonic, half_sine and chirp.
#pragma once

#include <optional>
#include <vector>

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// c0 + c1 (t - at) + c2 (t - at)^2 + ..., for all t
struct Polynomial {
    static const TermText about;

    std::vector<double> coefficients;
    double at = 0;

    /// Horner's scheme in t - at.
    double value(double t) const {
        const double x = t - at;
        double sum = 0;
        for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) {
            sum = sum * x + *c;
        }
        return sum;
    }
    double next_break(double) const { return never; }
    double constant_from() const {
        const auto varies = [](double c) { return c != 0; };
        return coefficients.size() < 2 || std::none_of(coefficients.begin() + 1, coefficients.end(), varies) ? -never
                                                                                                             : never;
    }
    double most() const { return coefficients.size() < 2 ? std::fabs(value(0)) : never; }
    template <class Sum>
    void closed_form(double /*inside*/, Sum& sum) const {
        sum.add_powers(at, coefficients);
    }
    [[nodiscard]] std::optional<text::Error> complaint() const {
        if (!coefficients.empty()) return std::nullopt;
        return text::Error{.sentence = "coefficients is empty; give at least one, as in coefficients = { 1, 0.5 }",
                           .option = "coefficients"};
    }
    std::string formula(double gain) const {
        std::string text;
        for (std::size_t i = 0; i < coefficients.size(); ++i) {
            const double c = gain * coefficients[i];
            if (c != 0) {
                text += text.empty() ? (c < 0 ? "-" : "") : (c < 0 ? " - " : " + ");
                const std::string power = since(at) + (i == 1 ? "" : "^" + std::to_string(i));
                text += i == 0 ? number(std::fabs(c)) : factor(std::fabs(c)) + power;
            }
        }
        return text.empty() ? "0" : text;
    }
};

inline constexpr text::Option polynomial_options[] = {
    {"coefficients", "torque, per time unit, ...", text::needed, text::any_finite, "the constant one first",
     text::fills<&Polynomial::coefficients>},
    rows::at<Polynomial>("from which time is counted"),
};
inline constexpr TermText Polynomial::about{
    {"excitation.polynomial", "excitation.polynomial{ coefficients = { 1, 0.5 } }", polynomial_options},
    "c[1] + c[2] (t - at) + c[3] (t - at)^2 + ... at all times; cut a piece out with e:window.",
    "print(excitation.polynomial{ coefficients = { 1, 0, 2 } }(3))  --> 19.0"};

/// amplitude exp(-(t - at) / tau) from `at` on, 0 before; tau < 0 grows
struct Exponential {
    static const TermText about;

    double amplitude = 1, tau = 0, at = 0;

    double value(double t, double rest = 0) const { return t < at ? 0 : grown(amplitude, -((t - at) + rest) / tau); }
    /// Returns amplitude exp(x), also if exp(x) alone overflows.
    static double grown(double amplitude, double x) {
        constexpr double most = 700;
        if (std::fabs(x) < most || amplitude == 0) return amplitude == 0 ? 0 : amplitude * std::exp(x);
        const double half = std::exp(x / 2);
        return amplitude * half * half;
    }
    double next_break(double t) const { return first_after(t, {at}); }
    double constant_from() const { return never; }
    double most() const { return amplitude == 0 ? 0 : tau > 0 ? std::fabs(amplitude) : never; }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        if (inside >= at) sum.add_exponential(amplitude, -1 / tau, at);
    }
    std::string formula(double gain) const {
        return factor(gain * amplitude) + "exp(-" + since(at) + "/" + number(tau) + ")" + from_on(at);
    }
};

inline constexpr text::Option exponential_options[] = {
    rows::amplitude<Exponential>("its first value"),
    {"tau", rows::time, text::needed, text::not_zero, "time in which it falls to 1/e", text::fills<&Exponential::tau>},
    rows::at<Exponential>(),
};
inline constexpr TermText Exponential::about{
    {"excitation.exponential", "excitation.exponential{ amplitude = 2, tau = 0.5 }", exponential_options},
    "amplitude exp(-(t - at)/tau) from `at` on, 0 before. A negative tau grows.",
    "M = excitation.exponential{ amplitude = 2, tau = 0.5, at = 1 }\nprint(M(0.9), M(1))  --> 0.0\t2.0"};

/// amplitude exp(-((t - at) / sigma)^2 / 2): `sigma` is the standard deviation
struct Gaussian {
    static const TermText about;

    double amplitude = 1, at = 0, sigma = 0;

    double value(double t, double rest = 0) const {
        const double x = ((t - at) + rest) / sigma;
        return amplitude * std::exp(-0.5 * x * x);
    }
    double next_break(double) const { return never; }
    double constant_from() const {
        constexpr double vanished = 39;  // exp(-39^2 / 2) is below the smallest double
        return std::nextafter(at + vanished * sigma, never);
    }
    double most() const { return std::fabs(amplitude); }
    Detail detail() const {
        constexpr double visible = 10;  // exp(-10^2 / 2) = 2e-22 is lost in rounding
        return {at - visible * sigma, at + visible * sigma, sigma / 2};
    }
    std::string formula(double gain) const {
        return factor(gain * amplitude) + "exp(-(" + since(at) + "/" + number(sigma) + ")^2/2)";
    }
};

inline constexpr text::Option gaussian_options[] = {
    rows::amplitude<Gaussian>(),
    rows::at<Gaussian>("its middle"),
    {"sigma", rows::time, text::needed, text::positive, "its standard deviation", text::fills<&Gaussian::sigma>},
};
inline constexpr TermText Gaussian::about{
    {"excitation.gaussian", "excitation.gaussian{ at = 1, sigma = 0.2 }", gaussian_options},
    "A smooth bump, amplitude exp(-((t - at)/sigma)^2 / 2): sigma is the standard deviation. Any width is safe "
    "with the spectral integrator; others need steps of at most sigma/2.",
    "M = excitation.gaussian{ amplitude = 2, at = 3, sigma = 0.5 }\nprint(M(3), M(3.5) / M(3) == math.exp(-0.5))  --> "
    "2.0\ttrue"};

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
    text::option<&Harmonic::omega>("omega", "2 pi frequency",
                                   {.unit = "rad per time unit",
                                    .otherwise = text::needed,
                                    .range = text::not_negative,
                                    .instead_of_previous = true}),
    {.name = "period",
     .unit = rows::time,
     .otherwise = text::needed,
     .range = text::positive,
     .meaning = "1/frequency",
     .filled = text::sets<omega_of_period>,
     .instead_of_previous = true},
    text::option<&Harmonic::phase>("phase", "at t = 0", {.unit = "rad"}),
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
    text::option<&Chirp::phase>("phase", "at the time `at`", {.unit = "rad"}),
};
inline constexpr TermText Chirp::about{
    {"excitation.chirp", "excitation.chirp{ from = 0.2, to = 2, duration = 20 }", chirp_options},
    "A sine whose frequency changes linearly from `from` to `to` (cycles per time unit) over `duration`, "
    "beginning at `at` with sin(phase). It keeps the first frequency before that and the last one after it.",
    "print(excitation.chirp{ from = 0, to = 1, duration = 2 }(1))  --> 1.0"};

}  // namespace dinal::model::terms
