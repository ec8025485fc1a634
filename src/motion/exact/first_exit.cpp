#include "motion/exact/first_exit.hpp"

#include <algorithm>
#include <cmath>

namespace dinal::motion::exact {

namespace {

/// A motion that decays has smaller bounds later on.
constexpr unsigned looks_between_bounds = 8;
constexpr double hermite = 1.0 / 384;  // of max|f''''| h^4
constexpr double of_slope = 0.0081;    // sqrt(3)/216, of max|f''''| h^3: what the slope of the cubic may be off by

}  // namespace

FirstExit::Hull FirstExit::hull(const WalkedCurve::Value& a, const WalkedCurve::Value& b, double h) {
    const double third = h * (1.0 / 3), b0 = a.f, b1 = a.f + third * a.slope, b2 = b.f - third * b.slope, b3 = b.f;
    const double d0 = b1 - b0, d1 = b2 - b1, d2 = b3 - b2;
    return {std::min(std::min(b0, b1), std::min(b2, b3)), std::max(std::max(b0, b1), std::max(b2, b3)),
            std::max(std::fabs(d1 - d0), std::fabs(d2 - d1)), 3 * std::max(std::max(d0, d1), d2),
            3 * std::min(std::min(d0, d1), d2)};
}

/// A crossing that needs no search.
Exit FirstExit::crossing(double tau, int side) {
    curve_.at(tau);
    return {tau, side, true};
}

/// A look as long as the bound lets it be, seen from where the curve is and where it heads.
void FirstExit::choose_level(double bound) {
    const double away = std::fabs(margin(curve_.here().f)) / 4, heads = std::fabs(curve_.here().slope) / 12;
    const auto fits = [&](int level) {
        const double h = curve_.length(level), square = h * h;
        return bound * (square * square) * hermite <= away + heads * h;
    };
    while (level_ > 0 && fits(level_ - 1)) --level_;
    while (level_ + 1 < WalkedCurve::levels && !fits(level_)) ++level_;
}

/// Whether it is slower than rounding already, also where the looks are shorter than a creep.
bool FirstExit::creeps_from_here(double until) {
    const double h = creep_->shortest, from = curve_.place();
    const auto slow = [&](double speed) { return speed * (creep_->damping + creep_->inertia / h) <= creep_->least; };
    const WalkedCurve::Value here = curve_.here();
    if (!slow(std::fabs(here.f)) || from + h > until) return false;
    const double hidden = curve_.fourth_bound(until) * (h * h) * (h * h) * hermite;
    const Hull cubic = hull(here, curve_.look_at(from + h), h);
    if (!slow(std::max(std::fabs(cubic.low), std::fabs(cubic.high)) + hidden)) return false;
    curve_.go();
    return crept_ = true;
}

std::optional<Exit> FirstExit::search(double until) {
    int finer = 0;  // halvings of the present look
    double rounding = 0, bound = 0;
    for (unsigned looks = 0; curve_.place() < until; ++looks) {
        if (looks % looks_between_bounds == 0) {
            bound = curve_.fourth_bound(until);
            rounding = std::max(floor_, 8 * epsilon * curve_.size(until));
        }
        if (creep_ && creeps_from_here(until)) return {};
        if (finer == 0 && bound != 0) choose_level(bound);
        const int level = level_ + finer;
        const double from = curve_.place(), left = until - from;
        double h = bound == 0 ? std::ldexp(left, -finer)  // a polynomial hides nothing
                   : level < WalkedCurve::levels
                       ? curve_.length(level)
                       : std::ldexp(curve_.length(WalkedCurve::levels - 1), WalkedCurve::levels - 1 - level);
        const bool tabled = bound != 0 && level < WalkedCurve::levels && h < left;
        h = std::min(h, left);
        const WalkedCurve::Value here = curve_.here();
        const WalkedCurve::Value there = tabled ? curve_.look(level) : curve_.look_at(h == left ? until : from + h);
        const double square = h * h, fourth = bound * (square * square), hidden = fourth * hermite;
        const Hull cubic = hull(here, there, h);
        if (creep_ && h >= creep_->shortest) {
            const double speed = std::max(std::fabs(cubic.low), std::fabs(cubic.high)) + hidden;
            if (speed * (creep_->damping + creep_->inertia / h) <= creep_->least) {
                curve_.go();
                crept_ = true;
                return {};
            }
        }
        if (cubic.low - hidden > band_.low + rounding && cubic.high + hidden < band_.high - rounding) {
            curve_.go();
            finer = 0;
            continue;
        }
        const int side = there.f < band_.low - rounding ? -1 : there.f > band_.high + rounding ? 1 : 0;
        const double doubt = fourth * of_slope;
        const bool one_way = side < 0 ? cubic.falls + doubt < 0 : cubic.rises - doubt > 0;
        if (side != 0 && one_way) {
            const double edge = side < 0 ? band_.low : band_.high;
            if (side < 0 ? here.f <= edge : here.f >= edge) return crossing(from, side);
            return Exit{polish(from, from + h, from + cubic_crossing(here, there, h, edge), edge, side), side, true};
        }
        if (hidden + cubic.bend <= rounding || h <= 4 * epsilon * (from + h) || finer > 100) {
            // All of the look is a straight line within rounding.
            if (side != 0) {
                const double edge = side < 0 ? band_.low : band_.high, off = here.f - edge;
                const double part = off * side >= 0 ? 0 : off / (off - (there.f - edge));
                return crossing(from + h * part, side);
            }
            const bool at_here = margin(here.f) < margin(there.f);
            const double lowest = at_here ? here.f : there.f;
            if (margin(lowest) <= rounding) {
                const Exit touch{at_here ? from : from + h, lowest - band_.low < band_.high - lowest ? -1 : 1, false};
                curve_.go();
                return touch;
            }
            curve_.go();
            finer = 0;
            continue;
        }
        ++finer;
    }
    return {};
}

/// Where the cubic comes to the edge, by Newton's method from the chord.
double FirstExit::cubic_crossing(const WalkedCurve::Value& a, const WalkedCurve::Value& b, double h,
                                 double edge) const {
    const double f0 = a.f - edge, f1 = b.f - edge, s0 = a.slope * h, s1 = b.slope * h;
    const double c2 = 3 * (f1 - f0) - 2 * s0 - s1, c3 = 2 * (f0 - f1) + s0 + s1;
    double low = 0, high = 1, x = f0 / (f0 - f1);
    for (int i = 0; i < 8; ++i) {
        const double f = f0 + x * (s0 + x * (c2 + x * c3)), slope = s0 + x * (2 * c2 + 3 * x * c3);
        ((f > 0) == (f0 > 0) ? low : high) = x;
        double next = slope != 0 ? x - f / slope : low;
        if (!(next > low && next < high)) next = (low + high) / 2;
        const double moved = std::fabs(next - x);
        x = next;
        if (moved < 1e-4) break;
    }
    return x * h;
}

/// Newton's method on the curve itself, kept between where it is inside and where it is outside.
double FirstExit::polish(double from, double to, double guess, double edge, int side) {
    double inside = from, outside = to, tau = guess;
    for (int i = 0; i < 60; ++i) {
        const WalkedCurve::Value y = curve_.at(tau);
        const double off = (y.f - edge) * side;
        (off > 0 ? outside : inside) = tau;
        double next = y.slope != 0 ? tau - (y.f - edge) / y.slope : inside;
        if (!(next > inside && next < outside)) {
            if (std::fabs(next - tau) <= 4 * epsilon * outside || outside - inside <= 2 * epsilon * outside) break;
            next = inside + (outside - inside) / 2;
        }
        const double moved = std::fabs(next - tau);
        tau = next;
        // A step of true Newton leaves its square.
        if (moved <= 1e-9 * (to - from)) break;
    }
    return tau;
}

bool FirstExit::leave(double first, double second, double third, double until) {
    // f(s)/s >= first + second s/2 + third s^2/6 - bound s^3/24 on (0, s]: a cubic, by its Bernstein coefficients.
    const double fourth = curve_.fourth_bound(until);
    constexpr int most = 200;
    double h = curve_.length(usual_level) * 4;
    int level = usual_level - 2;
    for (int i = 0; i < most; ++i) {
        ++level;
        h /= 2;
        const double s = std::min(h, until);
        const double c1 = second / 2 * s, c2 = third / 6 * s * s, c3 = -fourth / 24 * s * s * s;
        const double b1 = first + c1 / 3, b2 = first + (2 * c1 + c2) / 3, b3 = first + c1 + c2 + c3;
        if (!(first >= 0 && b1 >= 0 && b2 >= 0 && b3 > 0)) continue;
        if (level < WalkedCurve::levels && h < until) {
            curve_.look(level);
        } else {
            curve_.look_at(s);
        }
        curve_.go();
        return true;
    }
    return false;
}

}  // namespace dinal::motion::exact
