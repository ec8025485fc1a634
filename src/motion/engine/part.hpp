// A run as seen from one of its joints: a body against the ground, or a link.
#pragma once

#include <optional>

#include "motion/engine/run.hpp"

namespace dinal::motion::engine {

/// Adds to a run of the loop the names of its columns and events, and what its first joint sees. `seen` is that joint
/// as a one-body system, used for its energy; without it the motion between the rows is left out.
void complete(Run& run, const model::System& system, const model::Drive& drive,
              const std::optional<model::Oscillator>& seen);

/// A view of such a run with names: what one joint sees of it, with its columns and events. The user's events and
/// states belong to every joint.
Run part_of(const model::System& system, const model::Drive& drive, const Run& run, std::size_t joint,
            const std::optional<model::Oscillator>& seen);

}  // namespace dinal::motion::engine
