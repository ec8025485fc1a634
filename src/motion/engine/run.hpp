// Runs a system stretch by stretch, each up to its first event.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "motion/engine/history.hpp"
#include "motion/run.hpp"
#include "motion/simulate.hpp"

namespace dinal::motion::engine {

/// The number of columns without t, which comes first.
inline constexpr std::size_t columns_of_body = body_columns.size() - 1, columns_of_link = link_columns.size() - 1;
/// The names of the columns: t; those of each body and link, such as "load.theta"; the torque on each body with
/// prescribed motion; states. Unnamed accelerations of the bodies follow, unless the run is `joined_elsewhere`.
std::vector<std::string> column_names_of(const model::System& system, const model::Drive& drive);

struct Request {
    const model::System& system;
    const model::Drive& drive;
    Window window;
    const Grid& rows;
    const Monitor& monitor;
    const Limits& limits;
    std::shared_ptr<const Carry> before = {};
    double tolerance = 1e-12;
    double longest = model::never;  ///< longest stretch, time units
    double step = 0;                ///< step of the classical Runge-Kutta method; 0 means collocation
    const Pair* pair = nullptr;     ///< embedded Runge-Kutta pair used instead of collocation; null means none
    bool keeps_torques = false;     ///< whether the dense motion includes torques, for its energy
    std::size_t history_bytes = limits.memory / 4;
    std::size_t hidden = 0;         ///< number of rigid joints that impose prescribed motions, after the system's own
    bool joined_elsewhere = false;  ///< whether the caller joins continued runs and decides about rest

    /// The number of joints of the system itself.
    std::size_t own_joints() const { return system.joints.size() - hidden; }
    /// The body whose motion this hidden joint imposes.
    std::size_t moved_body(std::size_t joint) const { return system.joints[joint].first(); }
    /// The same request for another system and its drive, which must outlive it.
    Request on(const model::System& other, const model::Drive& its) const {
        return {.system = other,
                .drive = its,
                .window = window,
                .rows = rows,
                .monitor = monitor,
                .limits = limits,
                .before = before,
                .tolerance = tolerance,
                .longest = longest,
                .step = step,
                .pair = pair,
                .keeps_torques = keeps_torques,
                .history_bytes = history_bytes,
                .hidden = hidden,
                .joined_elsewhere = joined_elsewhere};
    }
};

/// Runs without testing whether user functions depend on their arguments only.
Run run_plain(const Request& problem);

/// Runs and repeats some evaluations of user functions to detect memory (see witness.hpp).
Run run(const Request& problem);

}  // namespace dinal::motion::engine
