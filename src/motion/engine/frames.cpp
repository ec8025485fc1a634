#include "motion/engine/frames.hpp"

#include <algorithm>
#include <numbers>

namespace dinal::motion::engine {

const Frames::Entry& Frames::entry(const Mode& mode) {
    const std::size_t joints = mechanics_.joints();
    bool same = last_ != nullptr && last_key_.second == mode.leans;
    for (std::size_t j = 0; same && j < joints; ++j) same = mode.holds(j) == (last_key_.first[j] != 0);
    if (same) return *last_;
    last_key_.first.resize(joints);
    for (std::size_t j = 0; j < joints; ++j) last_key_.first[j] = mode.holds(j) ? 1 : 0;
    last_key_.second = mode.leans;
    auto found = entries_.find(last_key_);
    if (found == entries_.end()) {
        constexpr std::size_t most_frames = 512;
        if (entries_.size() >= most_frames) older_ = std::exchange(entries_, {});
        Frame made(mechanics_.system(), mode);
        const double w = mechanics_.fastest(made);
        const double longest = w > 0 ? std::min(longest_, longest_in_periods * 2 * std::numbers::pi / w) : otherwise_;
        found = entries_.emplace(last_key_, std::pair(std::move(made), longest)).first;
    }
    last_ = &found->second;
    return *last_;
}

}  // namespace dinal::motion::engine
