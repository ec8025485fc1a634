// What can happen to the mass at velocity zero.
#pragma once

#include <string_view>

namespace dinal::model {

enum class EventKind {
    turn,   ///< the velocity passes zero and the motion goes on the other way
    stick,  ///< the velocity reaches zero and stays there
    slip,   ///< breakaway: |M - k theta| has passed Re
    rest,   ///< a stick that nothing ended within the window
};

constexpr std::string_view name(EventKind kind) {
    switch (kind) {
        case EventKind::turn:
            return "turn";
        case EventKind::stick:
            return "stick";
        case EventKind::slip:
            return "slip";
        case EventKind::rest:
            return "rest";
    }
    return "";
}

/// The velocity is exactly 0 at every event.
struct Event {
    double t = 0;
    EventKind kind = EventKind::turn;
    double theta = 0;
    double M = 0;  ///< the excitation at t, from the right: with k theta it explains the decision
};

}  // namespace dinal::model
