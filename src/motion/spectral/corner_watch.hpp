// Where the speed of a motion comes to a corner of its law of friction, and which formula holds from there on.
#pragma once

#include <cmath>
#include <optional>

#include "model/slide.hpp"
#include "motion/spectral/first_below.hpp"

namespace dinal::motion::spectral {

class CornerWatch {
public:
    explicit CornerWatch(model::Slide& slide) : slide_(slide) {}

    struct Corner {
        double x;
        bool upwards;
        double speed;
    };
    /// A series with its derivative, what may be rounding in them, and what turns a speed into its unit.
    template <std::size_t n>
    struct Slip {
        double sign;  ///< of the motion
        const chebyshev::Series<n>& velocity;
        const chebyshev::Series<n - 1>& slope;
        double unit, rounding, slope_rounding;
    };

    /// Before a piece that moves with this speed.
    void enter(double speed) {
        if (!slide_.has_corners() || (speed != 0 && (slide_.inside() || turned_back_))) return;
        slide_.enter(std::max(speed, 0.0));
        edge_ = speed > 0 && speed == slide_.range().from ? Edge::lower : Edge::none;
        turned_back_ = false;
    }
    /// There are corners to look for.
    [[nodiscard]] bool looks() const { return slide_.inside(); }
    /// The first corner before `until` on a piece.
    template <std::size_t n>
    [[nodiscard]] std::optional<Corner> first(const Slip<n>& slip, double until) const {
        if (!slide_.inside()) return {};
        std::optional<Corner> found;
        for (const bool upwards : {false, true}) {
            const double speed = upwards ? slide_.range().to : slide_.range().from;
            if (const auto x = passed(slip, upwards, speed); x && *x < until) {
                found = {*x, upwards, speed};
                until = *x;
            }
        }
        return found;
    }
    /// Another formula holds beyond this corner. Whether time passes until then: not if the motion just came over it,
    /// and does not go on.
    bool cross(const Corner& corner) {
        const bool at_once = edge_ == (corner.upwards ? Edge::upper : Edge::lower) && corner.x <= -1;
        if (at_once && turned_back_) {
            // Neither formula takes it away from there: within rounding it keeps this speed, and for one piece the law
            // is asked as it is.
            slide_.leave();
            return false;
        }
        slide_.cross(corner.upwards);
        edge_ = corner.upwards ? Edge::lower : Edge::upper;
        turned_back_ = at_once;
        return !at_once;
    }
    /// A piece has come to its end, at no corner.
    void passed_on() {
        edge_ = Edge::none;
        turned_back_ = false;
    }
    /// The velocity is zero, or jumps.
    void stop() {
        passed_on();
        slide_.leave();
    }

private:
    enum class Edge { none, lower, upper };

    template <std::size_t n>
    [[nodiscard]] std::optional<double> passed(const Slip<n>& slip, bool upwards, double speed) const {
        const double corner = speed * slip.unit, whole = chebyshev::size(slip.velocity);
        const double varying = whole - std::fabs(slip.velocity[0]);
        constexpr double clearly = 1 + 1e-9;
        if (upwards ? whole * clearly < corner : corner == 0) return {};
        if (!upwards && slip.sign * slip.velocity[0] - varying * clearly > corner * clearly) return {};
        auto inside = slip.velocity;
        inside[0] -= slip.sign * corner;
        chebyshev::Bounded<n> curve(upwards ? -slip.sign : slip.sign, inside, slip.slope);
        constexpr double few = 16 * std::numeric_limits<double>::epsilon();
        curve.raise_floor(std::max(few * whole, slip.rounding));
        curve.raise_slope_floor(slip.slope_rounding);
        const auto no = [](double) { return false; };  // on both sides of a corner friction is the same
        const bool there = edge_ == (upwards ? Edge::upper : Edge::lower);
        return chebyshev::first_below(curve, -1, there ? chebyshev::LeftEnd::leaving : chebyshev::LeftEnd::anywhere,
                                      no);
    }

    model::Slide& slide_;
    Edge edge_ = Edge::none;    // of the range, where the speed is exactly
    bool turned_back_ = false;  // from the other side of that edge
};

}  // namespace dinal::motion::spectral
