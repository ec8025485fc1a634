// What acts on the mass of a run with more in it: M with its controllers, the base, the belt, and the rates of states.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "model/controller.hpp"
#include "model/extras.hpp"
#include "model/lowered.hpp"
#include "motion/belt_slope.hpp"
#include "motion/engine/nodes.hpp"
#include "motion/simulate.hpp"

namespace dinal::motion::hybrid {

using engine::rung, engine::Side, engine::towards;

/// Where the mass was, for what acts with a delay.
class Past {
public:
    [[nodiscard]] virtual model::State at(double t, Side side) const = 0;

protected:
    Past() = default;
    Past(const Past&) = default;
    Past& operator=(const Past&) = default;
    ~Past() = default;
};

/// What a controller remembers.
struct ControllerMemory {
    double output = 0;                                ///< of one that samples: held
    std::deque<std::pair<double, double>> pending{};  ///< the time from when on, and the output
    std::int64_t instant = 0;                         ///< the next one
    bool on = true;                                   ///< of a relay
    std::shared_ptr<model::terms::Memory> own = {};   ///< of the function of one that samples
};

/// One moment of the motion.
struct MotionPoint {
    double t;
    Side side;
    model::State y;
    std::span<const double> states;
};

/// What short times are measured in: T0, or all of a run that is shorter.
inline double pace_of(const Problem& problem) {
    return std::min(problem.system.natural_period(), problem.window.end - problem.window.start);
}

class Field {
public:
    Field(const Problem& problem, const Past& past);

    [[nodiscard]] std::size_t state_count() const { return extras_.states.size(); }
    [[nodiscard]] bool has_surroundings() const { return has_belt() || !extras_.base.components().empty(); }
    /// Without dry friction it is as if there were none.
    [[nodiscard]] bool has_belt() const { return rubs_; }
    /// Whether a function wants to know theta or velocity of the moment itself.
    [[nodiscard]] bool asks_the_motion() const;
    /// Whether M has a function that is known where it was asked only. What is held is known, and so is when a relay
    /// switches, but for one of a function.
    [[nodiscard]] bool asks_functions() const;
    /// Whether nothing that acts on the mass but itself changes on the stretch without a jump in which this time lies:
    /// what controllers give is held.
    [[nodiscard]] bool is_held(double inside) const;
    /// M of the user.
    [[nodiscard]] double load(const MotionPoint& at) const;
    /// -I a(t) of the base.
    [[nodiscard]] double push(double t, Side side) const;
    [[nodiscard]] bool belt_breaks(double t) const {
        return extras_.belt.next_break(std::nextafter(t, -model::never)) == t;
    }
    /// The velocity of the belt.
    [[nodiscard]] double belt(double t, Side side) const;
    /// The same, but where it is passing zero: a hair of velocity that way on which it goes.
    [[nodiscard]] double belt_heading(double t, Side side) const;
    static constexpr double hair = std::numeric_limits<double>::min();
    /// How fast that changes, from the right.
    [[nodiscard]] BeltSlope belt_slope(double t) const;
    void rates(const MotionPoint& at, double* out) const;
    /// The first time after t at which anything is known to jump.
    [[nodiscard]] double next_break(double t) const;
    /// The shortest delay; `never` when there is none.
    [[nodiscard]] double shortest_delay() const;
    [[nodiscard]] std::span<const double> delays() const { return delays_; }
    /// How far one may look from t and overlook nothing (Excitation::view).
    [[nodiscard]] double view(double t, double spacing) const;

    /// At the start of a run: where the relays stand, and which instants are still to come.
    void begin(const MotionPoint& at);
    /// At the time of `at`: outputs that have waited until now, and the instants of this time. False when one failed.
    bool arrive(const MotionPoint& at);
    /// After a value that was not finite: whether the functions may be asked again, at other times.
    [[nodiscard]] bool may_go_on() const;

    // Relays, by their place among the components.
    [[nodiscard]] const model::RelayController* relay(std::size_t component) const { return kinds_[component].relay; }
    [[nodiscard]] std::size_t component_count() const { return kinds_.size(); }
    /// What it looks at, and where that switches it: sign (measured - level) is positive until then.
    struct Threshold {
        double sign, level;
    };
    [[nodiscard]] Threshold threshold(std::size_t component) const;
    /// The place among theta, velocity and states of what it looks at; none where that is a function.
    [[nodiscard]] std::optional<std::size_t> looks_at(std::size_t component) const;
    /// Positive until it is to switch.
    [[nodiscard]] double until_switch(std::size_t component, const MotionPoint& at) const;
    void toggle(std::size_t component) { memory_[component].on = !memory_[component].on; }

    [[nodiscard]] const std::vector<ControllerMemory>& memory() const { return memory_; }
    /// As a run left it that goes on, and may go on again.
    void remember(const std::vector<ControllerMemory>& memory) {
        memory_ = memory;
        for (ControllerMemory& each : memory_) each.own = model::terms::copied(each.own);
    }

private:
    /// What a component is, looked up once: at most one of these.
    struct Kind {
        const model::Scripted* function = nullptr;
        const model::SampledController* sampled = nullptr;
        const model::RelayController* relay = nullptr;
        const model::DelayedController* delayed = nullptr;
        [[nodiscard]] bool is_native() const {
            return function == nullptr && sampled == nullptr && relay == nullptr && delayed == nullptr;
        }
    };
    [[nodiscard]] double asked(std::size_t component, const MotionPoint& at) const;
    [[nodiscard]] double instant(const model::SampledController& sampled, std::int64_t n) const {
        return sampled.at + static_cast<double>(n) * sampled.every;
    }

    const model::Excitation& excitation_;
    const model::Extras& extras_;
    const Past& past_;
    double inertia_;
    bool rubs_;             // a belt, with dry friction
    double short_stretch_;  // in which a belt may be differentiated, time units
    model::State initial_;
    std::vector<Kind> kinds_;               // of each component
    std::vector<ControllerMemory> memory_;  // for each component
    std::vector<double> delays_;
};

}  // namespace dinal::motion::hybrid
