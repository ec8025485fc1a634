// Terms of M with a memory: a controller that samples, a relay, one with a dead time. What they give depends on the
// run so far, so only a run can ask them; everywhere else they add and scale like any other term.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "model/excitation.hpp"

namespace dinal::model {

class Controller : public terms::UserFunction {
public:
    std::shared_ptr<terms::UserFunction> function;  ///< of t, theta, velocity, states; none where a relay needs none

    /// Outside of a run there is no value.
    double value(double /*t*/, const State& /*state*/) final { return std::numeric_limits<double>::quiet_NaN(); }
    void forget_failure() final {
        if (function != nullptr) function->forget_failure();
    }
};

/// Asked once at each instant at + n every, in order; what it says acts `delay` later and is held until the next.
struct SampledController final : Controller {
    double every = 0, delay = 0;
    double at = 0;
    bool carried = false;  ///< to a worker of a sweep, and not made there
    mutable std::optional<std::uint64_t> first =
        {};                                ///< what it remembered before its first run, if a run changes that
    mutable const void* latest = nullptr;  ///< its last run
};

/// Two levels with hysteresis: past `off`, seen from `on`, it gives levels[1], back past `on` levels[0].
struct RelayController final : Controller {
    enum class Of { theta, velocity, state, function };
    double on = 0, off = 0;
    std::array<double, 2> levels{};
    Of of = Of::theta;
    std::string state;  ///< the name, of a state
    bool starts_on = true;

    double next_break(double t) override { return function == nullptr ? never : function->next_break(t); }
};

/// The same relay, with this function in the place of its own.
inline std::shared_ptr<RelayController> copied(const RelayController& relay, std::shared_ptr<terms::UserFunction> own) {
    auto copy = std::make_shared<RelayController>();
    copy->function = std::move(own);
    copy->on = relay.on, copy->off = relay.off, copy->levels = relay.levels;
    copy->of = relay.of, copy->state = relay.state, copy->starts_on = relay.starts_on;
    return copy;
}

/// A function of what was measured `by` ago; before the start that is the initial state.
struct DelayedController final : Controller {
    double by = 0;

    double next_break(double t) override { return function->next_break(t); }
};

/// The controller that this component is, nullptr when it is none.
template <class C = Controller>
const C* controller_of(const Component& component) {
    const auto* scripted = std::get_if<Scripted>(&component.term);
    return scripted == nullptr ? nullptr : dynamic_cast<const C*>(scripted->function.get());
}

/// Whether a controller of this kind is in M, or any.
template <class C = Controller>
bool has_memory(const Excitation& excitation) {
    const auto& components = excitation.components();
    return std::any_of(components.begin(), components.end(),
                       [](const Component& c) { return controller_of<C>(c) != nullptr; });
}

}  // namespace dinal::model
