// A run of several bodies in sentences: what each body and each link did, where the energy went, how it ended.
#pragma once

#include <string>
#include <vector>

#include "analysis/energy.hpp"
#include "motion/engine/run.hpp"
#include "motion/trajectory.hpp"

namespace dinal::analysis {

/// `parts` is the run as seen from each joint, `energies` those of the joints, which may be missing.
std::string explain(const model::Assembly& system, const motion::engine::Drive& drive,
                    const motion::engine::AssemblyRun& run, const std::vector<const motion::Trajectory*>& parts,
                    const std::vector<Energy>& energies);

}  // namespace dinal::analysis
