// Where a curve first leaves a band, proven: between its looks a bound of the fourth derivative says what they can
// hide.
//
// On a look of length h the curve is not farther than max|f''''| h^4/384 from the cubic through its values and slopes
// at both ends, and a cubic is not outside of its Bernstein coefficients.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "motion/exact/curve.hpp"

namespace dinal::motion::exact {

struct Band {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

struct Exit {
    double tau;    ///< where it crosses, at() was asked last within 1e-9 of a look
    int side;      ///< +1 through the high edge, -1 through the low one
    bool crosses;  ///< else it comes to the edge within rounding, and does not clearly cross it
};

/// Where a motion is slower than rounding: speed (C + I/h) at most `least` torque all over a look of length h, which is
/// not shorter than `shortest`.
struct Creep {
    double damping, inertia, shortest, least;
};

/// Whether a curve with such a bound of its fourth derivative can be searched: later bounds are twice as great at most.
inline bool within_range(double fourth_bound) {
    return std::isfinite(4 * fourth_bound);
}

class FirstExit {
public:
    FirstExit(WalkedCurve& curve, Band band, double floor) : curve_(curve), band_(band), floor_(floor) {}

    /// Watches for a creep.
    void watch(const Creep& creep) { creep_ = creep; }
    [[nodiscard]] bool crept() const { return crept_; }

    /// The first exit from where the walk is up to `until`, to which the walk goes when there is none. A touch is told
    /// once: after one, the next search goes on behind it.
    std::optional<Exit> search(double until);
    /// The curve begins on the edge, and its first derivatives there are `first`, `second`, `third`, inwards positive:
    /// goes to where it is certain to be within. False when it does not get there.
    bool leave(double first, double second, double third, double until);
    /// Without an edge for what follows: the next zero of a curve that swings through it.
    void set_band(Band band) { band_ = band; }

private:
    struct Hull {
        double low, high;     ///< of the cubic
        double bend;          ///< how far its coefficients are from a straight line
        double falls, rises;  ///< h times the greatest and the least slope of the cubic
    };
    [[nodiscard]] static Hull hull(const WalkedCurve::Value& a, const WalkedCurve::Value& b, double h);
    [[nodiscard]] double cubic_crossing(const WalkedCurve::Value& a, const WalkedCurve::Value& b, double h,
                                        double edge) const;
    double polish(double from, double to, double guess, double edge, int side);
    Exit crossing(double tau, int side);
    bool creeps_from_here(double until);
    void choose_level(double bound);
    [[nodiscard]] double margin(double f) const { return std::min(f - band_.low, band_.high - f); }

    WalkedCurve& curve_;
    Band band_;
    double floor_;
    std::optional<Creep> creep_ = {};
    bool crept_ = false;
    int level_ = usual_level;
    static constexpr int usual_level = 6;  // an eighth of a natural period
};

}  // namespace dinal::motion::exact
