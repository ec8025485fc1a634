// Describes a run in sentences: events with time, place and reason, and the kind of motion.
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
#include "motion/run.hpp"

namespace dinal::analysis {

struct RunToDescribe {
    const model::System& system;
    const model::Drive& drive;
    std::vector<const motion::Run*> parts;  ///< the run seen from each body and link
    motion::MethodView method;
    std::optional<std::size_t> joint = {};  ///< limits the text to this joint
};

/// Describes the whole run. `energies` of the joints may be missing.
std::string explain(const RunToDescribe& run, const std::vector<Energy>& energies = {});

/// Describes one body, in paragraphs that fit 80 columns. In a long run only the first and last stops are listed. Calls
/// no user function except those of spring, belt and base.
std::string explain(const motion::Run& run, const model::Oscillator& system, const model::Drive& drive,
                    motion::MethodView method);

/// Describes the rows of a run read from a file.
std::string explain_rows(const motion::Run& run, const model::Units& units = {});

}  // namespace dinal::analysis
