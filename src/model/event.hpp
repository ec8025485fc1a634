// The events and outcomes of a run. Events of a body or a contact: at velocity zero, at a wall, when a relay switches,
// when a contact opens or closes, or as defined by a user.
#pragma once

#include <string>
#include <string_view>

namespace dinal::model {

enum class EventKind {
    turn,      ///< the velocity passes zero and the motion reverses
    stick,     ///< the velocity reaches zero and stays there
    slip,      ///< breakaway: |M - k theta| has passed Re
    rest,      ///< a stick that nothing can end
    impact,    ///< a wall reversed the motion
    switched,  ///< a relay changed its level
    user,      ///< a zero of a user's `when`
    opened,    ///< nothing presses on the contact any longer
    closed,    ///< the contact is pressed together again
    released,  ///< an elastic wall no longer pushes
    slider_sticks,
    slider_slips,  ///< slip of a slider in a Jenkins element; the contact as a whole does not slip
    slide_begins,
    slide_ends,  ///< a load begins or ceases to hold the motion on a surface where it jumps
};
inline constexpr int event_kind_count = 14;

constexpr std::string_view name(EventKind kind) {
    switch (kind) {
        case EventKind::turn:
            return "turn";
        case EventKind::stick:
        case EventKind::slider_sticks:
            return "stick";
        case EventKind::slip:
        case EventKind::slider_slips:
            return "slip";
        case EventKind::rest:
            return "rest";
        case EventKind::impact:
            return "impact";
        case EventKind::switched:
        case EventKind::slide_begins:
        case EventKind::slide_ends:
            return "switch";
        case EventKind::user:
            return "user";
        case EventKind::opened:
            return "open";
        case EventKind::closed:
            return "close";
        case EventKind::released:
            return "release";
    }
    return "";
}

/// Returns whether the mass is at rest after the event.
constexpr bool is_stop(EventKind kind) {
    return kind == EventKind::stick || kind == EventKind::rest;
}

/// At a turn, stick, slip or rest the velocity is exactly 0, relative to the sliding surface.
struct Event {
    double t = 0;
    EventKind kind = EventKind::turn;
    double theta = 0;
    double M = 0;   ///< excitation just after t; with k theta it explains the decision
    int user = -1;  ///< index of a user's event
    int where = 0;  ///< the joint of theta and velocity; for a relay or a slide its body
    double velocity = 0;
};

// The outcomes of a run, in one list with their sentences, so that neither can be forgotten.

#define DINAL_OUTCOMES(X)                                                                                        \
    X(reached_end, "reached the end")                                                                            \
    X(at_rest, "at rest")                                                                                        \
    X(stuck_at_end, "stuck at the end")                                                                          \
    X(stopped, "stopped at an event")                                                                            \
    X(interrupted, "interrupted")                                                                                \
    X(state_not_finite, "the state became infinite: unstable system, feedback or step")                          \
    X(excitation_not_finite, "M failed or became infinite")                                                      \
    X(not_a_function, "M depends on more than its arguments: evaluated again, it returned another value")        \
    X(unresolved, "the motion is not resolved at this time: try a larger tolerance, or rk4")                     \
    X(blocked,                                                                                                   \
      "a wall, freewheel or rigid link stops a moved body or belt: let it give way, as walls with stiffness do") \
    X(chattering, "switched endlessly at one time")

enum class Outcome {
#define DINAL_OUTCOME(id, sentence) id,
    DINAL_OUTCOMES(DINAL_OUTCOME)
#undef DINAL_OUTCOME
};

/// Returns whether the run reached the end of its window.
constexpr bool is_whole(Outcome outcome) {
    return outcome == Outcome::reached_end || outcome == Outcome::at_rest || outcome == Outcome::stuck_at_end;
}

constexpr std::string_view sentence(Outcome outcome) {
    switch (outcome) {
#define DINAL_OUTCOME(id, text) \
    case Outcome::id:           \
        return text;
        DINAL_OUTCOMES(DINAL_OUTCOME)
#undef DINAL_OUTCOME
    }
    return "";
}

/// A user's function that returned two values for the same arguments: it has a memory or uses random numbers.
struct Contradiction {
    std::string who;       ///< the function's name for the user: "M"
    const char* argument;  ///< the name of the argument `at`: "t"
    double at = 0;
    double first = 0, again = 0;  ///< the value returned first, and later for the same argument
};

/// "M depends on more than its arguments: at t = 3.25 it returned 0.5 and, evaluated again, 0.7"
std::string sentence(const Contradiction& found);
/// sentence(found), followed by the remedy.
std::string sentence_with_cure(const Contradiction& found);

}  // namespace dinal::model
