// What an integrator is: a value with options that runs a problem. A new one is a folder (or a file) of its own with
// what `Method` asks for, and a row in integrators.hpp.
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <variant>

#include "model/excitation.hpp"
#include "model/oscillator.hpp"
#include "motion/trajectory.hpp"
#include "text/expected.hpp"
#include "text/option.hpp"

namespace dinal::motion {

struct Problem;
struct Pair;

/// What people read about a method, and the options that fill it.
struct MethodText {
    text::Call call;      ///< of Lua: "integrator.rk4"
    const char* summary;  ///< sentences, units included
    const char* example;  ///< Lua that runs; `-->` is followed by what the line prints
};

/// The distance between two evaluations of M, which times must be able to tell apart.
struct Resolution {
    const char* name;  ///< in sentences: "h"
    double time;
    bool is_step = true;  ///< what is shorter is stepped over; else the method looks closely where M says so
};

/// Of a method that does not ask the friction law at velocity zero: what the story of a run says about that.
struct OwnRule {
    std::string setting;  ///< how the run was integrated: a sentence
    const char* release;  ///< "the listing let it go at", before the torque
};

/// How the general engine cuts a run into stretches.
struct Cut {
    double tolerance = 1e-12;
    double longest = model::never;  ///< stretch, time units
    double step = 0;                ///< of the classical Runge-Kutta method; 0: collocation
    const Pair* pair = nullptr;     ///< a step of this one instead of collocation
};

/// An option struct with its own run. The ranges of its options are in `about`; it may also have
///     std::optional<text::Error> wrong_for(const model::Oscillator& system, const model::Excitation& excitation)
///     const;
/// what these forbid besides, and
///     OwnRule own_rule() const;
///     Cut cut() const;    it runs any system, and problems with more in them (Problem::more)
///     static constexpr bool asks_in_order = true;          M at ever later times only: it may remember something
template <class T>
concept Method = requires(const T& method, const model::Oscillator& system, const Problem& problem) {
    { T::about } -> std::convertible_to<const MethodText&>;
    { method.resolution(system) } -> std::same_as<Resolution>;
    { method.run(problem) } -> std::same_as<Trajectory>;
};

/// Any method, seen through what all have in common: for arguments only, it does not keep the method alive.
class MethodView {
public:
    template <Method M>
    MethodView(const M& method)  // NOLINT(google-explicit-constructor): as a string is a string_view
        : method_(&method), common_(&common_of<M>) {}
    template <Method... M>
    MethodView(const std::variant<M...>& one)  // NOLINT(google-explicit-constructor)
        : MethodView(std::visit([](const auto& method) { return MethodView(method); }, one)) {}

    [[nodiscard]] const MethodText& about() const { return common_->about; }
    /// The Lua text that makes it again.
    [[nodiscard]] std::string lua_text(text::Defaults defaults) const { return common_->lua_text(method_, defaults); }
    /// An option that is out of its range, or wrong for this system under this excitation.
    [[nodiscard]] std::optional<text::Error> wrong(const model::Oscillator& system,
                                                   const model::Excitation& excitation) const {
        return common_->wrong(method_, system, excitation);
    }
    [[nodiscard]] Resolution resolution(const model::Oscillator& system) const {
        return common_->resolution(method_, system);
    }
    [[nodiscard]] Trajectory run(const Problem& problem) const { return common_->run(method_, problem); }
    [[nodiscard]] std::optional<OwnRule> own_rule() const { return common_->own_rule(method_); }
    /// It asks M in order of time, so nobody needs to know whether M remembers something.
    [[nodiscard]] bool asks_in_order() const { return common_->asks_in_order; }
    /// Of one that runs any system, and states, events of the user, belts, bases and controllers with a memory.
    [[nodiscard]] std::optional<Cut> cut() const { return common_->cut(method_); }

private:
    struct Common {
        const MethodText& about;
        std::string (*lua_text)(const void* method, text::Defaults defaults);
        std::optional<text::Error> (*wrong)(const void* method, const model::Oscillator& system,
                                            const model::Excitation& excitation);
        Resolution (*resolution)(const void* method, const model::Oscillator& system);
        Trajectory (*run)(const void* method, const Problem& problem);
        std::optional<OwnRule> (*own_rule)(const void* method);
        std::optional<Cut> (*cut)(const void* method);
        bool asks_in_order;
    };
    template <class M>
    static constexpr bool is_in_order() {
        if constexpr (requires { M::asks_in_order; }) {
            return M::asks_in_order;
        } else {
            return false;
        }
    }
    template <class M>
    static const M& as(const void* method) {
        return *static_cast<const M*>(method);
    }
    template <class M>
    static constexpr Common common_of{
        M::about,
        [](const void* method, text::Defaults defaults) {
            return text::lua_text(M::about.call.name, M::about.call.options, as<M>(method), defaults);
        },
        [](const void* method, const model::Oscillator& system,
           const model::Excitation& excitation) -> std::optional<text::Error> {
            if (auto wrong = text::complaint(M::about.call.options, as<M>(method))) return wrong;
            if constexpr (requires { as<M>(method).wrong_for(system, excitation); }) {
                return as<M>(method).wrong_for(system, excitation);
            } else {
                static_assert(
                    !requires { &M::wrong_for; }, "wrong_for takes the system and the excitation");
                return std::nullopt;
            }
        },
        [](const void* method, const model::Oscillator& system) { return as<M>(method).resolution(system); },
        [](const void* method, const Problem& problem) { return as<M>(method).run(problem); },
        [](const void* method) -> std::optional<OwnRule> {
            if constexpr (requires { as<M>(method).own_rule(); }) {
                return as<M>(method).own_rule();
            } else {
                return std::nullopt;
            }
        },
        [](const void* method) -> std::optional<Cut> {
            if constexpr (requires { as<M>(method).cut(); }) {
                return as<M>(method).cut();
            } else {
                return std::nullopt;
            }
        },
        is_in_order<M>()};

    const void* method_;
    const Common* common_;
};

}  // namespace dinal::motion
