// A run as seen from one of its joints: a body against the ground, or a link.
#pragma once

#include <optional>

#include "motion/engine/run.hpp"

namespace dinal::motion::engine {

/// What a run leaves to the run that goes on from there.
struct Left final : Carried {
    explicit Left(std::shared_ptr<const Carry> from, std::size_t bodies = 1) : carry(std::move(from)) {
        states.assign(carry->y.begin() + static_cast<std::ptrdiff_t>(2 * bodies), carry->y.end());
    }
    std::shared_ptr<const Carry> carry;
};

/// All of the run that concerns the joint, but no rows. `seen` is the joint as a system of one body, from which its
/// energy is computed; without it the motion between the rows is left out. The events and states of the user belong to
/// each joint.
Trajectory part_of(const model::System& system, const model::Drive& drive, const Run& run, std::size_t joint,
                   const std::optional<model::Oscillator>& seen);

/// The same with its columns of a run that is not joined elsewhere.
Trajectory part_with_rows(const model::System& system, const model::Drive& drive, const Run& run, std::size_t joint,
                          const std::optional<model::Oscillator>& seen);

}  // namespace dinal::motion::engine
