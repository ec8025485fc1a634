// Locates a jump or kink of an otherwise smooth function to rounding, from its values alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

namespace dinal::motion {

/// The resolution of a located jump, as a part of the searched interval; it matters only near t = 0, where doubles are
/// denser.
inline constexpr double nearest_jump = 0x1p-100;

/// Returns the first double at which f has its value at b rather than at a. Near t = 0 the search ends at nearest_jump.
template <class F>
double jump_between(double a, double fa, double b, double fb, const F& f) {
    const double smallest = (b - a) * nearest_jump;
    for (;;) {
        const double middle = a + (b - a) / 2;
        if (!(middle > a && middle < b) || b - a <= smallest) return b;
        const double fm = f(middle);
        if (std::fabs(fm - fa) <= std::fabs(fm - fb)) {
            a = middle, fa = fm;
        } else {
            b = middle, fb = fm;
        }
    }
}

namespace detail {

constexpr double few_roundings = 64 * std::numeric_limits<double>::epsilon();

/// Three values at evenly spaced times, and the distance of the middle one from the straight line.
struct Triple {
    double a, fa, middle, fm, b, fb;
    double bend() const { return std::fabs(fa - 2 * fm + fb); }
    double noise() const {
        return 8 * std::numeric_limits<double>::epsilon() * (std::fabs(fa) + std::fabs(fm) + std::fabs(fb));
    }
};

/// The half of the triple (left, middle or right) that bends most; evaluates f twice.
template <class F>
Triple most_bent_half(const Triple& t, const F& f) {
    const double q1 = t.a + (t.middle - t.a) / 2, q3 = t.middle + (t.b - t.middle) / 2;
    const double f1 = f(q1), f3 = f(q3);
    const Triple left{t.a, t.fa, q1, f1, t.middle, t.fm}, centre{q1, f1, t.middle, t.fm, q3, f3},
        right{t.middle, t.fm, q3, f3, t.b, t.fb};
    const Triple& side = left.bend() >= right.bend() ? left : right;
    return side.bend() >= centre.bend() ? side : centre;
}

/// The jump between a and b, if bisection confirms it: the difference of the values persists across a jump and shrinks
/// elsewhere. Evaluates f once for each bisection.
template <class F>
std::optional<double> find_jump(double a, double fa, double b, double fb, const F& f) {
    constexpr int judged_at = 7, judged_again_at = 21;  // numbers of bisections after which the difference is tested
    const double at_first = std::fabs(fb - fa);
    for (int i = 1; i <= judged_again_at; ++i) {
        const double middle = a + (b - a) / 2;
        if (!(middle > a && middle < b)) return b;
        const double fm = f(middle);
        if (std::fabs(fm - fa) > std::fabs(fb - fm)) {
            b = middle, fb = fm;
        } else {
            a = middle, fa = fm;
        }
        // The difference halves each time if f is smooth or has a kink.
        const bool judged = i == judged_at || i == judged_again_at;
        if (judged && !(std::fabs(fb - fa) > at_first / 8)) return {};
    }
    return jump_between(a, fa, b, fb, f);
}

}  // namespace detail

/// The most visible jump or kink of f in its values at increasing times, if bisection confirms it. The second
/// difference stays (jump) or halves (kink), while that of a smooth f falls to a quarter.
template <class F>
std::optional<double> find_break(std::span<const double> times, std::span<const double> values, const F& f) {
    std::size_t worst = 0;
    double most = 0;
    for (std::size_t i = 1; i + 1 < times.size(); ++i) {
        const double part = (times[i] - times[i - 1]) / (times[i + 1] - times[i - 1]);
        const double bend = std::fabs(values[i] - (values[i - 1] + part * (values[i + 1] - values[i - 1])));
        if (bend > most) worst = i, most = bend;
    }
    if (worst == 0) return {};
    // Try a jump, or one edge of a narrow pulse, between the two values that differ most.
    const bool left = std::fabs(values[worst] - values[worst - 1]) >= std::fabs(values[worst + 1] - values[worst]);
    const std::size_t before = left ? worst - 1 : worst;
    if (std::fabs(values[before + 1] - values[before]) >
        detail::few_roundings * (std::fabs(values[before + 1]) + std::fabs(values[before]))) {
        const auto jump = detail::find_jump(times[before], values[before], times[before + 1], values[before + 1], f);
        if (jump) return jump;
    }
    const double a = times[worst - 1], b = times[worst + 1], middle = a + (b - a) / 2;
    detail::Triple t{a, values[worst - 1], middle, f(middle), b, values[worst + 1]};

    constexpr int judged_at = 7;        // number of bisections after which the bend is tested
    constexpr double smooth = 0x1p-10;  // a kink still bends by 2^-7 or more, a smooth f by 2^-14
    const double at_first = std::max(t.bend(), most);
    if (at_first <= 64 * t.noise()) return {};
    for (int i = 1; i < 60; ++i) {
        t = detail::most_bent_half(t, f);
        if (i == judged_at && !(t.bend() > smooth * at_first)) return {};
        const bool jumps = t.bend() > at_first / 8;
        if (i >= 3 * judged_at && jumps) return jump_between(t.a, t.fa, t.b, t.fb, f);
        if (t.bend() <= t.noise() || !(t.middle > t.a && t.middle < t.b)) {
            return i > judged_at ? std::optional(t.middle) : std::nullopt;
        }
    }
    return t.middle;
}

/// The breaks passed last, to predict the next one of a staircase, a square wave or a train of pulses.
class PassedBreaks {
public:
    void pass(double t) {
        std::rotate(last_.begin(), last_.begin() + 1, last_.end());
        last_.back() = t;
    }
    /// Returns the next jump of f if the last breaks repeat after one, two or three of them and f does jump at the
    /// predicted time. Costs about six values instead of sixty. Does not evaluate f beyond `end`.
    template <class F>
    std::optional<double> next(double end, const F& f) const {
        constexpr double known_to = 8 * std::numeric_limits<double>::epsilon();  // relative accuracy of a break's time
        const std::size_t latest = last_.size() - 1;
        for (std::size_t after = 1; 2 * after <= latest; ++after) {
            const double period = last_[latest] - last_[latest - after],
                         before = last_[latest - after] - last_[latest - 2 * after];
            if (!(std::fabs(period - before) <= known_to * std::fabs(last_[latest]))) continue;
            const double due = last_[latest + 1 - after] + period, off = known_to * std::fabs(due);
            const double a = due - off, b = std::min(due + off, end);
            if (!(a > last_[latest] && b > a)) return {};
            const double fa = f(a), fb = f(b);
            if (!(std::fabs(fb - fa) > detail::few_roundings * (std::fabs(fa) + std::fabs(fb)))) return {};
            return jump_between(a, fa, b, fb, f);
        }
        return {};
    }

private:
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    std::array<double, 7> last_{none, none, none, none, none, none, none};
};

}  // namespace dinal::motion
