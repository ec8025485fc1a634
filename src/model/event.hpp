// Events of a body or a contact: at velocity zero, at a wall, when a relay switches, when a contact opens or closes, or
// as defined by a user.
#pragma once

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

}  // namespace dinal::model
