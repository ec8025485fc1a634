// What one term of an excitation does: its value, its next break, and itself at a later time.
//
// The invariant of this file: `next_break` returns exactly the double that `value` compares with. So value(b) is the
// new level and value(nextafter(b, -inf)) the old one, whatever a delay or the ten thousandth period was rounded to.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "model/excitation.hpp"

namespace dinal::model::terms {

inline constexpr double two_pi = 2 * std::numbers::pi;

/// x, or at least the next double after t: a break must always lead on.
inline double later(double t, double x) {
    return x > t ? x : std::nextafter(t, never);
}

/// The largest n with edge(n) <= t, for the edges of a periodic term.
// NOTE: floor() of the quotient is a guess that rounding can put off by one; the edges themselves decide. The
// corrections are counted, because far out (t / period > 2^53) the edges are no longer distinct.
template <class Edge>
double cycle_at(double t, double quotient, const Edge& edge) {
    constexpr int most_corrections = 4;
    double n = std::floor(quotient);
    for (int i = 0; i < most_corrections && edge(n) > t; ++i) {
        n -= 1;
    }
    for (int i = 0; i < most_corrections && edge(n + 1) <= t; ++i) {
        n += 1;
    }
    return n;
}

/// How far t is from `from` to `to`, as a fraction.
inline double fraction(double t, double from, double to) {
    return to > from ? (t - from) / (to - from) : 0;
}

inline double value(const Constant& c, double) {
    return c.level;
}
inline double value(const Harmonic& h, double t) {
    return h.amplitude * std::sin(h.omega * t + h.phase);
}
inline double value(const Step& s, double t) {
    return t < s.at ? 0 : s.level;
}
inline double value(const Pulse& p, double t) {
    return t >= p.at && t < p.at + p.width ? p.amplitude : 0;
}

inline double value(const HalfSine& h, double t) {
    if (t < h.at || t >= h.at + h.width) {
        return 0;
    }
    return h.amplitude * std::sin(std::numbers::pi * ((t - h.at) / h.width));
}

inline double value(const Ramp& r, double t) {
    if (t < r.at) {
        return 0;
    }
    return r.slope * (t < r.at + r.width ? t - r.at : r.width);
}

struct SquareCycle {
    double fall, end;
};
inline SquareCycle cycle(const Square& s, double t) {
    const auto edge = [&s](double n) { return s.at + n * s.period; };
    const double n = cycle_at(t, (t - s.at) / s.period, edge);
    return {edge(n + s.duty), edge(n + 1)};
}
inline double value(const Square& s, double t) {
    return t < cycle(s, t).fall ? s.amplitude : -s.amplitude;
}

struct SawtoothCycle {
    double start, end;
};
inline SawtoothCycle cycle(const Sawtooth& s, double t) {
    const auto edge = [&s](double n) { return s.at + n * s.period; };
    const double n = cycle_at(t, (t - s.at) / s.period, edge);
    return {edge(n), edge(n + 1)};
}
inline double value(const Sawtooth& s, double t) {
    const SawtoothCycle c = cycle(s, t);
    return -s.amplitude + 2 * s.amplitude * fraction(t, c.start, c.end);
}

/// A straight piece between two corners, which lie at a quarter and three quarters of each period.
struct TriangleSide {
    double start, end;
    bool falling;
};
inline TriangleSide side(const Triangle& s, double t) {
    const auto corner = [&s](double n) { return s.at + (0.5 * n + 0.25) * s.period; };
    const double n = cycle_at(t, 2 * ((t - s.at) / s.period) - 0.5, corner);
    return {corner(n), corner(n + 1), std::fmod(n, 2) == 0};
}
inline double value(const Triangle& s, double t) {
    const TriangleSide piece = side(s, t);
    const double from = piece.falling ? s.amplitude : -s.amplitude;
    return from - 2 * from * fraction(t, piece.start, piece.end);
}

/// The phase is the integral of the frequency: continuous, and so is its slope.
inline double value(const Chirp& c, double t) {
    const double tau = t - c.at;
    double cycles = 0;
    if (t < c.at) {
        cycles = c.from * tau;
    } else if (t < c.at + c.duration) {
        cycles = tau * (c.from + 0.5 * (c.to - c.from) * (tau / c.duration));
    } else {
        cycles = c.duration * (0.5 * (c.from + c.to)) + c.to * (tau - c.duration);
    }
    return c.amplitude * std::sin(two_pi * cycles + c.phase);
}

inline double value(const Exponential& e, double t) {
    return t < e.at ? 0 : e.amplitude * std::exp(-(t - e.at) / e.tau);
}

/// Horner's scheme in t - at.
inline double value(const Polynomial& p, double t) {
    const double x = t - p.at;
    double sum = 0;
    for (auto c = p.coefficients.rbegin(); c != p.coefficients.rend(); ++c) {
        sum = sum * x + *c;
    }
    return sum;
}

/// The index i with t[i] <= at < t[i + 1], for times inside the table. Records are mostly sampled evenly, so the
/// guess is mostly right.
inline std::size_t segment(const Samples& s, double at) {
    const double steps = static_cast<double>(s.t.size() - 1);
    const double guess = std::clamp(steps * fraction(at, s.t.front(), s.t.back()), 0.0, steps - 1);
    const auto i = static_cast<std::size_t>(guess);
    if (s.t[i] <= at && at < s.t[i + 1]) {
        return i;
    }
    return static_cast<std::size_t>(std::upper_bound(s.t.begin(), s.t.end(), at) - s.t.begin()) - 1;
}
inline double value(const std::shared_ptr<const Samples>& samples, double t) {
    const Samples& s = *samples;
    if (!(t >= s.t.front())) {
        return s.M.front();
    }
    if (t >= s.t.back()) {
        return s.M.back();
    }
    const std::size_t i = segment(s, t);
    return s.M[i] + (s.M[i + 1] - s.M[i]) * ((t - s.t[i]) / (s.t[i + 1] - s.t[i]));
}

// ---- breaks

inline double first_after(double t, std::initializer_list<double> sorted) {
    for (const double x : sorted) {
        if (x > t) {
            return x;
        }
    }
    return never;
}

inline double next_break(const Constant&, double) {
    return never;
}
inline double next_break(const Harmonic&, double) {
    return never;
}
inline double next_break(const Step& s, double t) {
    return first_after(t, {s.at});
}
inline double next_break(const Pulse& p, double t) {
    return first_after(t, {p.at, p.at + p.width});
}
inline double next_break(const HalfSine& h, double t) {
    return first_after(t, {h.at, h.at + h.width});
}
inline double next_break(const Ramp& r, double t) {
    return first_after(t, {r.at, r.at + r.width});
}
inline double next_break(const Square& s, double t) {
    const SquareCycle c = cycle(s, t);
    return later(t, c.fall > t ? c.fall : c.end);
}
inline double next_break(const Sawtooth& s, double t) {
    return later(t, cycle(s, t).end);
}
inline double next_break(const Triangle& s, double t) {
    return later(t, side(s, t).end);
}
inline double next_break(const Chirp& c, double t) {
    return first_after(t, {c.at, c.at + c.duration});
}
inline double next_break(const Exponential& e, double t) {
    return first_after(t, {e.at});
}
inline double next_break(const Polynomial&, double) {
    return never;
}
inline double next_break(const std::shared_ptr<const Samples>& s, double t) {
    if (s->t.size() == 1) {
        return never;
    }
    const auto next = std::upper_bound(s->t.begin(), s->t.end(), t);
    if (next == s->t.end()) {
        return never;
    }
    return *next;
}
inline double next_break(const Scripted& s, double t) {
    if (s.breaks.empty()) {
        return never;
    }
    const auto first_in_cycle = [&s, t](double n) {
        const auto at = [&s, n](double b) { return b + n * s.period + s.delay; };
        const auto found = std::partition_point(s.breaks.begin(), s.breaks.end(), [&](double b) { return at(b) <= t; });
        return found == s.breaks.end() ? never : at(*found);
    };
    if (!(s.period > 0)) {
        return first_in_cycle(0);
    }
    const double n = std::floor((t - s.delay - s.breaks.front()) / s.period);
    for (int offset = -1; offset <= 2; ++offset) {
        if (const double found = first_in_cycle(n + offset); found < never) {
            return found;
        }
    }
    return std::nextafter(t, never);
}

// ---- the same term, later by d

inline void shift(Constant&, double) {}
inline void shift(Harmonic& h, double d) {
    h.phase -= h.omega * d;
}
inline void shift(std::shared_ptr<const Samples>& samples, double d) {
    Samples moved = *samples;
    for (double& t : moved.t) {
        t += d;
    }
    moved.delay += d;
    samples = std::make_shared<const Samples>(std::move(moved));
}
inline void shift(Scripted& s, double d) {
    s.delay += d;
}
template <class T>
void shift(T& term, double d) {
    term.at += d;
}

}  // namespace dinal::model::terms
