// What can happen to a mass, or between two: at velocity zero, at a wall, by a controller that switches, where a
// contact opens or closes, or as a user has said.
#pragma once

#include <string_view>

namespace dinal::model {

enum class EventKind {
    turn,      ///< the velocity passes zero and the motion goes on the other way
    stick,     ///< the velocity reaches zero and stays there
    slip,      ///< breakaway: |M - k theta| has passed Re
    rest,      ///< a stick that nothing can end any more
    impact,    ///< a wall turned it back
    switched,  ///< a relay took its other level
    user,      ///< what a user asked for, by its name
    opened,    ///< nothing presses on the contact any more
    closed,    ///< something presses on it again
    released,  ///< an elastic wall pushes no more
    slider_sticks,
    slider_slips,  ///< of a Jenkins element, whose contact has none of its own
};
inline constexpr int event_kind_count = 12;

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

/// From here on the mass stands.
constexpr bool is_stop(EventKind kind) {
    return kind == EventKind::stick || kind == EventKind::rest;
}

/// The velocity is exactly 0 at a turn, stick, slip or rest: that against what it slides on.
struct Event {
    double t = 0;
    EventKind kind = EventKind::turn;
    double theta = 0;
    double M = 0;   ///< the excitation at t, from the right: with k theta it explains the decision
    int user = -1;  ///< of a user's event: which one
    int where = 0;  ///< the joint whose theta and velocity these are; a relay's body
    double velocity = 0;
};

}  // namespace dinal::model
