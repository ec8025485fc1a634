// Divides a run at its events into half cycles (motion in one direction) and sticks. Impacts reverse the mass, too, and
// an opening contact ends a stick.
#pragma once

#include <optional>
#include <vector>

#include "motion/run.hpp"

namespace dinal::analysis {

/// A half cycle or a stick.
struct Stretch {
    double from = 0, to = 0;
    model::State begin = {}, end = {};  ///< the velocity is 0 at events other than impacts
    bool stuck = false;
    std::optional<model::Event> begun_by = {}, ended_by = {};  ///< none at the ends of the run

    double lasts() const { return to - from; }
};

/// In order and without gaps from t_start to t_stop; a stretch may have zero length. Requires a computed run.
std::vector<Stretch> stretches(const motion::Run& run);

/// The total time during which the contact was open.
double time_open(const motion::Run& run);

/// The half cycles of theta, and its rests; on a belt from one extreme of theta to the next.
std::vector<Stretch> half_cycles(const motion::Run& run);

}  // namespace dinal::analysis
