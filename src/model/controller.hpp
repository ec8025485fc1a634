// Terms of M with a memory: sampled controllers, relays and delays. Their values depend on the history, so only a run
// can evaluate them; everywhere else they add and scale like other terms.
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
    std::shared_ptr<terms::UserFunction> function;  ///< function of t, theta, velocity, states; null if not needed

    /// The value is NaN, because it exists only within a run.
    double value(double /*t*/, const State& /*state*/) final { return std::numeric_limits<double>::quiet_NaN(); }
    void forget_failure() final {
        if (function != nullptr) function->forget_failure();
    }
};

/// The function is evaluated once at each instant at + n every, in order. The value acts after `delay` and is held
/// until the next one.
struct SampledController final : Controller {
    double every = 0, delay = 0;
    double at = 0;
    bool carried = false;                             ///< whether this is a copy in a worker of a sweep
    mutable std::optional<std::uint64_t> first = {};  ///< the function's memory before any run, if runs change it
    mutable const void* latest = nullptr;             ///< the run that used it last
};

/// Two levels with hysteresis: passing `off` (coming from `on`) switches to levels[1], passing `on` back to levels[0].
struct RelayController final : Controller {
    enum class Of { theta, velocity, state, function };
    double on = 0, off = 0;
    std::array<double, 2> levels{};
    Of of = Of::theta;
    std::string state;  ///< the state's name, for Of::state
    bool starts_on = true;

    double next_break(double t) override { return function == nullptr ? never : function->next_break(t); }
};

/// A copy of the relay with `own` as its function.
inline std::shared_ptr<RelayController> copied(const RelayController& relay, std::shared_ptr<terms::UserFunction> own) {
    auto copy = std::make_shared<RelayController>();
    copy->function = std::move(own);
    copy->on = relay.on, copy->off = relay.off, copy->levels = relay.levels;
    copy->of = relay.of, copy->state = relay.state, copy->starts_on = relay.starts_on;
    return copy;
}

/// A function of the state at the time t - `by`; before the start that is the initial state.
struct DelayedController final : Controller {
    double by = 0;

    double next_break(double t) override { return function->next_break(t); }
};

/// The component as a controller of this class, or nullptr.
template <class C = Controller>
const C* controller_of(const Component& component) {
    const auto* scripted = std::get_if<Scripted>(&component.term);
    return scripted == nullptr ? nullptr : dynamic_cast<const C*>(scripted->function.get());
}

/// Returns whether M contains a controller of this class (by default any).
template <class C = Controller>
bool has_memory(const Excitation& excitation) {
    const auto& components = excitation.components();
    return std::ranges::any_of(components, [](const Component& c) { return controller_of<C>(c) != nullptr; });
}

}  // namespace dinal::model
