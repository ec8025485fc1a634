// The rules of one contact at slip 0: what it does next, and which event that is. They are functions of its pull, its
// limits and what it did before, and remember nothing. The general loop asks them for each joint (engine/decide.hpp),
// exact and rk4 for their only one (lone_contact.hpp).
#pragma once

#include <optional>
#include <vector>

#include "model/event.hpp"
#include "model/sticking.hpp"

namespace dinal::motion::contact {

using model::Motion;
using model::Pull;

/// The pull on a contact that creeps this way, against its balance with sliding friction. It leaves the creep if it is
/// more than `apart` away from the balance.
inline Pull pull_on_creep(double pull, Motion way, double sliding, double apart) {
    const double off = pull - model::sign_of(way) * sliding;
    return {std::fabs(off) - apart, off > 0 ? Motion::forward : Motion::backward};
}

/// The limit of a creep towards this side.
inline double limit_of_creep(Motion side, Motion way, double sliding, double apart) {
    return side == way ? apart + sliding : apart - sliding;
}

/// A slip this way has come down to rounding. It may go on, slower than rounding: sliding friction alone balances the
/// pull, and sticking would hold more. Returns by how much the pull may differ from the balance then. `torques` is the
/// size of all that act.
std::optional<double> creeps_within(double pull, Motion way, double sliding, double holding, double torques);

/// A mass that stops beyond its limit by no more than the rounding of its way, whose torques were of this size, is at
/// the limit. Returns the angle there, or theta itself.
double place_at_limit(const Pull& pull, double limit, double k, double M, double theta, double torques);

/// The doings of a contact until it was asked.
struct Before {
    Motion slid = Motion::stuck;    ///< the way in which it came to slip 0
    bool held = false;              ///< it stuck
    Motion creeps = Motion::stuck;  ///< the way in which it crept
};

/// The event of a contact that moves this way from now on, if that is one.
std::optional<model::EventKind> event_of(const Before& before, Motion way);

struct Verdict {
    Motion way;  ///< stuck: it holds, or creeps on
    std::optional<model::EventKind> told = {};
    bool creeps = false;
};
/// The decision about one contact. A creep that is pulled back ends in a stick.
Verdict decide(const Before& before, const Pull& pull);

/// A slip that ends a stick.
struct Released {
    model::Event slip;
    bool turns;      ///< it slides the other way than before it stuck
    double off;      ///< the change of its pull since then; infinite if it did not slide before
    double torques;  ///< the size of all that act
};
/// Returns whether the stick was none: the contact came to slip 0 right at its limit, and friction withheld an impulse
/// below rounding while the pull passed it. Rounding says which side of the limit it was on. Then it is no longer an
/// event, or is a turn. `unit` is a period of the motion.
bool only_touched(std::vector<model::Event>& events, const Released& released, double unit);

}  // namespace dinal::motion::contact
