// Closed forms of the steady motion under M0 sin wt: without dry friction, with friction as equivalent viscous damping,
// and Den Hartog's exact one with dry friction, with its boundary to motions with stops.
//
// r = w/w0, zeta viscous, gamma = Rd/M0 the friction ratio; amplitudes in units of M0/k, lags in rad.
#pragma once

#include <optional>

#include "model/oscillator.hpp"
#include "theory/theory_free.hpp"

namespace dinal::theory {

/// 1 - r^2 without loss of digits near resonance.
inline double detuning(double r) {
    return (1 - r) * (1 + r);
}

/// Phi = 1/sqrt((1 - r^2)^2 + 4 zeta^2 r^2); infinity at r = 1 without damping.
double magnification(double r, double zeta);
/// The lag of the motion behind the load: atan2(2 zeta r, 1 - r^2), 0 to pi; pi/2 at r = 1 for any zeta.
double phase_lag(double r, double zeta);

/// Amplitude and lag of a harmonic motion, or of the fundamental of another motion.
struct Harmonic_motion {
    double amplitude = 0;
    double lag = 0;
};
/// The motion with friction replaced by equivalent damping, for small gamma. None from gamma = pi/4 on, where friction
/// would dissipate more than the load supplies.
std::optional<Harmonic_motion> linearised_friction(double r, double zeta, double friction_ratio);

/// Amplitudes in units of M0/k, lags behind the load in rad.
struct SlidingMotion {
    double amplitude = 0;  ///< the greatest angle
    double lag = 0;        ///< lag of the greatest angle
    double fundamental_amplitude = 0;
    double fundamental_lag = 0;
};

/// J. P. Den Hartog, "Forced vibrations with combined Coulomb and viscous friction", Trans. ASME 53 (1931). Without
/// stops, friction is a square wave that jumps at the turns. The steady motion is antisymmetric after half a period, so
/// its response to that square wave at a turn depends on r and zeta only; zero velocity at the turn yields the
/// amplitude. docs/theory.md, section 12, has the derivation.
class DenHartog {
public:
    static constexpr double slowest = 1e-4;  ///< half a period of the load then has 5000 natural periods
    static constexpr double fastest = 1e6;

    /// r = w/w0 is 0 or between `slowest` and `fastest`; zeta >= 0.
    DenHartog(double r, double zeta);

    /// The steady motion without stops for gamma = Rd/M0 and Re/M0 >= gamma; none if it has stops. At r = 1 without
    /// viscous damping it grows without bound: infinite amplitude, with the lag pi/2 of a growing motion.
    // NOTE: at r = 1/2, 1/4, ... with zeta = 0 it is the symmetric one of a family of steady motions.
    std::optional<SlidingMotion> motion(double friction_ratio, double breakaway_ratio) const;

    /// The motion under the unverified assumption that it has no stops; none if no such motion is possible.
    std::optional<SlidingMotion> without_stops(double friction_ratio) const;

    /// The greatest gamma without stops, for Re = `breakaway_factor` Rd.
    double stop_boundary(double breakaway_factor) const;

private:
    double velocity_excess(double x) const;
    double greatest_excess() const;
    double refined_peak(double from, double to) const;
    double excess_at_turn(double friction, double breakaway) const;
    bool grows() const;
    std::optional<double> swing_beyond(double least, double friction_ratio) const;
    SlidingMotion sliding(double friction_ratio, double swing) const;

    double r_;
    Modes modes_;
    double half_;      // half a period as x = w0 t, pi/r
    double apart_;     // q - r (underdamped)
    double angle_;     // response to the square wave that is +1 after the turn, at the turn
    double velocity_;  // derivative of this response with respect to x
    double sine_;      // (1 + e^(-zeta P) cos qP)/Delta, the coefficient of pushed(x) in Y(x)
};

}  // namespace dinal::theory
