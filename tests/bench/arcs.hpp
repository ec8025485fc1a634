// The motion between two events in closed form, for a harmonic load, and the walk from event to event.
//
// In double it is a peer (nothing general can be much faster), in long double it is the truth of every error.
#pragma once

#include <cmath>
#include <complex>
#include <limits>

namespace bench {

/// u'' + 2 zeta w0 u' + w0^2 (u + s gamma) = w0^2 a sin(w t), w0 = 2 pi, zeta < 1, w = r w0.
template <class Real>
struct HarmonicProblem {
    Real zeta = 0, friction_ratio = 0, amplitude = 0, ratio = 1, u0 = 0, v0 = 0, end = 0;
};

/// How the velocity is looked at along an arc: by sin and cos, as it is written down, or by turning two phasors a bit
/// further at each look, which is several times faster and takes somebody who knows that.
enum class Looks { by_sines, by_rotation };

template <class Real, Looks looks = Looks::by_rotation>
class ArcWalker {
public:
    explicit ArcWalker(const HarmonicProblem<Real>& problem) : p_(problem) {
        decay_ = p_.zeta * w0_;
        w1_ = w0_ * std::sqrt(1 - p_.zeta * p_.zeta);
        w_ = p_.ratio * w0_;
        secular_ = p_.amplitude != 0 && p_.zeta == 0 && p_.ratio == 1;
        if (p_.amplitude != 0 && !secular_) {
            const Real re = 1 - p_.ratio * p_.ratio, im = 2 * p_.zeta * p_.ratio;
            lag_ = std::atan2(im, re);
            gain_ = p_.amplitude / std::hypot(re, im);
        }
        // Sixteen looks a period bracket every zero of the velocity of these problems: none turns twice in between.
        look_ = 2 * pi_ / (16 * std::max(w_, w0_));
        turn_free_ = std::exp(Complex(-decay_ * look_, w1_ * look_));
        turn_load_ = std::polar(Real(1), w_ * look_);
        u_ = p_.u0;
        if (p_.v0 != 0) {
            begin_arc(p_.v0 > 0 ? 1 : -1, p_.v0);
        } else {
            decide();
        }
    }

    Real start() const { return t_; }      ///< of the current arc
    Real position() const { return u_; }   ///< at its start
    Real next() const { return t_next_; }  ///< its end: an event, or the end of the problem
    bool at_end() const { return t_next_ >= p_.end; }

    /// u at a time within the current arc.
    Real position(Real t) const { return sign_ == 0 ? u_ : motion(t - t_).u; }

    void advance() {
        const bool was_stuck = sign_ == 0;
        const Real tau = t_next_ - t_;
        if (!was_stuck) {
            u_ = motion(tau).u;
        }
        t_ = t_next_;
        if (was_stuck) {
            begin_arc(release_sign_, 0);
        } else {
            decide();
        }
    }

private:
    using Complex = std::complex<Real>;
    struct Motion {
        Real u, v, a;
    };

    // At velocity zero: stick, or off towards M - u.
    void decide() {
        const Real torque = p_.amplitude == 0 ? -u_ : p_.amplitude * std::sin(phase(t_)) - u_;
        if (std::abs(torque) > p_.friction_ratio) {
            begin_arc(torque > 0 ? 1 : -1, 0);
        } else {
            sign_ = 0;
            t_next_ = release_time();
        }
    }

    // w t reduced by whole periods before it is rounded.
    Real phase(Real t) const {
        const Real cycles = p_.ratio * t;
        return 2 * pi_ * (cycles - std::floor(cycles));
    }

    Real release_time() {
        Real first = std::numeric_limits<Real>::infinity();
        const auto consider = [&](Real level, int sign) {
            if (p_.amplitude == 0 || std::abs(level) > p_.amplitude) {
                return;
            }
            const Real rising = std::asin(level / p_.amplitude);
            Real ahead = std::fmod((sign > 0 ? rising : pi_ - rising) - phase(t_), 2 * pi_);
            if (ahead <= 0) {
                ahead += 2 * pi_;
            }
            if (ahead / w_ < first) {
                first = ahead / w_;
                release_sign_ = sign;
            }
        };
        consider(u_ + p_.friction_ratio, 1);
        consider(u_ - p_.friction_ratio, -1);
        return std::min(t_ + first, p_.end);
    }

    // u = -s gamma + particular(tau) + Re(free_ e^{(-decay + i w1) tau})
    void begin_arc(int sign, Real v) {
        sign_ = sign;
        const Real equilibrium = -Real(sign) * p_.friction_ratio;
        Real up = 0, vp = 0;
        if (p_.amplitude != 0) {
            load_ = std::polar(Real(1), phase(t_) - lag_);  // cos and sin of the load's (lagged) phase
            up = secular_ ? 0 : gain_ * load_.imag();
            vp = secular_ ? -p_.amplitude * w0_ / 2 * load_.real() : gain_ * w_ * load_.real();
        }
        equilibrium_ = equilibrium;
        const Real x = u_ - equilibrium - up, y = (v - vp + decay_ * x) / w1_;
        free_ = Complex(x, -y);
        t_next_ = t_ + first_standstill(v == 0);
    }

    // From the two rotating phasors: free motion z (with its decay) and load l, both already turned by tau.
    Motion combine(Real tau, Complex z, Complex l) const {
        const Complex root(-decay_, w1_);
        const Complex zv = root * z, za = root * zv;
        Motion m{equilibrium_ + z.real(), zv.real(), za.real()};
        if (secular_) {
            const Real g = p_.amplitude * w0_ / 2;
            m.u -= g * tau * l.real();
            m.v -= g * (l.real() - tau * w0_ * l.imag());
            m.a += g * w0_ * (2 * l.imag() + tau * w0_ * l.real());
        } else if (gain_ != 0) {
            m.u += gain_ * l.imag();
            m.v += gain_ * w_ * l.real();
            m.a -= gain_ * w_ * w_ * l.imag();
        }
        return m;
    }

    Motion motion(Real tau) const {
        const Real fade = decay_ == 0 ? 1 : std::exp(-decay_ * tau);
        const Complex z = free_ * Complex(fade * std::cos(w1_ * tau), fade * std::sin(w1_ * tau));
        const Complex l = p_.amplitude == 0 ? Complex{} : load_ * Complex(std::cos(w_ * tau), std::sin(w_ * tau));
        return combine(tau, z, l);
    }

    // The first tau > 0 at which the velocity is zero, or the time that is left.
    Real first_standstill(bool from_standstill) const {
        const Real left = p_.end - t_;
        [[maybe_unused]] Complex z = free_, l = load_;
        Real lo = from_standstill ? look_ / 1000 : 0, v_lo = 0, tau = 0;
        while (tau < left) {
            tau += look_;
            Real v = 0;
            if constexpr (looks == Looks::by_rotation) {
                z *= turn_free_;
                l *= turn_load_;
                v = combine(tau, z, l).v;
            } else {
                v = motion(tau).v;
            }
            if (Real(sign_) * v <= 0) {
                return std::min(left, polish(lo, tau, v_lo, v));
            }
            lo = tau;
            v_lo = v;
        }
        return left;
    }

    // Newton inside a bracket, from the straight line's guess.
    Real polish(Real lo, Real hi, Real v_lo, Real v_hi) const {
        Real tau = v_lo == 0 ? (lo + hi) / 2 : lo + (hi - lo) * v_lo / (v_lo - v_hi);
        for (int i = 0; i < 60; ++i) {
            const Motion m = motion(tau);
            (Real(sign_) * m.v > 0 ? lo : hi) = tau;
            Real better = tau - m.v / m.a;
            if (!(better > lo && better < hi)) {
                better = std::abs(better - tau) < 4 * std::numeric_limits<Real>::epsilon() ? tau : (lo + hi) / 2;
            }
            const Real moved = std::abs(better - tau);
            tau = better;
            if (moved < converged_) {
                break;
            }
        }
        return tau;
    }

    static constexpr Real pi_ = static_cast<Real>(3.141592653589793238462643383279502884L);
    static constexpr Real w0_ = 2 * pi_;
    // Newton doubles the digits: a move of this size leaves an error of its square.
    static constexpr Real converged_ = static_cast<Real>(1e-9L);

    HarmonicProblem<Real> p_;
    Real decay_, w1_, w_, lag_ = 0, gain_ = 0, look_;
    bool secular_;
    Complex turn_free_, turn_load_;

    Real t_ = 0, t_next_ = 0, u_, equilibrium_ = 0;
    int sign_ = 0, release_sign_ = 0;
    Complex free_, load_;
};

}  // namespace bench
