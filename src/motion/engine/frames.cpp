#include "motion/engine/frames.hpp"

#include <algorithm>
#include <numbers>

namespace dinal::motion::engine {

/// A compact key of the mode; 0 if there are too many joints for it.
std::uint64_t Frames::short_key(const Mode& mode) const {
    constexpr std::size_t bits = 3, most = 64 / bits;
    const std::size_t joints = mechanics_.joints();
    std::uint64_t key = 1;
    for (std::size_t j = 0; j < joints && joints <= most; ++j) {
        key = key << bits | static_cast<std::uint64_t>(mode.leans[j] + 1) << 1U | (mode.holds(j) ? 1U : 0U);
    }
    return joints <= most ? key : 0;
}

const Frame& Frames::of(const Mode& mode) {
    const std::uint64_t key = short_key(mode);
    for (const Recent& recent : recent_) {
        if (recent.frame != nullptr && key != 0 && recent.key == key) return *recent.frame;
    }
    const std::size_t joints = mechanics_.joints();
    last_key_.first.resize(joints);
    for (std::size_t j = 0; j < joints; ++j) last_key_.first[j] = mode.holds(j) ? 1 : 0;
    last_key_.second = mode.leans;
    auto found = frames_.find(last_key_);
    if (found == frames_.end()) {
        constexpr std::size_t most_frames = 512;
        if (frames_.size() >= most_frames) older_ = std::exchange(frames_, {}), recent_ = {};
        Frame made(mechanics_.system(), mode);
        const double w = mechanics_.fastest(made);
        made.longest = w > 0 ? std::min(longest_, longest_in_periods * 2 * std::numbers::pi / w) : otherwise_;
        found = frames_.emplace(last_key_, std::move(made)).first;
    }
    recent_ = {Recent{key, &found->second}, recent_[0]};
    return found->second;
}

}  // namespace dinal::motion::engine
