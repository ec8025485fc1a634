// Runs the program of a formula on sets: real intervals or complex discs. A function that is analytic and bounded on a
// disc around a stretch is determined by its values at Chebyshev nodes, with an error that falls as a power of the
// radius.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "model/formula.hpp"

namespace dinal::model::bounds {

/// Encloses all results of a program for doubles between lo and hi; rounding keeps the order.
struct Interval {
    double lo = 0, hi = 0;

    bool is_one() const { return std::bit_cast<std::uint64_t>(lo) == std::bit_cast<std::uint64_t>(hi); }
    /// Returns whether nothing is known; the result may also be NaN.
    bool is_anything() const { return lo == -never && hi == never; }
};
inline constexpr Interval anything{-never, never};

/// Encloses the results of an operation, whole numbers as floats. Not for conditions.
Interval image(Op op, const Interval& a, const Interval& b);
/// The values of an excitation of native terms at these times.
Interval image(const Excitation& excitation, const Interval& times);

/// Returns decision_of() the condition if it is the same for all arguments; none if it differs or is unknown.
std::optional<double> decision_over(Op op, const Interval& a, const Interval& b);

/// The complex numbers within the distance r of the real number c.
struct Disc {
    double c = 0, r = 0;
};

inline constexpr double roundings_of_a_step = 16;

/// Enlarges r by its own rounding and that of the centre c.
inline double outward(double r, double c) {
    constexpr double few = roundings_of_a_step * std::numeric_limits<double>::epsilon();
    const double more = r * (1 + few) + few * std::fabs(c) + std::numeric_limits<double>::min();
    if (std::isnan(more)) return never;
    return more;
}

/// Encloses the results of an operation whose result at the centres is c; not finite if the operation may not be
/// analytic there.
Disc image(Op op, const Disc& a, const Disc& b, double c);
/// The radius of the values of an excitation at these times, continued from the piece at their centre.
double radius(const Excitation& excitation, const Disc& times);

/// Runs a program on discs. Conditions are decided by real intervals, or by a piece that fixes them. A value that
/// hardly changes on the stretch although its disc is huge, such as the foot of a narrow pulse, is replaced by a
/// constant with the deviation `apart`.
class Walk {
public:
    /// Without `ranges`, conditions that no piece fixes are decided at the centres.
    void begin(const Formula& formula, const terms::Piece* piece, bool ranges);
    /// Sets an argument of the function: its complex neighbourhood and its real values on the stretch.
    void set(std::size_t place, const Disc& disc, const Interval& range) { slots_[place] = {disc, range, 0, false}; }
    void set(std::size_t place, double value) { slots_[place] = number(value); }

    struct Result {
        Disc disc;     ///< NaN centre: some condition is undecided
        double apart;  ///< bound of the deviation from the disc on the stretch
        Interval range;
    };
    /// Runs once; the arguments are overwritten. With `condition`, a step whose decision is held, returns the compared
    /// difference, or the folded argument in periods.
    Result run(std::optional<std::size_t> condition = {});
    /// The greatest ratio of radius to centre among the operands that determine held decisions.
    double greatest_relative_radius() const { return greatest_relative_radius_; }

private:
    struct Slot {
        Disc disc;
        Interval range;
        double apart = 0;
        bool constant = true;  ///< whether only the bits of the centre count, which may be a whole number
    };
    [[nodiscard]] static Slot number(double bits) { return {{bits, 0}, {bits, bits}}; }
    Slot combined(Op op, const Slot& a, const Slot& b) const;
    Slot on_piece(Op op, const Slot& a, const Slot& b, double decision) const;

    const Formula* formula_ = nullptr;
    const double* held_ = nullptr;
    bool ranges_ = false;
    double greatest_relative_radius_ = 0;
    std::vector<Slot> slots_{};
};

}  // namespace dinal::model::bounds
