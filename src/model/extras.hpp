// What a run may have besides a system and an excitation: states of its own, events that a user wants located, a
// surface that moves and a support that shakes.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "model/controller.hpp"
#include "model/excitation.hpp"

namespace dinal::model {

/// A variable that is integrated with the motion: d/dt = rate(t, theta, velocity, states).
struct OwnState {
    std::string name;
    double start = 0;
    std::shared_ptr<terms::UserFunction> rate;
};

/// What a user does at one of his events.
class EventAction {
public:
    EventAction() = default;
    EventAction(const EventAction&) = delete;
    EventAction& operator=(const EventAction&) = delete;
    virtual ~EventAction() = default;
    /// Changes the state, and the states; false when it failed (and its owner knows why).
    virtual bool act(double t, State& state, std::span<double> states) = 0;
};

enum class Crossing { up, down, both };

/// Told where `when` passes zero.
struct WantedEvent {
    std::string name;
    std::shared_ptr<terms::UserFunction> when;
    Crossing direction = Crossing::both;
    bool stop = false;
    std::shared_ptr<EventAction> act = {};
};

struct Extras {
    std::vector<OwnState> states = {};
    std::vector<WantedEvent> events = {};
    Excitation belt = {};  ///< velocity of the surface that dry friction acts against, rad per time unit
    Excitation base = {};  ///< acceleration of the support, rad per time unit^2; theta is relative to it

    [[nodiscard]] bool any() const {
        return !states.empty() || !events.empty() || !belt.components().empty() || !base.components().empty();
    }
};

}  // namespace dinal::model
