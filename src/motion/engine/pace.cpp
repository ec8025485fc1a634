#include "motion/engine/pace.hpp"

#include <algorithm>
#include <cmath>

namespace dinal::motion::engine {

void Pace::shorten(double half, double unresolved, double longest_now) {
    constexpr double slightly = 16;  // times the tolerance: such an error limits the length of the next stretches
    constexpr int limited_stretches = 12;
    const double factor = unresolved < model::never ? 0.9 * std::pow(unresolved, -1.0 / 16) : 0;
    h = half * std::clamp(factor, 0.5, 0.9);
    if (unresolved <= slightly && h > short_part * longest_now) short_enough_ = h, limited_for_ = limited_stretches;
}

void Pace::lengthen(double half, double factor, double longest_now) {
    h = std::min(longest_now / 2, std::max(h, half * factor));
    if (limited_for_ > 0 && --limited_for_ > 0) h = std::min(h, short_enough_);
}

bool Chatter::too_often(double t, int most) {
    constexpr double at_once = 1e-9;  // events that follow each other within it, so often, go on for ever
    at_once_in_a_row_ = t - last_event_ <= at_once * unit_ ? at_once_in_a_row_ + 1 : 0;
    last_event_ = t;
    return at_once_in_a_row_ > most;
}

bool Chatter::too_many_attempts(double t, int most) {
    if (++attempts_ < most) return false;
    if (t - attempts_since_ < 1e-7 * most * unit_) return true;
    attempts_ = 0, attempts_since_ = t;
    return false;
}

}  // namespace dinal::motion::engine
