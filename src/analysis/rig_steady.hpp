// The steady motion of several bodies: a fixed point of the map of all angles, velocities and states over a period, or
// from one passage of an angle to the next where nothing depends on the time. docs/theory.md, section 10.
#pragma once

#include <string>
#include <vector>

#include "analysis/returns.hpp"

namespace dinal::analysis {

/// What drives a run, and what a user calls it.
struct Acting {
    const char* name;
    const model::Excitation* what;
};
std::vector<Acting> acting_in(const RigQuestion& question);

/// When all that drives the run repeats itself: period 0 where nothing depends on the time; none where no period is
/// known. What is a function is looked at at some times: only its user knows its period.
std::optional<Drive> drive_of(const RigQuestion& question);
/// Asks all of it at times all over the period and one period later: the sentence that names the worst two that differ.
std::optional<text::Error> not_periodic(const RigQuestion& question, const Drive& drive);
/// Of controllers that sample or wait: after which time they and all that drives the bodies repeat; none where that is
/// not known, or too long.
std::optional<double> common_period(const RigQuestion& question);
/// One body as the smallest assembly.
RigQuestion as_assembly(const SteadyQuestion& question);

/// Where the motion from the start of the question leads.
SteadyMotion steady_motion(const RigQuestion& question, const motion::Monitor& monitor = {});

/// Motions from other starts that are not this one, each once; none where no motion was found.
std::vector<Other<RigQuestion>> other_motions(const RigQuestion& question, const SteadyMotion& known,
                                              const motion::Monitor& monitor = {});

/// The answer in sentences.
std::string told(const RigQuestion& question, const SteadyMotion& motion, std::size_t others);

}  // namespace dinal::analysis
