// Finds the first exit of a curve from a band, with proof: a bound of the fourth derivative limits the curve within a
// step, called a look.
//
// Within a look of length h the curve is within max|f''''| h^4/384 of the cubic through values and slopes at both ends,
// and a cubic is within the hull of its Bernstein coefficients.
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
    double tau;    ///< time; at a crossing, way() of the curve refers to it
    int side;      ///< +1 through the high edge, -1 through the low one
    bool crosses;  ///< whether it crosses; otherwise it touches the edge within rounding
};

/// The criterion of a creep, a motion slower than rounding: speed (C + I/h) is at most the torque `least` throughout a
/// look of length h >= `shortest`. By default nothing is a creep.
struct Creep {
    double damping = 0, inertia = 0, shortest = std::numeric_limits<double>::infinity(), least = 0;
    double fastest = -1;  ///< greatest speed over the shortest look

    /// C + I/h of the shortest look, the greatest torque per speed.
    double resistance() const { return damping + inertia / shortest; }
};

/// The length of the previous interval of some kind, tried first for the next one. After failures it pauses for a
/// while.
class Habit {
public:
    Habit() = default;
    explicit Habit(double length) : length_(length) {}
    /// The length to try; 0: none.
    [[nodiscard]] double length() {
        if (waits_ == 0) return length_;
        --waits_;
        return 0;
    }
    /// Keeps the length if it is nearly the same, so that cached factors remain usable.
    void kept(double length) {
        constexpr double same = 2e-5;
        if (!(std::fabs(length - length_) <= same * length)) length_ = length;
        missed_ = 0;
    }
    /// Registers that the attempt failed.
    void missed() {
        constexpr unsigned most = 16;
        waits_ = missed_ = std::min(2 * missed_ + 1, most);
    }
    void walked(double length) { length_ = length; }

private:
    double length_ = 0;
    unsigned waits_ = 0, missed_ = 0;
};

/// Returns whether a curve with this bound can be searched. Later bounds may be twice as large.
inline bool within_range(double fourth_bound) {
    return std::isfinite(4 * fourth_bound);
}

class FirstExit {
public:
    FirstExit(WalkedCurve& curve, Band band, double floor) : curve_(curve), band_(band), floor_(floor) {}
    /// Sets a bound of the fourth derivative from the present point on, instead of computing one.
    void bounded(double bound) { bound_ = bound; }

    /// Also ends the search at a creep.
    void watch(const Creep& creep) { creep_ = creep; }
    bool crept() const { return crept_; }

    /// The first exit from the present point to `until`; without one, the walk moves to `until`. A touch is reported
    /// once, and the next search starts after it.
    std::optional<Exit> search(double until);
    /// The first exit after `from`, where the curve is `start`. Empty unless it is near `from` + `guess` and proven,
    /// from both ends, to be the first. Does not move the walk, which must be near `from` for `By::a_look`. Requires a
    /// bound.
    enum class By { the_beginning, a_look };
    std::optional<Exit> at_once(double from, const WalkedCurve::End& start, double guess, double until,
                                By by = By::the_beginning);
    /// The curve at the crossing found; slope 0 if it was not evaluated.
    const WalkedCurve::End& end() const { return end_; }
    /// Moves the walk from a crossing to a point certainly inside.
    void depart(double from, const WalkedCurve::End& start, double until);
    /// Moves to a point certainly inside, from a start on the edge with these derivatives (positive: inwards). Returns
    /// false if there is none.
    bool leave(double first, double second, double third, double until);
    /// Changes the band, for the next zero of a curve that oscillates.
    void set_band(Band band) { band_ = band; }

private:
    struct Hull {
        double low, high;   ///< range of the cubic
        double d0, d1, d2;  ///< differences of its coefficients
        /// Their deviation from a straight line.
        double bend() const { return std::max(std::fabs(d1 - d0), std::fabs(d2 - d1)); }
        /// h times the greatest and the least slope of the cubic.
        double rise() const { return 3 * std::max(std::max(d0, d1), d2); }
        double fall() const { return 3 * std::min(std::min(d0, d1), d2); }
    };
    [[nodiscard]] static Hull hull(const WalkedCurve::Value& a, const WalkedCurve::Value& b, double h);
    double cubic_crossing(const WalkedCurve::Value& a, const WalkedCurve::Value& b, double h, double edge) const;
    struct Zero {
        double tau;
        bool exact;  ///< whether the error is below rounding
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
    double farthest_look(double bound, double rounding) const;
    double far_from_edges(double rounding) const;
    double untabulated_length(double bound, int level, double left, int finer) const;
    double margin(double f) const { return std::min(f - band_.low, band_.high - f); }

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
