// A fixed point of the period map, or of its opposite: Newton's method with damped steps, and waiting where it is lost.
#pragma once

#include <algorithm>
#include <optional>

#include "analysis/period_map.hpp"

namespace dinal::analysis {

/// x -> sign P(x)
class FixedPointSearch {
public:
    FixedPointSearch(const PeriodMap& map, double sign, int& maps) : map_(map), sign_(sign), maps_(maps) {}

    struct Try {
        Place x = Place::Zero(), off = Place::Zero();
        MapStep step;
        double size = 0;
        double rounding = 0;  ///< of a place: a motion may be so small that this is more than its own digits
        [[nodiscard]] double residual() const { return length_of(off); }
        [[nodiscard]] bool at(double tolerance) const {
            return step.finished && residual() <= std::max(tolerance * size, rounding);
        }
    };

    [[nodiscard]] Try at(const Place& x, double size) const;

    /// Newton's method with damped steps, and one period of waiting where none of them leads on.
    [[nodiscard]] std::optional<Try> search(const Place& from, int most) const;

    /// From a place that should be the fixed point but for rounding; none when it is not.
    [[nodiscard]] std::optional<Try> confirmed(const Place& from) const;

private:
    /// The shortest step to where the linearised map stands still: where I - D has a null space, none is made in it.
    [[nodiscard]] Place step(const Try& now) const;
    [[nodiscard]] std::optional<Try> newton(const Try& now) const;
    [[nodiscard]] Try polished(Try now) const;

    const PeriodMap& map_;
    double sign_;
    int& maps_;
};

}  // namespace dinal::analysis
