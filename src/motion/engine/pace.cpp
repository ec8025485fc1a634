#include "motion/engine/pace.hpp"

#include <algorithm>
#include <cmath>

namespace dinal::motion::engine {

void Pace::shorten(double half, double unresolved, double longest_now) {
    // multiple of the tolerance: an error up to this also limits the length of the next stretches
    constexpr double slightly = 16;
    constexpr int limited_stretches = 12;
    const double factor = unresolved < model::never ? 0.9 * std::pow(unresolved, -1.0 / 16) : 0;
    h = half * std::clamp(factor, 0.5, 0.9);
    if (unresolved <= slightly && h > short_part * longest_now) short_enough_ = h, limited_for_ = limited_stretches;
}

void Pace::lengthen(double half, double factor, double longest_now) {
    h = std::min(longest_now / 2, std::max(h, half * factor));
    if (h >= whole_) whole_ = 0;
    if (limited_for_ > 0 && --limited_for_ > 0) h = std::min(h, short_enough_);
}

}  // namespace dinal::motion::engine
