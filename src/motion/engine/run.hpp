// Runs a system: stretch after stretch of its motion, each up to the first event in it.
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

/// Where a run may be taken up again.
struct Carry {
    std::vector<double> y;
    std::vector<double> low;  ///< what the angles have rounded off; may be left out
    Mode mode;
    std::vector<std::vector<Signal::Memory>> controllers;  ///< of the loads of each body
    std::vector<Watch> watches;                            ///< of the events of the user; may be left out
    std::vector<std::pair<double, int>> echoes;            ///< breaks that delays bring back
    std::vector<model::Motion> heading;                    ///< of bodies without dry friction; may be left out
    std::shared_ptr<const History> past;
    double born = 0;   ///< when the first of these runs began
    Floor floor = {};  ///< may be left out
};

struct Run {
    /// The columns that column_names_of(system, drive) names; of a run that is joined elsewhere without accelerations.
    Growing<double> table;
    std::vector<model::Event> events;
    model::Outcome outcome = model::Outcome::reached_end;
    double t_start = 0, t_stop = 0;
    std::vector<double> initial = {};  ///< all angles, velocities and states at the start
    double gap = 0;                    ///< the longest between two looks at a user's function
    double unproven = 0;  ///< the longest stretch in which functions that are read may do more than was seen
    model::Motion motion_at_stop = model::Motion::stuck;  ///< of the first body
    Mode begun = {};                                      ///< how the contacts stood at the start
    bool located = false;                                 ///< conditions of the motion, all that there were
    std::size_t jumps = 0;                                ///< at these conditions
    double noise = 0;                                     ///< of the load that is roughest, torque
    std::optional<Rough> rough = {};                      ///< of Outcome::unresolved, where it is known
    std::shared_ptr<const History> history;
    std::shared_ptr<const Carry> carry;
    std::optional<model::Contradiction> contradiction = {};  ///< of Outcome::not_a_function
};
inline constexpr std::size_t columns_of_body = 6, columns_of_link = 4;
/// t; theta, velocity, M, friction, damping and acceleration of each body, theta, velocity, torque and friction of each
/// link, as in "load.theta"; torque of each body that is moved; states.
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
    double longest = model::never;  ///< stretch, time units
    double step = 0;                ///< of the classical Runge-Kutta method; 0: collocation
    const Pair* pair = nullptr;     ///< a step of this one instead of collocation
    bool keeps_torques = false;     ///< beside a dense motion, for its energy
    std::size_t history_bytes = limits.memory / 4;
    std::size_t hidden = 0;         ///< rigid joints behind those of the system, which move bodies
    bool joined_elsewhere = false;  ///< who asked joins runs that go on, and says what is at rest for good
};

/// The run, whose functions somebody has heard already.
Run run_plain(const Request& problem);

/// The run, all functions of which are asked again now and then what they were asked before.
Run run(const Request& problem);

}  // namespace dinal::motion::engine
