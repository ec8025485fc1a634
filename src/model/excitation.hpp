// M(t): a flat sum of small value terms, native or scripted, each knowing its value, its breaks and whole blocks.
//
// Every term is continuous from the right: at a break, value(t) is already the new level.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "model/oscillator.hpp"
#include "text/expected.hpp"

namespace dinal::model {

inline constexpr double never = std::numeric_limits<double>::infinity();

// Times in time units, frequencies in cycles per time unit, omega in rad per time unit, levels in torque.

struct Constant {
    double level = 0;
};
/// amplitude sin(omega t + phase)
struct Harmonic {
    double amplitude = 1, omega = 0, phase = 0;
};
/// 0 before `at`, `level` from then on
struct Step {
    double level = 1, at = 0;
};
/// `amplitude` for at <= t < at + width, else 0
struct Pulse {
    double amplitude = 1, at = 0, width = 0;
};
/// one half wave of a sine over [at, at + width], else 0
struct HalfSine {
    double amplitude = 1, at = 0, width = 0;
};
/// 0 before `at`, rising by `slope` per time unit for `width`, then constant
struct Ramp {
    double slope = 1, at = 0, width = never;
};
/// +amplitude for the first `duty` part of each period, -amplitude for the rest
struct Square {
    double amplitude = 1, period = 0, duty = 0.5, at = 0;
};
/// rises from -amplitude to +amplitude over each period and drops back
struct Sawtooth {
    double amplitude = 1, period = 0, at = 0;
};
/// a sine's corners joined by straight lines: 0, +amplitude, 0, -amplitude, 0
struct Triangle {
    double amplitude = 1, period = 0, at = 0;
};
/// a sine whose frequency goes linearly from `from` to `to` (cycles per time unit) over [at, at + duration];
/// before and after it stays at the first and last frequency; sin(phase) at `at`
struct Chirp {
    double amplitude = 1, from = 0, to = 0, duration = 0, at = 0, phase = 0;
};
/// amplitude exp(-(t - at) / tau) from `at` on, 0 before; tau < 0 grows
struct Exponential {
    double amplitude = 1, tau = 0, at = 0;
};
/// c0 + c1 (t - at) + c2 (t - at)^2 + ..., for all t
struct Polynomial {
    std::vector<double> coefficients;
    double at = 0;
};
/// straight lines between points; the first and last value hold outside. Times strictly increasing, at least one point.
struct Samples {
    std::vector<double> t, M;
    std::string origin = {};  ///< where they were read, in the words of whoever read them; not used by the core
    double delay = 0;         ///< by how much `t` is later than there
};

/// A user's function of t or of t, theta, velocity. Virtual because the core must not know who wrote it.
class UserFunction {
public:
    UserFunction() = default;
    UserFunction(const UserFunction&) = delete;
    UserFunction& operator=(const UserFunction&) = delete;
    virtual ~UserFunction() = default;
    /// NaN says that the function failed (and that its owner knows why): the run ends there.
    virtual double value(double t, const State& state) = 0;
    /// out[i] = value(times[i]) in this order, up to and including the first that is not finite; returns how many are.
    // Virtual, too: the way into the user's language is paid once for a block.
    virtual std::size_t fill(std::span<const double> times, std::span<double> out) {
        for (std::size_t i = 0; i < times.size(); ++i) {
            out[i] = value(times[i], State{});
            if (!std::isfinite(out[i])) {
                return i;
            }
        }
        return times.size();
    }
    /// After a failure: whether it may be asked again, at other times. What failed stays known to the owner.
    virtual bool may_go_on() { return true; }
};
/// A user's function, delayed by `delay`, with what he says about it.
// Shared ownership: every excitation and every trajectory that contains the function keeps it alive.
struct Scripted {
    std::shared_ptr<UserFunction> function;
    bool feedback = false;            ///< called with theta and velocity, too
    std::vector<double> breaks = {};  ///< where it jumps or kinks (in its own time), increasing
    double period = 0;                ///< > 0: the breaks repeat with this period
    double delay = 0;
};

// Large tables sit behind a shared pointer to const, so that copies of an excitation are cheap and safe.
using Term = std::variant<Constant, Harmonic, Step, Pulse, HalfSine, Ramp, Square, Sawtooth, Triangle, Chirp,
                          Exponential, Polynomial, std::shared_ptr<const Samples>, Scripted>;

/// gain * term for from <= t < to, else 0
struct Component {
    double gain = 1;
    Term term;
    double from = -never, to = never;
};

class Excitation {
public:
    /// M = 0.
    Excitation() = default;
    /// Fails with a sentence that names the option, its value and its range.
    static text::Expected<Excitation> make(Term term);

    [[nodiscard]] double value(double t, const State& state = {}) const;
    /// The limit from the left: differs from value(t) only where M jumps.
    [[nodiscard]] double value_before(double t, const State& state = {}) const;
    /// The limit from the right: value(t), but a scripted function is asked a hair later, since its author may have
    /// written `t > 0.5` as well as `t >= 0.5`.
    [[nodiscard]] double value_after(double t, const State& state = {}) const;
    /// The first time after t at which M or a derivative of it jumps; `never` if there is none.
    [[nodiscard]] double next_break(double t) const;
    /// From when on M is known to be constant for ever; `never` when that is not known.
    [[nodiscard]] double constant_from() const;
    /// What |M| never exceeds; `never` when that is not known.
    [[nodiscard]] double most() const;
    /// M needs theta and velocity.
    [[nodiscard]] bool has_feedback() const;
    [[nodiscard]] bool has_script() const;
    /// out[i] = value(times[i]); not for feedback. Returns how many were filled: fewer when one is not finite.
    std::size_t fill(std::span<const double> times, std::span<double> out) const;

    /// After a value that was not finite: whether the functions in it may be asked again, at other times.
    [[nodiscard]] bool may_go_on() const;

    [[nodiscard]] Excitation scaled(double gain) const;
    [[nodiscard]] Excitation delayed(double delay) const;
    /// 0 outside from <= t < to.
    [[nodiscard]] Excitation windowed(double from, double to) const;
    friend Excitation operator+(Excitation a, const Excitation& b);

    [[nodiscard]] const std::vector<Component>& components() const { return components_; }

private:
    std::vector<Component> components_;
};

}  // namespace dinal::model
