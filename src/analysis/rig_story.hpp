// A run of several bodies in sentences: what each body and each link did, where the energy went, how it ended.
#pragma once

#include <string>
#include <vector>

#include "motion/engine/run.hpp"
#include "motion/trajectory.hpp"

namespace dinal::analysis {

/// `parts` is the run as seen from each joint; `works` may be missing.
std::string explain(const model::Assembly& system, const motion::engine::Drive& drive,
                    const motion::engine::AssemblyRun& run, const std::vector<const motion::Trajectory*>& parts,
                    const motion::engine::Works* works);

/// What does not add up of the works.
double error_of(const motion::engine::Works& works);

}  // namespace dinal::analysis
