// The decision about contacts at slip 0: which of them stick, and in which direction the others slip.
#pragma once

#include <optional>
#include <vector>

#include "model/event.hpp"
#include "motion/contact.hpp"
#include "motion/engine/balance.hpp"
#include "motion/engine/contacts.hpp"
#include "motion/engine/frames.hpp"
#include "motion/engine/slide.hpp"
#include "motion/engine/torque_sizes.hpp"

namespace dinal::motion::engine {

/// An event reported by a decision.
struct Reported {
    model::Event event;
    /// whether a released joint sticks again, which cancels its slip event of the same instant
    bool holds_again = false;
    /// for a slip: direction of sliding before the stick; stuck: it did not slide
    model::Motion slid = model::Motion::stuck;
    model::Motion way = model::Motion::stuck;  ///< for a slip: its direction
    /// for a slip: change of the pull since the stick, and magnitude of the torques
    double off = 0, size = 0;
};

/// Storage for decisions, to avoid repeated allocation.
struct DecisionRoom {
    /// The data of a decision about one joint.
    struct Case {
        bool at_rest = false;  ///< whether the joint is at slip 0
        bool taken_back = false;
        contact::Before before = {};
        model::Motion let_go = model::Motion::stuck;  ///< direction of a joint that reached its limit at this instant
        int leant = 0;
        double pull = 0;  ///< the pull at its release
    };
    std::vector<Case> cases;
    std::vector<Slipping> entered;  ///< friction at the start of the decision
    TorqueSizes sizes;              ///< torques at the start of the decision
    Balance balance;
    std::vector<Reported> reported;
};

/// The parts of a run that a decision uses. None of them changes the motion.
struct Evaluation {
    const Mechanics& mechanics;
    Frames& frames;
    Balances& balances;
    Projection& projection;
    const Slides& slides;
    const Segment& last;  ///< the stretch that ended now
    DecisionRoom& room;
    double unit;  ///< time scale of the motion
};

struct Cause {
    /// A joint that reached its limit; it is released first.
    struct Released {
        std::size_t joint;
        model::Motion way;
    };
    std::optional<Released> released = {};
    bool reports = true;  ///< whether changes are reported as events; false at the start
};

struct Decision {
    bool good = true;  ///< whether all evaluated values are finite
    Now now;           ///< the new modes and velocities
    Contacts contacts;
    std::vector<Reported> reported;
};

/// Decides about all joints at slip 0. All joints start as sticking; the one that exceeds its limit the most is
/// released, and the rest is evaluated again. A released joint that would not move in its direction sticks again. This
/// function is the only place that applies the friction limits at slip 0 to a system; it depends on its arguments only.
Decision decide(const Evaluation& by, Now&& now, Contacts&& contacts, const Cause& cause);

/// Makes the event of a joint or, if a relay switches, of a body.
model::Event event_at(const Mechanics& mechanics, const Now& now, model::EventKind kind, std::size_t where,
                      int user = -1);

}  // namespace dinal::motion::engine
