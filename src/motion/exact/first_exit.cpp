#include "motion/exact/first_exit.hpp"

#include <algorithm>
#include <cmath>

namespace dinal::motion::exact {

namespace {

/// Bounds are recomputed after this many looks, because those of a decaying motion shrink.
constexpr unsigned looks_between_bounds = 8;
constexpr double hermite = 1.0 / 384;  // factor of max|f''''| h^4 in the error of the cubic
/// The accuracy of the cubic's zero, as a fraction of a look. One more Newton step squares it, and the cubic only
/// approximates the curve.
constexpr double near_enough = 0.01;
/// A motion counts as a departure only if it is this many times faster than a Creep.
constexpr double slowest_apart = 16;
constexpr double of_slope = 0.0081;  // sqrt(3)/216, factor of max|f''''| h^3 in the error of the cubic's slope

}  // namespace

inline FirstExit::Hull FirstExit::hull(const WalkedCurve::Value& a, const WalkedCurve::Value& b, double h) {
    const double third = h * (1.0 / 3), b0 = a.f, b1 = a.f + third * a.slope, b2 = b.f - third * b.slope, b3 = b.f;
    return {std::min(std::min(b0, b1), std::min(b2, b3)), std::max(std::max(b0, b1), std::max(b2, b3)), b1 - b0,
            b2 - b1, b3 - b2};
}

/// A crossing known without a search.
Exit FirstExit::crossing(double tau, int side) {
    curve_.at(tau);
    return {tau, side, true};
}

/// Chooses the longest look whose error bound fits the distance from the edges, or the distance by which the curve
/// approaches them.
void FirstExit::choose_level(double bound, double rounding) {
    const double away = far_from_edges(rounding), heads = std::fabs(curve_.here().slope) / 12;
    const auto fits = [&](int level) { return bound * curve_.hides(level) <= away + heads * curve_.length(level); };
    while (level_ > 0 && fits(level_ - 1)) --level_;
    while (level_ + 1 < WalkedCurve::levels && !fits(level_)) ++level_;
}

/// The length of a look whose error is within the distance from the edges.
double FirstExit::farthest_look(double bound, double rounding) const {
    return std::sqrt(std::sqrt(far_from_edges(rounding) / (bound * hermite)));
}

/// A quarter of the distance from the edges, but at least of the rounding.
double FirstExit::far_from_edges(double rounding) const {
    return std::max(std::fabs(margin(curve_.here().f)), rounding) / 4;
}

/// Returns whether the curve stays slower than rounding over the shortest one.
bool FirstExit::creeps_from_here(double until) {
    const double h = creep_.shortest, from = curve_.place();
    const auto slow = [this](double speed) { return speed <= creep_.fastest; };
    const WalkedCurve::Value here = curve_.here();
    if (from + h > until) return false;
    const double hidden = curve_.fourth_bound(until) * (h * h) * (h * h) * hermite;
    const Hull cubic = hull(here, curve_.look_at(from + h), h);
    if (!slow(std::max(std::fabs(cubic.low), std::fabs(cubic.high)) + hidden)) return false;
    curve_.accept_look();
    return crept_ = true;
}

/// The length of a look that the table does not have.
double FirstExit::untabulated_length(double bound, int level, double left, int finer) const {
    if (bound == 0) return std::ldexp(left, -finer);  // a polynomial of low degree has no error
    constexpr int last = WalkedCurve::levels - 1;
    return std::ldexp(curve_.length(last), last - level);
}

std::optional<Exit> FirstExit::search(double until) {
    end_ = {};
    int finer = 0, beyond = 0;  // halvings of the present look, and those for which the table has no level
    double far = 0;
    double rounding = 0, bound = bound_;
    for (unsigned looks = 0; curve_.place() < until; ++looks) {
        if (looks % looks_between_bounds == 0) {
            if (looks > 0 || !(bound >= 0)) bound = curve_.fourth_bound(until);
            rounding = std::max(floor_, 8 * epsilon * curve_.size(until));
        }
        const WalkedCurve::Value here = curve_.here();
        if (std::fabs(here.f) <= creep_.fastest && creeps_from_here(until)) return {};
        const double from = curve_.place(), left = until - from;
        if (finer == 0) {
            if (bound != 0) choose_level(bound, rounding);
            far = bound != 0 && level_ == 0 ? std::min(farthest_look(bound, rounding), left) : 0;
            beyond = 0;
        }
        // Slow curves allow looks longer than the table's.
        const double h_far = std::ldexp(far, -finer);
        const bool is_far = h_far > curve_.length(0);
        if (is_far) beyond = finer + 1;
        const int level = level_ + finer - beyond;
        const bool tabled = bound != 0 && !is_far && level < WalkedCurve::levels;
        double h = tabled ? curve_.length(level) : is_far ? h_far : untabulated_length(bound, level, left, finer);
        WalkedCurve::Value there;
        if (tabled && h < left) {
            there = curve_.look(level);
        } else {
            h = std::min(h, left);
            there = curve_.look_at(h == left ? until : from + h);
        }
        const double square = h * h, fourth = bound * (square * square), hidden = fourth * hermite;
        const Hull cubic = hull(here, there, h);
        if (h >= creep_.shortest) {
            const double speed = std::max(std::fabs(cubic.low), std::fabs(cubic.high)) + hidden;
            if (speed * (creep_.damping + creep_.inertia / h) <= creep_.least) {
                curve_.accept_look();
                crept_ = true;
                return {};
            }
        }
        if (cubic.low - hidden > band_.low + rounding && cubic.high + hidden < band_.high - rounding) {
            curve_.accept_look();
            finer = 0;
            continue;
        }
        if (!std::isfinite(cubic.high - cubic.low)) return {};  // not finite: the run ends here
        const int side = there.f < band_.low - rounding ? -1 : there.f > band_.high + rounding ? 1 : 0;
        const double doubt = fourth * of_slope;
        const bool one_way = side < 0 ? cubic.rise() + doubt < 0 : cubic.fall() - doubt > 0;
        if (side != 0 && one_way) {
            const double edge = side < 0 ? band_.low : band_.high;
            if (side < 0 ? here.f <= edge : here.f >= edge) return crossing(from, side);
            return Exit{polish(from, from + h, from + cubic_crossing(here, there, h, edge), edge, side, bound), side,
                        true};
        }
        if (hidden + cubic.bend() <= rounding || h <= 4 * epsilon * (from + h) || finer - beyond > 100) {
            // The whole look is a straight line within rounding.
            if (side != 0) {
                const double edge = side < 0 ? band_.low : band_.high, off = here.f - edge;
                const double part = off * side >= 0 ? 0 : off / (off - (there.f - edge));
                return crossing(from + h * part, side);
            }
            const bool at_here = margin(here.f) < margin(there.f);
            const double lowest = at_here ? here.f : there.f;
            if (margin(lowest) <= rounding) {
                const Exit touch{at_here ? from : from + h, lowest - band_.low < band_.high - lowest ? -1 : 1, false};
                curve_.accept_look();
                return touch;
            }
            curve_.accept_look();
            finer = 0;
            continue;
        }
        ++finer;
    }
    return {};
}

/// The crossing of the cubic with the edge, by Newton's method from the chord.
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
        if (moved < near_enough) break;
    }
    return x * h;
}

/// Approximates a zero by the Taylor polynomial about a guess.
FirstExit::Zero FirstExit::near(double guess, const WalkedCurve::Jet& y, double edge, double bound) {
    // As powers of x in units of the slope: x = a + q2 x^2 + q3 x^3 + ...
    const double per = -1 / y[1], a = (y[0] - edge) * per, q2 = y[2] * per, q3 = y[3] * per;
    const double bent = std::fabs(q2 * a) + a * a * std::fabs(q3), first = a * a * (q2 + a * (q3 + 2 * q2 * q2));
    constexpr double much = 0.1;
    if (!(bent < much)) return {guess + a + first, false};
    const double rounding = epsilon / 4 * std::fabs(y[1]) * guess;
    const auto said = [&](double x) {
        curve_.step_aside(x);
        end_ = {edge, y[1] + x * (2 * y[2] + x * (3 * y[3])), 2 * y[2] + x * (6 * y[3])};
        return Zero{guess + x, true};
    };
    // The error of truncation after three derivatives, and of the series.
    double x = a + first, square = a * a;
    if (bound * (square * square) * (1.0 / 24) <= rounding && bent * bent * bent * std::fabs(a * y[1]) <= rounding) {
        return said(x);
    }
    curve_.further_jet();
    for (int i = 0; i < 4; ++i) {
        const double high = y[4] + x * (y[5] + x * y[6]), low = y[2] + x * (y[3] + x * high);
        const double off = (x * x) * low * per + (a - x);
        const double step = off / (1 - x * (2 * q2 + 3 * x * q3));
        x += step;
        if (std::fabs(step) <= epsilon / 4 * guess) break;
    }
    const double grown = std::fabs(x) * curve_.fastest();
    square = x * x;
    const double left_out = bound * (square * square) * (grown * grown * grown) * (1.0 / 5040);
    if (!(left_out <= rounding)) return {guess + x, false};
    return said(x);
}

/// Refines a guess by the Taylor polynomial about it if that is accurate to rounding, otherwise by iteration.
double FirstExit::polish(double from, double to, double guess, double edge, int side, double bound) {
    const Zero zero = near(guess, curve_.jet(guess), edge, bound);
    if (zero.exact && zero.tau >= from && zero.tau <= to) return zero.tau;
    end_ = {};
    return step_by_step(from, to, guess, edge, side);
}

/// Returns whether the curve is on one side of an edge on the whole interval except at its ends, where it may touch the
/// edge. The curve differs from the quintic through values and two derivatives at both ends by at most max|f^(6)| s^3
/// (h - s)^3/720. So the Bernstein coefficients of degree six decide; only the middle one contains the error.
bool FirstExit::apart(const WalkedCurve::End& a, const WalkedCurve::End& b, double h, double edge, double side,
                      const Doubt& doubt) {
    const double fifth = side * h * (1.0 / 5), square = side * (h * h) * (1.0 / 20), cube = h * h * h;
    const double b0 = side * (a.f - edge), b1 = b0 + fifth * a.slope, b2 = b0 + 2 * fifth * a.slope + square * a.bend;
    const double b5 = side * (b.f - edge), b4 = b5 - fifth * b.slope, b3 = b5 - 2 * fifth * b.slope + square * b.bend;
    const double hidden = doubt.sixth * (cube * cube) * (1.0 / 14400);
    return b0 + 5 * b1 >= 0 && b1 + 2 * b2 >= 0 && (b2 + b3) / 2 - hidden > doubt.least &&
           2 * b3 + b4 > 3 * doubt.least && 5 * b4 + b5 > 6 * doubt.least;
}

std::optional<Exit> FirstExit::at_once(double from, const WalkedCurve::End& start, double guess, double until, By by) {
    const double rounding = std::max(floor_, 8 * epsilon * curve_.size(until));
    const bool one_sided = std::isinf(band_.low) || std::isinf(band_.high);
    constexpr double off_by_half = 1.5;
    until = std::min(until, from + off_by_half * guess);
    double bound = curve_.may_grow() ? curve_.fourth_bound(until) : bound_;
    // The walk is near `from`, where decaying parts have hardly changed.
    if (by == By::a_look) bound = std::min(bound, 1.01 * curve_.fourth_bound(until));
    double tau = from + guess;
    bool high = std::isinf(band_.low);
    constexpr int tries = 3;
    for (int i = 0; i < tries; ++i) {
        if (!(tau > from && tau < until)) return {};
        const bool ahead = i == 0 && by == By::a_look;
        if (ahead) tau = curve_.place() + guess;
        const WalkedCurve::Jet& y = ahead ? curve_.jet_ahead(guess) : curve_.jet(tau);
        if (!one_sided && i == 0) high = band_.high - y[0] < y[0] - band_.low;
        const double edge = high ? band_.high : band_.low;
        const int side = high ? 1 : -1;
        const Zero zero = near(tau, y, edge, bound);
        tau = zero.tau;
        if (!zero.exact) continue;
        const double h = tau - from;
        if (!(h > 0 && tau < until) || side * end_.slope <= 0) return {};
        const Doubt doubt{curve_.sixth_bound(bound), std::max(rounding, slowest_apart * creep_.fastest)};
        if (!apart(start, end_, h, edge, -side, doubt)) return {};
        if (!one_sided) {
            const double far = high ? band_.low : band_.high;
            if (!(side * (start.f - far) > rounding && apart(start, end_, h, far, side, doubt))) return {};
        }
        return Exit{tau, side, true};
    }
    return {};
}

void FirstExit::depart(double from, const WalkedCurve::End& start, double until) {
    for (int level = usual_level - 2; level < WalkedCurve::levels; ++level) {
        const double h = std::min(curve_.length(level), until - from);
        const WalkedCurve::Value there = curve_.look_at(from + h);
        const double third = h * (1.0 / 3), b1 = third * start.slope, b2 = there.f - third * there.slope;
        const double middle = std::isinf(band_.high) ? b1 + b2 : -(b1 + b2);
        // The cubic's Bernstein coefficients, raised to degree four; the error vanishes at both ends.
        const double last = std::isinf(band_.high) ? 3 * b2 + there.f : -(3 * b2 + there.f);
        if (middle > bound_ * (h * h) * (h * h) * (1.0 / 72) && last > 0 && margin(there.f) > 0) break;
    }
    curve_.accept_look();
}

double FirstExit::step_by_step(double from, double to, double guess, double edge, int side) {
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
        // The error of a Newton step is its square.
        if (moved <= 1e-9 * (to - from)) break;
    }
    return tau;
}

bool FirstExit::leave(double first, double second, double third, double until) {
    // f(s)/s >= first + second s/2 + third s^2/6 - bound s^3/24 on (0, s]: a cubic, by its Bernstein coefficients.
    const double fourth = bound_ >= 0 ? bound_ : curve_.fourth_bound(until);
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
        curve_.accept_look();
        return true;
    }
    return false;
}

}  // namespace dinal::motion::exact
