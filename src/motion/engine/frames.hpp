// The cache of frames of a run: one for each set of sticking joints.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "motion/engine/mechanics.hpp"

namespace dinal::motion::engine {

/// A frame depends on the mode only, not on time or motion.
class Frames {
public:
    /// `longest` limits stretches; `otherwise` replaces it for systems without springs.
    Frames(const Mechanics& mechanics, double longest, double otherwise)
        : mechanics_(mechanics), longest_(longest), otherwise_(otherwise) {}

    /// Returns the frame of a mode. The reference stays valid until some hundred other frames have been made.
    [[nodiscard]] const Frame& of(const Mode& mode);

private:
    std::uint64_t short_key(const Mode& mode) const;

    using Key = std::pair<std::vector<char>, std::vector<int>>;  ///< sticking joints, and walls at which joints lean

    const Mechanics& mechanics_;
    double longest_, otherwise_;
    std::map<Key, Frame> frames_, older_;
    Key last_key_;
    /// The last two frames with their compact keys; two modes alternate at the stops of a body.
    struct Recent {
        std::uint64_t key = 0;
        const Frame* frame = nullptr;
    };
    std::array<Recent, 2> recent_{};
};

/// The longest stretch of a linear system as a fraction of its shortest period.
inline constexpr double longest_in_periods = 0.6;

}  // namespace dinal::motion::engine
