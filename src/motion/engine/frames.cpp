#include "motion/engine/frames.hpp"

#include <algorithm>
#include <numbers>

namespace dinal::motion::engine {

const Frame& Frames::of(const Mode& mode) {
    const std::size_t joints = mechanics_.joints();
    bool same = last_ != nullptr && last_key_.second == mode.leans;
    for (std::size_t j = 0; same && j < joints; ++j) same = mode.holds(j) == (last_key_.first[j] != 0);
    if (same) return *last_;
    last_key_.first.resize(joints);
    for (std::size_t j = 0; j < joints; ++j) last_key_.first[j] = mode.holds(j) ? 1 : 0;
    last_key_.second = mode.leans;
    auto found = frames_.find(last_key_);
    if (found == frames_.end()) {
        constexpr std::size_t most_frames = 512;
        if (frames_.size() >= most_frames) older_ = std::exchange(frames_, {});
        Frame made(mechanics_.system(), mode);
        const double w = mechanics_.fastest(made);
        made.longest = w > 0 ? std::min(longest_, longest_in_periods * 2 * std::numbers::pi / w) : otherwise_;
        found = frames_.emplace(last_key_, std::move(made)).first;
    }
    last_ = &found->second;
    return *last_;
}

}  // namespace dinal::motion::engine
