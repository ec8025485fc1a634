// The drive of a system in a run: M, moving surfaces, a shaking support, states of its own, wanted events, and the
// initial state.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "model/controller.hpp"
#include "model/excitation.hpp"
#include "text/not_copied.hpp"

namespace dinal::model {

/// A variable integrated with the motion: d/dt = rate(t, theta, velocity, states).
struct OwnState {
    std::string name;
    double start = 0;
    std::shared_ptr<terms::UserFunction> rate;
};

/// A user's action at an event.
class EventAction : text::NotCopied {
public:
    virtual ~EventAction() = default;
    /// Changes the motion and the states; returns false if it failed (the owner knows why).
    virtual bool act(double t, State& state, std::span<double> states) = 0;
};

enum class Direction { up, down, both };

/// An event located where `when` passes zero.
struct WantedEvent {
    std::string name;
    std::shared_ptr<terms::UserFunction> when;
    Direction direction = Direction::both;
    bool stop = false;
    std::shared_ptr<EventAction> act = {};
};

/// Everything that acts on a system in a run, and its initial state.
struct Drive {
    /// A drive of a single body.
    Drive(Excitation M = {}, const State& start = {})  // NOLINT(google-explicit-constructor): M alone is a drive
        : loads{std::move(M)}, belts(1), theta0{start.theta}, velocity0{start.velocity} {}

    /// A drive without loads, all bodies at rest.
    [[nodiscard]] static Drive at_rest(std::size_t bodies, std::size_t joints) {
        Drive drive;
        drive.loads.resize(joints), drive.belts.resize(joints);
        drive.theta0.resize(bodies), drive.velocity0.resize(bodies);
        return drive;
    }

    std::vector<Excitation> loads;  ///< M of each body and link
    /// The velocity of the surface against which the dry friction of each body and link acts, rad per time unit.
    std::vector<Excitation> belts;
    Excitation base = {};  ///< acceleration of the support, rad per time unit^2; angles are relative to it
    std::vector<OwnState> states = {};
    std::vector<WantedEvent> events = {};
    std::vector<double> theta0, velocity0;  ///< one for each body

    // For a single body, or the first one.
    const Excitation& M() const { return loads.front(); }
    Excitation sum_of_loads() const {
        Excitation sum;
        for (const Excitation& load : loads) sum = sum + load;
        return sum;
    }
    const Excitation& belt() const { return belts.front(); }
    State start() const { return {theta0.front(), velocity0.front()}; }
    void start_at(const State& state) { theta0.front() = state.theta, velocity0.front() = state.velocity; }

    /// Returns whether anything except loads acts or is requested.
    bool has_more() const {
        return !states.empty() || !events.empty() || !base.components().empty() ||
               std::ranges::any_of(belts, [](const Excitation& belt) { return !belt.components().empty(); });
    }
};

}  // namespace dinal::model
