#include "model/bounds.hpp"

#include <algorithm>

namespace dinal::model::bounds {
namespace {

constexpr double unit = std::numeric_limits<double>::epsilon();

/// An infinite bound becomes the greatest double, so that 1/x stays bounded.
Interval checked(double lo, double hi) {
    constexpr double greatest = std::numeric_limits<double>::max();
    return lo <= hi ? Interval{std::min(lo, greatest), std::max(hi, -greatest)} : anything;
}

/// Widens by a few roundings, as functions of the C library are not quite monotonic; the sign is kept.
Interval wider(Interval a) {
    constexpr double part = 1e-15;
    const Interval known = checked(a.lo, a.hi);
    if (known.is_anything()) return known;
    const auto moved = [](double x, double sign) {
        const double by = std::isfinite(x) ? part * std::fabs(x) : 0;
        return x * sign < 0 ? x + sign * std::min(by, std::fabs(x)) : x + sign * by;
    };
    return {moved(known.lo, -1), moved(known.hi, 1)};
}

double at(Op op, double a, double b = 0) {
    double result = 0;
    return apply(op, a, b, result) ? result : std::numeric_limits<double>::quiet_NaN();
}

/// The image under a rising function.
Interval ends(Op op, const Interval& a) {
    return {at(op, a.lo), at(op, a.hi)};
}

Interval corners(Op op, const Interval& a, const Interval& b) {
    Interval r{never, -never};
    for (const double x : {a.lo, a.hi}) {
        for (const double y : {b.lo, b.hi}) {
            const double value = at(op, x, y);
            if (value != value) return anything;
            r.lo = std::min(r.lo, value), r.hi = std::max(r.hi, value);
        }
    }
    return checked(r.lo, r.hi);
}

Interval power(const Interval& a, const Interval& b) {
    const bool whole = b.is_one() && b.lo == std::floor(b.lo);
    if (!(a.lo > 0 || whole) || (b.lo < 0 && a.lo <= 0 && a.hi >= 0)) return anything;
    Interval r = corners(Op::power, a, b);
    if (a.lo < 0 && a.hi > 0 && !r.is_anything()) r.lo = std::min(r.lo, 0.0), r.hi = std::max(r.hi, 0.0);
    return wider(r);
}

constexpr double half_turn = 3.14159265358979323846;

/// The image under a sine or cosine with extremes at (n - shift) half turns.
Interval wave(Op op, const Interval& a, double shift) {
    constexpr double far = 1e6, margin = 1e-9;
    if (!(a.hi - a.lo < 2 * half_turn) || std::fabs(a.lo) > far || std::fabs(a.hi) > far) {
        return std::isfinite(a.lo) && std::isfinite(a.hi) ? Interval{-1, 1} : anything;
    }
    Interval r = ends(op, a);
    if (r.lo > r.hi) std::swap(r.lo, r.hi);
    r = wider(r);
    const auto last = static_cast<std::int64_t>(std::floor(a.hi / half_turn + shift + margin));
    for (auto n = static_cast<std::int64_t>(std::ceil(a.lo / half_turn + shift - margin)); n <= last; ++n) {
        n % 2 == 0 ? r.hi = 1 : r.lo = -1;
    }
    return r;
}

Interval tangent(const Interval& a) {
    const Interval below = wave(Op::cos, a, 0);
    return a.hi - a.lo < half_turn && (below.lo > 0 || below.hi < 0) ? wider(ends(Op::tan, a)) : anything;
}

/// The range of whole numbers that are exact.
Interval exactly(const Interval& a) {
    constexpr double whole_numbers = 0x1p53;
    return std::max(std::fabs(a.lo), std::fabs(a.hi)) < whole_numbers ? a : anything;
}

/// Operations that are smooth only between folds.
Interval fold(Op op, const Interval& a, const Interval& b) {
    const double size = std::max(std::fabs(b.lo), std::fabs(b.hi));
    const bool known = std::isfinite(a.lo) && std::isfinite(a.hi) && (b.lo > 0 || b.hi < 0);
    if ((op == Op::modulo || op == Op::fmod) && !known) return anything;
    switch (op) {
        case Op::abs:
            return {0, std::max(-a.lo, a.hi)};
        case Op::modulo:
            return {std::min(b.lo, 0.0), std::max(b.hi, 0.0)};
        case Op::fmod:
            return {a.lo < 0 ? -size : 0, size};
        case Op::floor_divide: {
            const Interval q = image(Op::divide, a, b);
            return {std::floor(q.lo), std::floor(q.hi)};
        }
        default: {
            const auto step = [op](double x) { return op == Op::floor ? std::floor(x) : std::ceil(x); };
            return exactly({step(a.lo), step(a.hi)});
        }
    }
}

}  // namespace

Interval image(Op op, const Interval& a, const Interval& b) {
    if (a.is_anything() || b.is_anything()) return anything;
    if (op == Op::exact) return exactly(a);
    if (is_fold(op)) {
        const auto decision = decision_over(op, a, b);
        if (!decision || op == Op::floor_divide) return fold(op, a, b);
        if (op == Op::floor || op == Op::ceil) return {*decision, *decision};
        Interval r{at(op, a.lo, b.lo), at(op, a.hi, b.lo)};
        if (r.lo > r.hi) std::swap(r.lo, r.hi);
        return checked(r.lo, r.hi);
    }
    switch (op) {
        case Op::add:
            return checked(a.lo + b.lo, a.hi + b.hi);
        case Op::subtract:
            return checked(a.lo - b.hi, a.hi - b.lo);
        case Op::divide:
            return b.lo <= 0 && b.hi >= 0 ? anything : corners(op, a, b);
        case Op::multiply:
            return corners(op, a, b);
        case Op::power:
            return power(a, b);
        case Op::negate:
            return {-a.hi, -a.lo};
        case Op::sin:
            return wave(op, a, -0.5);
        case Op::cos:
            return wave(op, a, 0);
        case Op::tan:
            return tangent(a);
        case Op::exp:
        case Op::sqrt:
        case Op::log:
        case Op::log2:
        case Op::log10:
        case Op::asin:
            return wider(ends(op, a));  // NaN at an end: outside of the domain
        case Op::acos:
            return wider(ends(op, {a.hi, a.lo}));
        case Op::atan2:
            return b.lo > 0 ? wider(corners(op, a, b)) : anything;
        case Op::native:
            return image(to_excitation(b.lo), a);
        default:
            return anything;
    }
}

std::optional<double> decision_over(Op op, const Interval& a, const Interval& b) {
    constexpr double whole_numbers = 0x1p53;
    if (a.is_anything() || b.is_anything()) return {};
    switch (op) {
        case Op::less:
            if (a.lo >= b.hi) return 0;
            if (a.hi < b.lo) return 1;
            return {};
        case Op::less_equal:
            if (a.lo > b.hi) return 0;
            if (a.hi <= b.lo) return 1;
            return {};
        case Op::equal:
            if (a.hi < b.lo || a.lo > b.hi) return 0;
            return {};
        case Op::abs:
            if (a.hi < 0) return -1;
            if (a.lo >= 0) return 1;
            return {};
        default: {
            const bool alone = op == Op::floor || op == Op::ceil;
            double lo = 0, hi = 0;
            if (!(alone || b.is_one()) || !apply(op, a.lo, b.lo, lo) || !apply(op, a.hi, b.lo, hi)) return {};
            const double first = decision_of(op, a.lo, b.lo, lo);
            const bool same = first == decision_of(op, a.hi, b.lo, hi) && std::fabs(first) < whole_numbers;
            return same && !(op == Op::fmod && (a.lo < 0) != (a.hi < 0)) ? std::optional(first) : std::nullopt;
        }
    }
}

// ---- discs

namespace {

/// An upper bound of exp(x) - 1.
double grows(double x) {
    return std::expm1(x * (1 + 8 * unit));
}

double power_radius(const Disc& a, double p, double c) {
    const double size = std::fabs(a.c), value = std::fabs(c);
    const bool whole = p == std::floor(p), entire = whole && p >= 0;
    if (size == 0) return entire ? std::pow(a.r, p) : never;
    const double part = a.r / size * (1 + 4 * unit);
    if (!entire && (!(part < 1) || (a.c < 0 && !whole))) return never;
    const double x = entire ? p * std::log1p(part) : -std::fabs(p) * std::log1p(-part);
    constexpr double underflow = 1e-200;
    if (value >= underflow) return value * (p > 0 && p < 1 ? -std::expm1(-x) : grows(x));
    const double most = p * std::log(p > 0 ? size + a.r : size - a.r);
    return std::exp(most + 8 * unit * (std::fabs(most) + std::fabs(p)));
}

double atan_radius(const Disc& a) {
    const double part = a.r / std::sqrt(1 + a.c * a.c) * (1 + 4 * unit);
    return part < 1 ? -std::log1p(-part) : never;
}

double radius(Op op, const Disc& a, const Disc& b, double c) {
    const auto of = [](Op inner, const Disc& x, const Disc& y) { return image(inner, x, y, at(inner, x.c, y.c)); };
    switch (op) {
        case Op::add:
        case Op::subtract:
            return a.r + b.r;
        case Op::negate:
        case Op::exact:
            return a.r;
        case Op::multiply:
            return std::fabs(a.c) * b.r + std::fabs(b.c) * a.r + a.r * b.r;
        case Op::divide:
            return b.r < std::fabs(b.c) ? (a.r + std::fabs(c) * b.r) / (std::fabs(b.c) - b.r) : never;
        case Op::power:
            if (b.r == 0) return power_radius(a, b.c, c);
            return radius(Op::exp, of(Op::multiply, b, of(Op::log, a, a)), {}, c);
        case Op::sin:
        case Op::cos: {
            const double h = std::sinh(a.r / 2), s = std::fabs(std::sin(a.c)), k = std::fabs(std::cos(a.c));
            return (op == Op::sin ? k : s) * std::sinh(a.r) + 2 * (op == Op::sin ? s : k) * h * h;
        }
        case Op::tan:
            return radius(Op::divide, of(Op::sin, a, a), of(Op::cos, a, a), c);
        case Op::asin:
        case Op::acos: {
            const double size = std::fabs(a.c), most = (size + a.r) * (1 + 2 * unit);
            return most < 1 ? std::asin(most) - std::asin(size) + unit : never;
        }
        case Op::atan2:
            return b.c > 0 ? atan_radius(of(Op::divide, a, b)) : never;
        case Op::exp:
            return a.r < 1 ? c * std::expm1(a.r) : std::exp(a.c + a.r + 2 * unit * (std::fabs(a.c) + a.r)) - c;
        case Op::log:
        case Op::log2:
        case Op::log10: {
            const double part = a.r / a.c * (1 + 4 * unit);
            if (!(part >= 0 && part < 1)) return never;
            return -std::log1p(-part) * (op == Op::log ? 1 : op == Op::log2 ? 1.4426950408889634 : 0.4342944819032518);
        }
        case Op::sqrt:
            return a.r < a.c ? a.r / (c + std::sqrt(a.c - a.r)) : never;
        case Op::native:
            return bounds::radius(to_excitation(b.c), a);
        default:
            return never;
    }
}

}  // namespace

Disc image(Op op, const Disc& a, const Disc& b, double c) {
    return {c, outward(radius(op, a, b, c), c)};
}

// ---- the program

void Walk::begin(const Formula& formula, const terms::Piece* piece, bool ranges) {
    formula_ = &formula, ranges_ = ranges;
    held_ = piece == nullptr ? nullptr : piece->decisions.data();
    const std::vector<double>& registers = formula.registers();
    slots_.resize(registers.size());
    for (std::size_t i = 0; i < slots_.size(); ++i) slots_[i] = number(registers[i]);
}

Walk::Slot Walk::combined(Op op, const Slot& a, const Slot& b) const {
    constexpr double least_gain = 1e-12;
    const double c = at(op, a.disc.c, b.disc.c);
    Slot result{image(op, a.disc, b.disc, c), {}, 0, false};
    if (!ranges_) return result;
    if (op == Op::native && to_excitation(b.disc.c).next_break(a.range.lo) <= a.range.hi) result.disc.r = never;
    const bool square = op == Op::multiply && &a == &b;  // a square is never negative
    result.range = square ? image(Op::power, a.range, Interval{2, 2}) : image(op, a.range, b.range);
    if (a.apart > 0 || b.apart > 0) {
        const auto most = [](const Slot& s) { return std::max(std::fabs(s.range.lo), std::fabs(s.range.hi)); };
        const bool adds = op == Op::add || op == Op::subtract || op == Op::negate;
        result.apart = adds                 ? a.apart + (op == Op::negate ? 0 : b.apart)
                       : op == Op::multiply ? most(a) * b.apart + a.apart * (most(b) + b.apart)
                                            : never;
    }
    const double way = std::max(result.range.hi - c, c - result.range.lo);
    if (std::isnan(way)) {
        result.disc.r = 0, result.apart = never;
    } else if (!(result.disc.r * least_gain + result.apart <= way)) {
        result.disc.r = 0, result.apart = way;
    }
    return result;
}

/// The result of a folding operation whose decision is held, also beyond the piece.
Walk::Slot Walk::on_piece(Op op, const Slot& a, const Slot& b, double decision) const {
    if (op == Op::abs) return decision < 0 ? combined(Op::negate, a, a) : a;
    if (op != Op::modulo && op != Op::fmod) return number(decision);
    Slot rest = combined(Op::subtract, a, combined(Op::multiply, number(decision), b));
    rest.disc.c = std::fma(-decision, b.disc.c, a.disc.c);  // exact, like the operation itself
    const double rounded = 4 * unit * std::max(std::fabs(a.range.lo), std::fabs(a.range.hi));
    rest.range.lo -= rounded, rest.range.hi += rounded;
    return rest;
}

Walk::Result Walk::run(std::optional<std::size_t> condition) {
    constexpr Result undecided{{std::numeric_limits<double>::quiet_NaN(), never}, never, anything};
    const auto as_result = [](const Slot& s) { return Result{s.disc, s.apart, s.range}; };
    greatest_relative_radius_ = 0;
    for (std::size_t place = 0;;) {
        const Formula::Step& s = formula_->steps()[place];
        const Slot &a = slots_[s.a], &b = slots_[s.b];
        const bool compares = is_comparison(s.op), decides = compares || is_fold(s.op);
        const double held = held_ == nullptr || !decides ? undecided.disc.c : held_[place];
        if (s.op == Op::jump) {
            place = s.yes;
        } else if (s.op == Op::give) {
            return as_result(a);
        } else if (s.op >= Op::give) {
            return undecided;
        } else if (s.op == Op::move) {
            const Slot moved = a;
            slots_[s.to] = moved;
            ++place;
        } else if (held == held || (decides && !(a.constant && b.constant))) {
            std::optional<double> decision = held;
            if (held != held) {
                double result = 0;
                const bool good = apply(s.op, a.disc.c, b.disc.c, result) || compares;
                decision = ranges_ ? decision_over(s.op, a.range, b.range)
                           : good  ? std::optional(decision_of(s.op, a.disc.c, b.disc.c, result))
                                   : std::nullopt;
            } else {
                const bool quotient = s.op == Op::modulo || s.op == Op::fmod || s.op == Op::floor_divide;
                const Slot decider = compares || quotient ? combined(compares ? Op::subtract : Op::divide, a, b) : a;
                if (condition == place) return as_result(decider);
                const double part = decider.apart > 0 ? never : decider.disc.r / std::fabs(decider.disc.c);
                greatest_relative_radius_ = std::max(greatest_relative_radius_, part == part ? part : never);
            }
            if (!decision) return undecided;
            if (compares) {
                place = *decision != 0 ? s.yes : s.no;
            } else {
                slots_[s.to] = on_piece(s.op, a, b, *decision);
                ++place;
            }
        } else if (a.constant && b.constant) {
            double result = 0;
            const bool good = apply(s.op, a.disc.c, b.disc.c, result);
            if (!good && !compares) return undecided;
            if (compares) {
                place = good ? s.yes : s.no;
            } else {
                slots_[s.to] = number(result);
                ++place;
            }
        } else {
            slots_[s.to] = combined(s.op, a, b);
            ++place;
        }
    }
}

}  // namespace dinal::model::bounds
