// The rules of one contact at slip 0: its next state and the event to record. They are pure functions of its pull,
// its limits and its past. The general engine applies them to each joint (engine/decide.hpp), exact and rk4 to their
// only contact (lone_contact.hpp).
#pragma once

#include <optional>
#include <vector>

#include "model/event.hpp"
#include "model/sticking.hpp"

namespace dinal::motion::contact {

using model::Motion;
using model::Pull;

/// The pull on a contact that creeps this way, relative to the balance with sliding friction. The contact leaves the
/// creep if it is more than `apart` away from the balance.
inline Pull pull_on_creep(double pull, Motion way, double sliding, double apart) {
    const double off = pull - model::sign_of(way) * sliding;
    return {std::fabs(off) - apart, off > 0 ? Motion::forward : Motion::backward};
}

/// The limit of a creep towards this side.
inline double limit_of_creep(Motion side, Motion way, double sliding, double apart) {
    return side == way ? apart + sliding : apart - sliding;
}

/// Decides about a slip whose velocity has fallen to rounding. It becomes a creep if sliding friction alone balances
/// the pull and sticking could hold more. Returns how far the pull may then deviate from the balance; empty if it
/// sticks. `torques` is the sum of magnitudes of all torques.
std::optional<double> creeps_within(double pull, Motion way, double sliding, double holding, double torques);

/// Returns the angle at which a stopped mass is exactly at its limit if theta exceeds the limit by no more than
/// accumulated rounding, otherwise theta. `torques` is the sum of magnitudes of all torques.
double place_at_limit(const Pull& pull, double limit, double k, double M, double theta, double torques);

/// The state of a contact before a decision.
struct Before {
    Motion slid = Motion::stuck;    ///< direction in which it reached slip 0
    bool held = false;              ///< whether it stuck
    Motion creeps = Motion::stuck;  ///< direction in which it crept
};

/// The event when the contact moves this way from now on (`stuck`: does not move); empty if none.
std::optional<model::EventKind> event_of(const Before& before, Motion way);

struct Verdict {
    Motion way;  ///< new direction; stuck: it sticks, or creeps on
    std::optional<model::EventKind> event = {};
    bool creeps = false;
};
/// Decides the next state of one contact. A creep whose pull reverses ends in a stick.
Verdict decide(const Before& before, const Pull& pull);

/// The slip that ends a stick.
struct Released {
    model::Event slip;
    Motion slid;          ///< direction of sliding before the stick; stuck: it had not slid
    Motion way;           ///< direction from now on
    double off, torques;  ///< change of the pull during the stick, and magnitude of the torques
};
/// Returns whether the stick before the slip was spurious: the pull was at the limit to rounding, and passed it with an
/// impulse below rounding. If so, removes the stick event, or turns it into a turn if the motion reversed. `unit` is a
/// period of the motion.
bool only_touched(std::vector<model::Event>& events, const Released& released, double unit);

}  // namespace dinal::motion::contact
