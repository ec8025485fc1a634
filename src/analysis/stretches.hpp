// A run cut at its events: stretches of motion one way, half cycles, and stretches of standing still. Impacts turn the
// mass round, too, and a contact that opens lets go what stuck.
#pragma once

#include <optional>
#include <vector>

#include "motion/trajectory.hpp"

namespace dinal::analysis {

struct Stretch {
    double from = 0, to = 0;
    model::State begin = {}, end = {};  ///< at an event the velocity is 0, but for an impact
    bool stuck = false;
    std::optional<model::Event> begun_by = {}, ended_by = {};  ///< none at the ends of the run

    [[nodiscard]] double lasts() const { return to - from; }
};

/// In order and without gaps from t_start to t_stop; a stretch may last no time. Of a computed run only.
std::vector<Stretch> stretches(const motion::Trajectory& trajectory);

/// For how long nothing pressed on the contact.
double time_open(const motion::Trajectory& trajectory);

/// The half cycles of theta, and where it stands: the same but on a belt, where they run from one extreme to the next.
std::vector<Stretch> half_cycles(const motion::Trajectory& trajectory);

}  // namespace dinal::analysis
