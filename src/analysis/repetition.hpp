// M over one of its periods: whether it is periodic, its extremes, its mean and its harmonics.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <type_traits>

#include "model/excitation.hpp"

namespace dinal::analysis {

/// M repeats with `period` from `start` on; period 0 means that nothing depends on time.
struct Repetition {
    double start = 0, period = 0;
};

/// The repetition declared by the terms; empty if unknown. The period of a constant M is `otherwise`.
std::optional<Repetition> repetition_of(const model::Excitation& excitation, double otherwise);

/// Returns whether M changes sign half a period later (at the opposite state, if it depends on the state).
bool is_antisymmetric(const model::Excitation& excitation, const Repetition& repeats);

/// (2/T) times the integral of M e^(-i 2 pi n t/T), counted from `start`; for n = 0 twice the mean.
std::complex<double> harmonic_of(const model::Excitation& excitation, const Repetition& repeats, double n);

struct TorqueRange {
    double low = 0, high = 0;
};
TorqueRange extremes(const model::Excitation& excitation, const Repetition& repeats);

inline double size_of(double value) {
    return std::fabs(value);
}
inline double size_of(const std::complex<double>& value) {
    return std::abs(value);
}

/// Gauss's rule with five points; if M is a function with unknown jumps, adaptive by halving.
template <class F>
class Quadrature {
public:
    using Value = std::invoke_result_t<F&, double>;
    Quadrature(F& f, bool halves) : f_(f), values_left_(halves ? most_values : 0) {}

    Value operator()(double from, double to) { return refined(from, to, once(from, to), 0); }

private:
    static constexpr int most_values = 20000, deepest = 44;

    Value once(double from, double to) {
        constexpr double x1 = 0.53846931010568309, x2 = 0.90617984593866399;
        constexpr double w0 = 0.56888888888888889, w1 = 0.47862867049936647, w2 = 0.23692688505618909;
        const double middle = (from + to) / 2, h = (to - from) / 2;
        return h * (w0 * f_(middle) + w1 * (f_(middle - x1 * h) + f_(middle + x1 * h)) +
                    w2 * (f_(middle - x2 * h) + f_(middle + x2 * h)));
    }
    Value refined(double from, double to, const Value& whole, int depth) {
        if (values_left_ <= 0 || depth == deepest) return whole;
        const double middle = from + (to - from) / 2;
        const Value first = once(from, middle), second = once(middle, to), both = first + second;
        values_left_ -= 10;
        constexpr double agreed = 1e-14;
        largest_ = std::max({largest_, size_of(first), size_of(second)});
        if (size_of(both - whole) <= agreed * largest_) return both;
        const Value refined_first = refined(from, middle, first, depth + 1);
        return refined_first + refined(middle, to, second, depth + 1);
    }

    F& f_;
    int values_left_;
    double largest_ = 0;
};

/// The integral of f over [from, to], divided at jumps of M and into pieces of at most `longest`.
template <class F>
auto integral(const model::Excitation& excitation, double from, double to, double longest, F&& f) {
    Quadrature<std::remove_reference_t<F>> piece(f, !std::isfinite(excitation.most()));
    decltype(f(from)) sum{};
    for (double a = from; a < to;) {
        const double limit = std::min(to, excitation.next_break(a));
        const auto pieces = static_cast<std::size_t>(std::max(1.0, std::ceil((limit - a) / longest)));
        const double h = (limit - a) / static_cast<double>(pieces);
        for (std::size_t i = 0; i < pieces; ++i) {
            const double start = a + static_cast<double>(i) * h;
            sum += piece(start, start + h);
        }
        a = limit;
    }
    return sum;
}

}  // namespace dinal::analysis
