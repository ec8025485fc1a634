// The decision of contacts at slip 0: which of them hold, and which way the others slide.
#pragma once

#include <optional>
#include <vector>

#include "model/event.hpp"
#include "motion/contact.hpp"
#include "motion/engine/balance.hpp"
#include "motion/engine/contacts.hpp"
#include "motion/engine/frames.hpp"
#include "motion/engine/torque_sizes.hpp"

namespace dinal::motion::engine {

/// An event that a decision reports.
struct Told {
    model::Event event;
    bool holds_again = false;  ///< a stick of a joint that was let go: with its slip at this instant it is no event
    model::Motion slid = model::Motion::stuck;  ///< of a slip: the way in which it slid before it stuck; stuck: none
    model::Motion way = model::Motion::stuck;   ///< of a slip: the way in which it slides now
    double off = 0, size = 0;                   ///< of a slip: the change of its pull since then, and of its torques
};

/// Room for decisions, so that each need not allocate it.
struct DecisionRoom {
    /// The knowledge of a decision about a joint.
    struct Asked {
        bool asked = false;  ///< it is at slip 0
        bool taken_back = false;
        contact::Before before = {};
        model::Motion let_go = model::Motion::stuck;  ///< the way of what came to its limit at this instant, too
        int leant = 0;
        double pull = 0;  ///< that let it go
    };
    std::vector<Asked> asked;
    std::vector<Slipping> entered;  ///< friction when the decision began
    TorqueSizes sizes;              ///< when the decision began
    Balance balance;
    std::vector<Told> told;
};

/// The parts of a run that a decision evaluates. None of them changes the motion.
struct Evaluation {
    const Mechanics& mechanics;
    Frames& frames;
    Balances& balances;
    Projection& projection;
    const Segment& last;  ///< the stretch that ended now
    DecisionRoom& room;
    double unit;  ///< of time
};

struct Cause {
    /// A joint that was seen to come to its limit, and goes first.
    struct Released {
        std::size_t joint;
        model::Motion way;
    };
    std::optional<Released> released = {};
    bool told = true;  ///< changes are events, as they are not at the start
};

struct Decision {
    bool good = true;  ///< all that was evaluated is finite
    Now now;           ///< the modes and velocities from now on
    Contacts contacts;
    std::vector<Told> told;
};

/// Decides for all joints at slip 0 at once: what can hold holds; of those that can not, the one that is farthest
/// beyond its limit goes, and the others are asked again; what would not go the way on which it was let go holds after
/// all. The only place that knows the limits of friction at slip 0; the same arguments have the same decision.
Decision decide(const Evaluation& by, Now&& now, Contacts&& contacts, const Cause& cause);

/// Returns the event of a joint or, for switches, a body.
model::Event event_at(const Mechanics& mechanics, const Now& now, model::EventKind kind, std::size_t where,
                      int user = -1);

}  // namespace dinal::motion::engine
