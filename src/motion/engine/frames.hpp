// The frames of a run: one for each set of joints that hold, made once.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "motion/engine/mechanics.hpp"

namespace dinal::motion::engine {

/// Knows no time and no motion: a frame follows from the mode alone.
class Frames {
public:
    /// `longest`: the longest stretch that was allowed; `otherwise` that of a system without springs.
    Frames(const Mechanics& mechanics, double longest, double otherwise)
        : mechanics_(mechanics), longest_(longest), otherwise_(otherwise) {}

    /// Returns the frame of a mode. The reference is valid until some hundred other frames were made.
    [[nodiscard]] const Frame& of(const Mode& mode);

private:
    [[nodiscard]] std::uint64_t short_key(const Mode& mode) const;

    using Key = std::pair<std::vector<char>, std::vector<int>>;  ///< the joints that hold, and at which walls

    const Mechanics& mechanics_;
    double longest_, otherwise_;
    std::map<Key, Frame> frames_, older_;
    Key last_key_;
    /// The last two, which alternate at the stops of a body: by a number that tells the modes of a few joints apart.
    struct Recent {
        std::uint64_t key = 0;
        const Frame* frame = nullptr;
    };
    std::array<Recent, 2> recent_{};
};

/// Stretches of a linear system are no longer than this part of its shortest period.
inline constexpr double longest_in_periods = 0.6;

}  // namespace dinal::motion::engine
