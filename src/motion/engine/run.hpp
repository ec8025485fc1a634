// Runs a system stretch by stretch, each up to its first event.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/contradiction.hpp"
#include "model/event.hpp"
#include "model/outcome.hpp"
#include "motion/engine/crossing.hpp"
#include "motion/engine/history.hpp"
#include "motion/engine/mechanics.hpp"
#include "motion/growing.hpp"
#include "motion/simulate.hpp"

namespace dinal::motion::engine {

/// The state needed to resume a run.
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

struct Run {
    /// The columns named by column_names_of(system, drive); without accelerations if `joined_elsewhere`.
    Growing<double> table;
    std::vector<model::Event> events;
    model::Outcome outcome = model::Outcome::reached_end;
    double t_start = 0, t_stop = 0;
    std::vector<double> initial = {};  ///< all angles, velocities and states at the start
    double gap = 0;                    ///< longest distance between two samples of a user's function, time units
    double unproven = 0;               ///< the longest stretch in which formulas may do more than was sampled
    model::Motion motion_at_stop = model::Motion::stuck;  ///< motion of the first body
    Mode begun = {};                                      ///< mode of the contacts at the start
    bool located = false;                                 ///< whether all conditions on the motion were located
    std::size_t jumps = 0;                                ///< number of jumps at these conditions
    double noise = 0;                                     ///< noise of the noisiest load, torque
    std::optional<Rough> rough = {};                      ///< cause of Outcome::unresolved, if known
    std::shared_ptr<const History> history;
    std::shared_ptr<const Carry> carry;
    std::optional<model::Contradiction> contradiction = {};  ///< cause of Outcome::not_a_function
};
inline constexpr std::size_t columns_of_body = 6, columns_of_link = 4;
/// t; theta, velocity, M, friction, damping and acceleration of each body; theta, velocity, torque and friction of each
/// link, as in "load.theta"; the torque on each body with prescribed motion; states.
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
    std::size_t hidden = 0;         ///< number of rigid joints behind the system's own, which impose prescribed motions
    bool joined_elsewhere = false;  ///< whether the caller joins continued runs and decides about rest

    /// The same of another system and its drive, which must outlast it.
    [[nodiscard]] Request on(const model::System& other, const model::Drive& its) const {
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

/// Runs without checking that functions are functions of their arguments.
Run run_plain(const Request& problem);

/// Runs and repeats some evaluations of user functions to detect memory (see witness.hpp).
Run run(const Request& problem);

}  // namespace dinal::motion::engine
