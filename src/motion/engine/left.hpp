// The data that the general engine keeps at the end of a run.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "motion/engine/crossing.hpp"
#include "motion/engine/history.hpp"
#include "motion/engine/mechanics.hpp"

namespace dinal::motion::engine {

/// The state that a continued run needs.
struct Carry {
    std::vector<double> y;
    std::vector<double> low;  ///< rounding errors of the angles; may be empty
    Mode mode;
    std::vector<std::vector<Signal::Memory>> controllers;  ///< memory of the loads of each body
    std::vector<Watch> watches;                            ///< state of the user's events; may be empty
    std::vector<std::pair<double, int>> echoes;            ///< breaks that delays repeat
    std::vector<model::Motion> heading;                    ///< directions without dry friction; may be empty
    std::shared_ptr<const History> past;
    double born = 0;   ///< start of the first of these runs
    Floor floor = {};  ///< may be empty
};

/// The data for views of single bodies and links, and for continuing the run.
struct Left {
    std::vector<double> start = {};  ///< all angles, velocities and states at the start
    Mode begun = {};                 ///< mode of the contacts at the start
    std::shared_ptr<const History> history = {};
    std::shared_ptr<const Carry> carry = {};

    /// Returns whether the motion between the rows was kept. A run of no duration counts as kept.
    [[nodiscard]] bool is_dense(const Run& run) const {
        return history != nullptr && (history->bytes() > 0 || run.t_stop == run.t_start);
    }
};

}  // namespace dinal::motion::engine
