// Where a curve first leaves a band, proven: between its looks a bound of the fourth derivative says what they can
// hide.
//
// On a look of length h the curve is not farther than max|f''''| h^4/384 from the cubic through its values and slopes
// at both ends, and a cubic is not outside of its Bernstein coefficients.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "motion/exact/curve.hpp"

namespace dinal::motion::exact {

struct Band {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

struct Exit {
    double tau;    ///< where it crosses, the curve was asked last and tells the way
    int side;      ///< +1 through the high edge, -1 through the low one
    bool crosses;  ///< else it comes to the edge within rounding, and does not clearly cross it
};

/// Where a motion is slower than rounding: speed (C + I/h) at most `least` torque all over a look of length h, which is
/// not shorter than `shortest`. None, as it is made.
struct Creep {
    double damping = 0, inertia = 0, shortest = std::numeric_limits<double>::infinity(), least = 0;
    double fastest = -1;  ///< the speed over the shortest look
};

/// How long such stretches took before, which is where the end of the next one is tried first. Where that was of no use
/// it is left alone for a while.
class Habit {
public:
    Habit() = default;
    explicit Habit(double length) : length_(length) {}
    /// Where to try; 0: nowhere.
    [[nodiscard]] double length() {
        if (waits_ == 0) return length_;
        --waits_;
        return 0;
    }
    /// What is nearly the same stays the same, so that its turn need not be made again.
    void kept(double length) {
        constexpr double same = 2e-5;
        if (!(std::fabs(length - length_) <= same * length)) length_ = length;
        missed_ = 0;
    }
    /// It was tried in vain.
    void missed() {
        constexpr unsigned most = 16;
        waits_ = missed_ = std::min(2 * missed_ + 1, most);
    }
    void walked(double length) { length_ = length; }

private:
    double length_ = 0;
    unsigned waits_ = 0, missed_ = 0;
};

/// Whether a curve with such a bound of its fourth derivative can be searched: later bounds are twice as great at most.
inline bool within_range(double fourth_bound) {
    return std::isfinite(4 * fourth_bound);
}

class FirstExit {
public:
    FirstExit(WalkedCurve& curve, Band band, double floor) : curve_(curve), band_(band), floor_(floor) {}
    /// The fourth derivative is known not to exceed `bound` from where the curve is.
    void bounded(double bound) { bound_ = bound; }

    /// Watches for a creep.
    void watch(const Creep& creep) { creep_ = creep; }
    [[nodiscard]] bool crept() const { return crept_; }

    /// The first exit from where the walk is up to `until`, to which the walk goes when there is none. A touch is told
    /// once: after one, the next search goes on behind it.
    std::optional<Exit> search(double until);
    /// Whether the first exit from `from` on, where the curve is `start`, is one near `guess` later: proven from both
    /// ends. The walk stays where it is: near `from`, when the curve is asked
    /// by a look from there. Only for a curve of a known bound.
    enum class By { the_beginning, a_look };
    std::optional<Exit> at_once(double from, const WalkedCurve::End& start, double guess, double until,
                                By by = By::the_beginning);
    /// How the curve was where it was found to cross; a slope of 0: nobody asked.
    [[nodiscard]] const WalkedCurve::End& end() const { return end_; }
    /// From a crossing, where the walk is not yet: goes to where the curve is certain to be within.
    void depart(double from, const WalkedCurve::End& start, double until);
    /// The curve begins on the edge, and its first derivatives there are `first`, `second`, `third`, inwards positive:
    /// goes to where it is certain to be within. False when it does not get there.
    bool leave(double first, double second, double third, double until);
    /// Without an edge for what follows: the next zero of a curve that swings through it.
    void set_band(Band band) { band_ = band; }

private:
    struct Hull {
        double low, high;   ///< of the cubic
        double d0, d1, d2;  ///< between its coefficients
        /// How far they are from a straight line.
        [[nodiscard]] double bend() const { return std::max(std::fabs(d1 - d0), std::fabs(d2 - d1)); }
        /// h times the greatest and the least slope of the cubic.
        [[nodiscard]] double rise() const { return 3 * std::max(std::max(d0, d1), d2); }
        [[nodiscard]] double fall() const { return 3 * std::min(std::min(d0, d1), d2); }
    };
    [[nodiscard]] static Hull hull(const WalkedCurve::Value& a, const WalkedCurve::Value& b, double h);
    [[nodiscard]] double cubic_crossing(const WalkedCurve::Value& a, const WalkedCurve::Value& b, double h,
                                        double edge) const;
    struct Zero {
        double tau;
        bool exact;  ///< to rounding
    };
    Zero near(double guess, const WalkedCurve::Jet& y, double edge, double bound);
    struct Doubt {
        double sixth, least;
    };
    [[nodiscard]] static bool apart(const WalkedCurve::End& a, const WalkedCurve::End& b, double h, double edge,
                                    double side, const Doubt& doubt);
    double polish(double from, double to, double guess, double edge, int side, double bound);
    double step_by_step(double from, double to, double guess, double edge, int side);
    Exit crossing(double tau, int side);
    bool creeps_from_here(double until);
    void choose_level(double bound, double rounding);
    [[nodiscard]] double farthest_look(double bound, double rounding) const;
    [[nodiscard]] double far_from_edges(double rounding) const;
    [[nodiscard]] double odd_length(double bound, int level, double left, int finer) const;
    [[nodiscard]] double margin(double f) const { return std::min(f - band_.low, band_.high - f); }

    WalkedCurve& curve_;
    Band band_;
    double floor_, bound_ = -1;
    WalkedCurve::End end_{};
    Creep creep_ = {};
    bool crept_ = false;
    int level_ = usual_level;
    static constexpr int usual_level = 6;  // an eighth of a natural period
};

}  // namespace dinal::motion::exact
