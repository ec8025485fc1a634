// What the program of a formula gives for many numbers at once: for all real ones of an interval, or for all complex
// ones of a disc. Where a function is analytic and bounded on a disc about a stretch, its values at Chebyshev nodes
// tell all of it, to an error that falls as a power of the radius.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "model/formula.hpp"

namespace dinal::model::bounds {

/// What a program computes from doubles between lo and hi lies between its bounds: rounding keeps the order.
struct Interval {
    double lo = 0, hi = 0;

    [[nodiscard]] bool is_one() const { return std::bit_cast<std::uint64_t>(lo) == std::bit_cast<std::uint64_t>(hi); }
    /// No number, too.
    [[nodiscard]] bool is_anything() const { return lo == -never && hi == never; }
};
inline constexpr Interval anything{-never, never};

/// The results of an operation, whole numbers as floats. A condition has none.
Interval image(Op op, const Interval& a, const Interval& b);
/// The values of an excitation of native terms at these times.
Interval image(const Excitation& excitation, const Interval& times);

/// decision_of() this condition where it is the same for all; none where it is not, or where that is not known.
std::optional<double> decision_over(Op op, const Interval& a, const Interval& b);

/// All complex numbers that are no farther than r from a real one.
struct Disc {
    double c = 0, r = 0;
};

inline constexpr double roundings_of_a_step = 16;

/// A few roundings more than r, and those of the centre c.
inline double outward(double r, double c) {
    constexpr double few = roundings_of_a_step * std::numeric_limits<double>::epsilon();
    const double more = r * (1 + few) + few * std::fabs(c) + std::numeric_limits<double>::min();
    if (std::isnan(more)) return never;
    return more;
}

/// The results of an operation that gives c for the centres; not finite where it may not be analytic.
Disc image(Op op, const Disc& a, const Disc& b, double c);
/// The radius of the values of an excitation at these times, continued from the piece at their centre.
double radius(const Excitation& excitation, const Disc& times);

/// Runs a program on discs. Its conditions are decided by intervals of the real numbers, or by a piece that the
/// function is held to. What hardly changes on the stretch while its disc is huge, as the foot of a narrow pulse, is
/// taken for a constant, and the rest of it stands apart.
class Walk {
public:
    /// Without `ranges` what is not held is decided as it is for the centres.
    void begin(const Formula& formula, const terms::Piece* piece, bool ranges);
    /// A register of what the function is given: the numbers near a stretch, and the real ones on it.
    void set(std::size_t place, const Disc& disc, const Interval& range) { slots_[place] = {disc, range, 0, false}; }
    void set(std::size_t place, double value) { slots_[place] = number(value); }

    struct Result {
        Disc disc;     ///< the centre is no number where some condition is not decided
        double apart;  ///< on the stretch it is farther off what the disc holds by this at most
        Interval range;
    };
    /// What was set is gone then. With a `condition`, a step that is held: of the difference that it compares, or of
    /// what it folds, in its periods.
    Result run(std::optional<std::size_t> condition = {});
    /// The greatest radius, as a part of the centre, of what decided conditions that are held.
    [[nodiscard]] double loosest() const { return loosest_; }

private:
    struct Slot {
        Disc disc;
        Interval range;
        double apart = 0;
        bool constant = true;  ///< the bits of the centre, which may be those of a whole number
    };
    [[nodiscard]] static Slot number(double bits) { return {{bits, 0}, {bits, bits}}; }
    [[nodiscard]] Slot combined(Op op, const Slot& a, const Slot& b) const;
    [[nodiscard]] Slot on_piece(Op op, const Slot& a, const Slot& b, double decision) const;

    const Formula* formula_ = nullptr;
    const double* held_ = nullptr;
    bool ranges_ = false;
    double loosest_ = 0;
    std::vector<Slot> slots_{};
};

}  // namespace dinal::model::bounds
