// M over one of its periods: whether it is periodic, its extremes, its mean and its harmonics.
#pragma once

#include <complex>
#include <optional>

#include "model/excitation.hpp"
#include "text/expected.hpp"

namespace dinal::analysis {

/// From `start` on M repeats itself every `period`.
struct Drive {
    double start = 0, period = 0;
};

/// What is known of M without asking it: none when no period is. A constant M has any: `otherwise`.
std::optional<Drive> drive_of(const model::Excitation& excitation, double otherwise);

/// Asks M at times all over the period and one period later: the sentence that names the worst two that differ.
std::optional<text::Error> not_periodic(const model::Excitation& excitation, const Drive& drive);

/// M half a period later is the opposite (of the opposite state, where it depends on that).
bool is_antisymmetric(const model::Excitation& excitation, const Drive& drive);

/// (2/T) times the integral of M e^(-i 2 pi n t/T), counted from `start`: n = 0 has twice the mean.
std::complex<double> harmonic_of(const model::Excitation& excitation, const Drive& drive, double n);

struct DriveRange {
    double low = 0, high = 0;
};
DriveRange extremes(const model::Excitation& excitation, const Drive& drive);

/// The integral of f over [from, to], cut where M jumps and into pieces of at most `longest`, by Gauss with five
/// points.
template <class F>
auto integral(const model::Excitation& excitation, double from, double to, double longest, F&& f) {
    constexpr double x1 = 0.53846931010568309, x2 = 0.90617984593866399;
    constexpr double w0 = 0.56888888888888889, w1 = 0.47862867049936647, w2 = 0.23692688505618909;
    decltype(f(from)) sum{};
    for (double a = from; a < to;) {
        const double limit = std::min(to, excitation.next_break(a));
        const auto pieces = static_cast<std::size_t>(std::max(1.0, std::ceil((limit - a) / longest)));
        const double h = (limit - a) / static_cast<double>(pieces) / 2;
        for (std::size_t i = 0; i < pieces; ++i) {
            const double middle = a + static_cast<double>(2 * i + 1) * h;
            sum += h * (w0 * f(middle) + w1 * (f(middle - x1 * h) + f(middle + x1 * h)) +
                        w2 * (f(middle - x2 * h) + f(middle + x2 * h)));
        }
        a = limit;
    }
    return sum;
}

}  // namespace dinal::analysis
