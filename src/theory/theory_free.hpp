// Closed forms of free motion: the three regimes, dry friction by half cycles, and damping from decrements.
#pragma once

#include <optional>
#include <span>

#include "model/oscillator.hpp"

namespace dinal::theory {

/// The free motions of y'' + 2 zeta y' + y = 0 for any zeta >= 0, without loss of digits between the regimes.
/// Time is x = w0 t. With q = sqrt(1 - zeta^2), or k = sqrt(zeta^2 - 1) when overdamped, the fundamental solutions are
/// built from e^(-zeta x) cos qx and e^(-zeta x) (sin qx)/q, whose limits q -> 0 are e^(-x) and x e^(-x).
class Modes {
public:
    explicit Modes(double zeta);

    double zeta() const { return zeta_; }
    bool swings() const { return zeta_ < 1; }
    /// q, or k when overdamped.
    double rate() const { return rate_; }
    /// The decay rates of an overdamped motion: 1/(zeta + k), and zeta + k.
    double slow_root() const { return 1 / fast_root(); }
    double fast_root() const { return swings() ? 1 : zeta_ + rate_; }

    /// e^(-zeta x) cos qx.
    double damped_cosine(double x) const;
    /// y(0) = 0, y'(0) = 1: e^(-zeta x) (sin qx)/q.
    double pushed(double x) const;
    struct Answers {
        double released;                 ///< y(0) = 1, y'(0) = 0; its velocity is -pushed
        double pushed, pushed_velocity;  ///< y(0) = 0, y'(0) = 1
    };
    Answers after(double x) const;

private:
    double zeta_;
    double rate_;
};

/// An angle (or y) and its derivative at x = w0 t, from the values at x = 0.
struct Motion2 {
    double y = 0;
    double dy = 0;  ///< derivative with respect to x
};
inline Motion2 free_motion(const Modes& modes, const Motion2& start, double x) {
    const auto [released, pushed, pushed_velocity] = modes.after(x);
    return {start.y * released + start.dy * pushed, start.dy * pushed_velocity - start.y * pushed};
}

/// Free motion without dry friction at the time t (any sign), from `initial` at t = 0.
model::State free_response(double natural_frequency, double zeta, const model::State& initial, double t);

/// The half-cycle map. From an extreme X (velocity zero) the mass swings to the next one, X' = s x_f - (X - s x_f) e, e
/// = e^(-pi zeta / sqrt(1 - zeta^2)), s = sgn X, x_f = Rd/k; a geometric sum gives n half cycles at once.
class HalfCycles {
public:
    /// Requires 0 <= zeta < 1 and x_f >= 0.
    HalfCycles(double zeta, double friction_shift);
    /// The extreme n half cycles after X, provided that the mass does not come to rest before.
    double after(double n, double X) const;
    /// The number of half cycles after X until first |angle| <= dead_zone, which is at least x_f; infinity if never.
    /// Slightly off near 2^53.
    double until_within(double dead_zone, double X) const;

private:
    double shrunk(double n, double size) const;

    double logarithm_;  // -ln e
    double shift_;
};

/// An extreme of a free motion, with velocity zero.
struct Extreme {
    double t = 0;
    double theta = 0;
};

/// The exact free motion of a system with dry friction from t = 0 on, by the half-cycle map; the cost does not depend
/// on the number of half cycles.
class FreeMotion {
public:
    FreeMotion(const model::Oscillator& system, const model::State& initial);

    /// Requires t >= 0.
    model::State at(double t) const;
    /// The time at which it stops for good; infinity if it only approaches a place, or never settles.
    double time_to_rest() const;
    /// The place where it stops or which it approaches; none if it swings for ever.
    std::optional<double> rest_position() const;
    /// The number of zeros of the velocity until it rests, including the start if at rest.
    double extremes() const;
    /// Requires 0 <= n < extremes().
    Extreme extreme(double n) const;

private:
    double half_cycles_to_rest() const;
    bool stays(double theta) const;
    double first_zero(double side) const;
    model::State arc(double side, const model::State& start, double t) const;
    double half_cycle() const;

    model::Oscillator system_;
    model::State initial_;
    Modes modes_;
    double w0_;
    double shift_;       // x_f = Rd/k
    Extreme first_{};    // its t is infinite if there is none
    double until_rest_;  // half cycles from the first extreme to rest
};

/// Stores theta at these increasing times, starting from `initial` at the first one: a thousand samples cost a few
/// hundred sines. Requires a linear spring, Coulomb friction and less than critical damping. With `rests_at` the mass
/// rests at that extreme (0: the first) regardless of the friction limit.
void free_decay(const model::Oscillator& system, const model::State& initial, std::span<const double> times,
                std::optional<double> rests_at, std::span<double> theta);

/// delta = ln(X0/X2) = 2 pi zeta / sqrt(1 - zeta^2) from viscous damping alone; zeta < 1.
double logarithmic_decrement(double zeta);

struct Dampings {
    double zeta = 0;
    double friction_shift = 0;  ///< x_f = Rd/k
};
/// Both dampings from three successive extremes (signs are ignored): q = (X1 - X2)/(X0 - X1), zeta/sqrt(1 - zeta^2) =
/// -(ln q)/pi, x_f = (q X0 - X1)/(1 + q). None unless X0 > X1 > X2. A negative value means that the extremes are too
/// inaccurate to distinguish that damping from zero.
std::optional<Dampings> identify(double X0, double X1, double X2);

}  // namespace dinal::theory
