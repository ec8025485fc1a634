// A run as seen from one of its joints: a body against the ground, or a link.
#pragma once

#include <optional>

#include "motion/engine/run.hpp"

namespace dinal::motion::engine {

/// The data that a continuation of the run needs.
struct Left final : Carried {
    explicit Left(std::shared_ptr<const Carry> from, std::size_t bodies = 1) : carry(std::move(from)) {
        states.assign(carry->y.begin() + static_cast<std::ptrdiff_t>(2 * bodies), carry->y.end());
    }
    std::shared_ptr<const Carry> carry;
};

/// The trajectory of a joint without rows. `seen` is the joint as a one-body system, used for its energy; without it
/// the motion between the rows is left out. The user's events and states belong to every joint.
Trajectory part_of(const model::System& system, const model::Drive& drive, const Run& run, std::size_t joint,
                   const std::optional<model::Oscillator>& seen);

/// The same with its columns, for a run of one body.
Trajectory part_with_rows(const model::System& system, const model::Drive& drive, const Run& run, std::size_t joint,
                          const std::optional<model::Oscillator>& seen);

}  // namespace dinal::motion::engine
