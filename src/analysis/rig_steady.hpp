// The steady motion of several bodies: a fixed point of the map of all angles, velocities and states over a period, or
// from one passage of an angle to the next where nothing depends on the time. docs/theory.md, section 10.
#pragma once

#include <string>
#include <vector>

#include "analysis/returns.hpp"

namespace dinal::analysis {

struct RigMotion {
    /// What is known of all bodies together: status, period, periods, multipliers, stable, unique, growth, residual.
    SteadyMotion facts;
    motion::engine::Drive drive = {};      ///< whose run it is
    motion::engine::AssemblyRun run = {};  ///< one period; at rest empty
    std::vector<double> low, high;         ///< of the angle of each body, from another one where they go round
    std::vector<double> turned;            ///< of each body: how far it goes round in a period, or 0
    std::vector<double> rest;              ///< the angle of each body, at rest
};

/// When everything that drives the run repeats itself; none where no period is known.
std::optional<Drive> drive_of(const RigQuestion& question);
/// Of controllers that sample or wait: after which time they and all that drives the bodies repeat; none where that is
/// not known, or too long.
std::optional<double> common_period(const RigQuestion& question);
/// The sentence about what does not repeat itself after the period.
std::optional<text::Error> not_periodic(const RigQuestion& question, const Drive& drive);

/// Where the motion from the start of the question leads.
RigMotion steady_motion(const RigQuestion& question, const motion::Monitor& monitor = {});

/// Motions from other starts that are not this one, each once; none where no motion was found.
std::vector<RigMotion> other_motions(const RigQuestion& question, const RigMotion& known,
                                     const motion::Monitor& monitor = {});

/// The answer in sentences.
std::string told(const RigQuestion& question, const RigMotion& motion, std::size_t others);

}  // namespace dinal::analysis
