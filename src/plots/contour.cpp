// Lines of equal value on a grid, by marching squares; where four crossings meet, the mean of the corners decides.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "plots/shades.hpp"

namespace dinal::plots {
namespace {

/// The side of a square of the grid: from the point (i, j) to the right, or up.
struct GridSide {
    std::size_t i, j;
    bool up;
    auto operator<=>(const GridSide&) const = default;
};

class ContourTracer {
public:
    ContourTracer(const Shades& shades, double level) : shades_(shades), level_(level) {}

    Curve curve() {
        for (std::size_t j = 0; j + 1 < shades_.y.size(); ++j) {
            for (std::size_t i = 0; i + 1 < shades_.x.size(); ++i) add_square(i, j);
        }
        // Open lines first, from an end of theirs; what is left are rings.
        for (const bool ends_only : {true, false}) {
            for (auto& [side, neighbours] : neighbours_) {
                if (!ends_only || neighbours.size() == 1) follow(side);
            }
        }
        Curve curve;
        curve.x = Numbers::own(std::move(x_));
        curve.y = Numbers::own(std::move(y_));
        return curve;
    }

private:
    [[nodiscard]] bool above(std::size_t i, std::size_t j) const { return shades_.at(i, j) >= level_; }

    void join(const GridSide& a, const GridSide& b) {
        neighbours_[a].push_back(b);
        neighbours_[b].push_back(a);
    }

    void add_square(std::size_t i, std::size_t j) {
        const std::array<double, 4> z{shades_.at(i, j), shades_.at(i + 1, j), shades_.at(i + 1, j + 1),
                                      shades_.at(i, j + 1)};
        if (!std::all_of(z.begin(), z.end(), [](double value) { return std::isfinite(value); })) return;
        // Below, right, above, left: side n lies between the corners n and n + 1.
        const std::array<GridSide, 4> sides{GridSide{i, j, false}, GridSide{i + 1, j, true}, GridSide{i, j + 1, false},
                                            GridSide{i, j, true}};
        std::vector<std::size_t> crossed;
        for (std::size_t n = 0; n < 4; ++n) {
            if ((z[n] >= level_) != (z[(n + 1) % 4] >= level_)) crossed.push_back(n);
        }
        if (crossed.size() == 2) join(sides[crossed[0]], sides[crossed[1]]);
        if (crossed.size() == 4) {
            const bool middle = (z[0] + z[1] + z[2] + z[3]) / 4 >= level_;
            const bool cuts_first = middle != above(i, j);  // the corner 0 is alone, and so is 2
            join(sides[0], sides[cuts_first ? 3 : 1]);
            join(sides[2], sides[cuts_first ? 1 : 3]);
        }
    }

    void add_point(const GridSide& side) {
        const std::size_t i = side.up ? side.i : side.i + 1, j = side.up ? side.j + 1 : side.j;
        const double from = shades_.at(side.i, side.j), to = shades_.at(i, j);
        const double part = (level_ - from) / (to - from);
        x_.push_back(shades_.x[side.i] + part * (shades_.x[i] - shades_.x[side.i]));
        y_.push_back(shades_.y[side.j] + part * (shades_.y[j] - shades_.y[side.j]));
    }

    /// Takes the line that goes on from this side.
    void follow(GridSide side) {
        if (neighbours_[side].empty()) return;
        add_point(side);
        while (!neighbours_[side].empty()) {
            const GridSide next = neighbours_[side].back();
            neighbours_[side].pop_back();
            std::vector<GridSide>& back = neighbours_[next];
            back.erase(std::find(back.begin(), back.end(), side));
            add_point(next);
            side = next;
        }
        x_.push_back(std::numeric_limits<double>::quiet_NaN());
        y_.push_back(std::numeric_limits<double>::quiet_NaN());
    }

    const Shades& shades_;
    double level_;
    std::map<GridSide, std::vector<GridSide>> neighbours_;
    std::vector<double> x_, y_;
};

}  // namespace

Curve contour(const Shades& shades, double level) {
    return ContourTracer(shades, level).curve();
}

}  // namespace dinal::plots
