// A run as seen from one of its joints: a body against the ground, or a link.
#pragma once

#include <optional>

#include "motion/engine/run.hpp"

namespace dinal::motion::engine {

/// Adds the names of columns and events and the view of the first joint to a run. `seen` is this joint as a one-body
/// system, used for its energy; without it the motion between the rows is left out.
void complete(Run& run, const model::System& system, const model::Drive& drive,
              const std::optional<model::Oscillator>& seen);

/// The view of one joint of a run with names: its columns and events. The user's events and states belong to every
/// joint.
Run part_of(const model::System& system, const model::Drive& drive, const Run& run, std::size_t joint,
            const std::optional<model::Oscillator>& seen);

/// Runs a plain system with the general engine. The columns of the user's states follow the others.
Run run(const Problem& problem, const Cut& cut);

}  // namespace dinal::motion::engine
