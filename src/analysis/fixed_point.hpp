// Finds a fixed point of the period map, or of its opposite: damped Newton steps, with waiting if they fail.
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
        double rounding = 0;  ///< rounding of a place; may exceed a tiny motion's own digits
        [[nodiscard]] double residual() const { return length_of(off); }
        [[nodiscard]] bool at(double tolerance) const {
            return step.finished && residual() <= std::max(tolerance * size, rounding);
        }
    };

    [[nodiscard]] Try at(const Place& x, double size) const;

    /// Newton's method with damped steps; runs one period if no step helps.
    [[nodiscard]] std::optional<Try> search(const Place& from, int most) const;

    /// Confirms a place that should be the fixed point to rounding; none if it is not.
    [[nodiscard]] std::optional<Try> confirmed(const Place& from) const;

private:
    /// The shortest Newton step; it has no component in the null space of I - D.
    [[nodiscard]] Place step(const Try& now) const;
    [[nodiscard]] std::optional<Try> newton(const Try& now) const;
    [[nodiscard]] Try polished(Try now) const;

    const PeriodMap& map_;
    double sign_;
    int& maps_;
};

}  // namespace dinal::analysis
