#include "plots/line.hpp"

#include <algorithm>
#include <array>

namespace dinal::plots {

bool clip(Line& line, Box sheet, double slack) {
    const Point from = line.from;
    const double dx = line.to.x - from.x;
    const double dy = line.to.y - from.y;
    double begin = 0;
    double end = 1;
    const std::array<std::array<double, 2>, 4> sides{{{-dx, from.x + slack},
                                                      {dx, sheet.width + slack - from.x},
                                                      {-dy, from.y + slack},
                                                      {dy, sheet.height + slack - from.y}}};
    for (const auto& [direction, distance] : sides) {
        if (direction == 0) {
            if (distance < 0) {
                return false;
            }
        } else if (direction < 0) {
            begin = std::max(begin, distance / direction);
        } else {
            end = std::min(end, distance / direction);
        }
    }
    if (!(begin <= end)) {
        return false;
    }
    line = {{from.x + begin * dx, from.y + begin * dy}, {from.x + end * dx, from.y + end * dy}};
    return true;
}

}  // namespace dinal::plots
