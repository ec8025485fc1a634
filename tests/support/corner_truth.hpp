// A second opinion on dry friction with corners: Fehlberg 7(8) of Boost in long double, with short steps that end at
// each corner of the law, at each standstill and at each wall, found by halving.
//
// Nothing of src is used. Times, angles and torques are about 1.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/closed_form.hpp"

namespace dinal::truth {

/// A law between two of its corners, smooth beyond both. `steep` bounds its slope, `narrow` is by how much the speed
/// may change in a step.
struct CornerRange {
    real from, to;
    std::function<real(real speed)> torque;
    real steep = 0, narrow = 1;
};

/// Straight lines between torques at speeds; the last torque holds for all greater speeds.
std::vector<CornerRange> lines_through(const std::vector<double>& speed, const std::vector<double>& torque);

struct CornerSystem {
    real I = 1, C = 0, k = 1, Re = 0;
    std::vector<CornerRange> law;
    std::function<real(real t)> M;
    real belt = 0;                           ///< its velocity
    real wall = HUGE_VALL, restitution = 1;  ///< above
    real quickest = 1;                       ///< rad per time unit of what is in M
};

class CornerTruth {
public:
    struct Happening {
        real t;
        std::string kind;
        real theta;
    };

    CornerTruth(CornerSystem system, const Motion& start, real t_end, const std::vector<double>& times);

    std::vector<Happening> events;
    std::vector<Motion> motions;
    std::size_t corners_passed = 0;

private:
    using Point = std::array<real, 2>;

    [[nodiscard]] real slip() const { return y_[1]; }
    void enter();
    [[nodiscard]] real acceleration(real t, const Point& y) const;
    [[nodiscard]] Point stepped(const Point& from, real h) const;
    /// What must stay positive: above the lower corner (or standstill), below the upper one, below the wall.
    [[nodiscard]] std::array<real, 3> inside(const Point& y) const;
    void move(real t_end);
    [[nodiscard]] real pull(real t, real theta) const { return s_.M(t) - s_.C * s_.belt - s_.k * theta; }
    void arrive(bool told);
    void wait(real t_end);
    void tell(const char* kind) { events.push_back({t_, kind, y_[0]}); }
    void tell_rows(const Point& from, real begin, real end, bool all);

    CornerSystem s_;
    Point y_;  // theta, and the velocity against the belt
    std::vector<double> times_;
    std::size_t next_ = 0, range_ = 0;
    real t_ = 0;
    int sign_ = 0;
};

}  // namespace dinal::truth
