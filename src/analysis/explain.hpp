// A run told in sentences: what happened, when, where and why, and what kind of motion it became.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/energy.hpp"
#include "model/drive.hpp"
#include "model/excitation.hpp"
#include "model/oscillator.hpp"
#include "motion/engine/mechanics.hpp"
#include "motion/method.hpp"
#include "motion/trajectory.hpp"

namespace dinal::analysis {

struct RunToTell {
    const model::System& system;
    const model::Drive& drive;
    std::vector<const motion::Trajectory*> parts;  ///< the run as seen from each body and link
    motion::MethodView method;
    std::optional<std::size_t> joint = {};  ///< whose story alone is told
};

/// Each body and link is told by the same sentences. `energies` are those of the joints, and may be missing.
std::string explain(const RunToTell& run, const std::vector<Energy>& energies = {});

/// The story of one body. Paragraphs of lines that fit 80 columns. Of a long run only the first and the last stops are
/// told one by one. No user function is called, but for a spring, a belt and a base.
std::string explain(const motion::Trajectory& trajectory, const model::Oscillator& system, const model::Drive& drive,
                    motion::MethodView method);

/// What rows alone tell, of a trajectory that was read from a file.
std::string explain_rows(const motion::Trajectory& trajectory, const model::Units& units = {});

}  // namespace dinal::analysis
