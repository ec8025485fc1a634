// The interface of an integrator: a value with options that runs a problem. A new one is a folder or file that
// satisfies `Method`, and a row in integrators.hpp.
#pragma once

#include <array>
#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "model/excitation.hpp"
#include "model/oscillator.hpp"
#include "motion/run.hpp"
#include "text/expected.hpp"
#include "text/option.hpp"

namespace dinal::motion {

struct Problem;

/// The documentation of a method, and its options.
struct MethodText {
    text::Call call;      ///< its constructor in Lua: "integrator.rk4"
    const char* summary;  ///< sentences, units included
    const char* example;  ///< Lua that runs; `-->` precedes the output
};

/// The distance between two evaluations of M, which must exceed the rounding of times.
struct Resolution {
    const char* name;  ///< the option's name in sentences: "h"
    double time;
    bool is_step = true;  ///< whether shorter details are stepped over; otherwise the method refines at details
                          ///< declared by M
};

/// A release rule in place of the friction law's, in the words of run:explain().
struct OwnRule {
    std::string setting;  ///< a sentence on the settings of the run
    const char* release;  ///< text before the release torque: "the listing released it at"
};

/// An embedded pair of explicit Runge-Kutta methods with dense output.
struct Pair {
    using Weights = std::array<double, 7>;  ///< weights of the slopes of the stages
    struct Stage {
        double at;  ///< time as a fraction of the step
        Weights sum;
    };
    double power;                   ///< the estimated error is proportional to step^power
    std::span<const Stage> stages;  ///< stages after the first; the last is the end of the step
    Weights error;                  ///< weights of the error estimate
    /// At the fraction x of the step, dense output is the cubic through both ends plus x^2 (1 - x)^2 times the slopes
    /// with these weights.
    Weights bulge;
};

/// How the general engine divides a run into stretches, smooth intervals of the motion.
struct Cut {
    double tolerance = 1e-12;
    double longest = model::never;  ///< longest stretch, time units
    double step = 0;                ///< step of the classical Runge-Kutta method; 0 means collocation
    const Pair* pair = nullptr;     ///< embedded Runge-Kutta pair used instead of collocation; null means none
};

/// An option struct with a run. `about` has the ranges of its options. Optional members:
///     std::optional<text::Error> wrong_for(const model::Oscillator& system, const model::Excitation& excitation)
///     const;
/// for errors that ranges cannot express, and
///     OwnRule own_rule() const;
///     Cut cut() const;    it runs any system and drive (Problem::more)
///     static constexpr bool evaluates_in_order = true;    M is evaluated at increasing times only
template <class T>
concept Method = requires(const T& method, const model::Oscillator& system, const Problem& problem) {
    { T::about } -> std::convertible_to<const MethodText&>;
    { method.resolution(system) } -> std::same_as<Resolution>;
    { method.run(problem) } -> std::same_as<Run>;
};

/// A view of any method, for arguments only: it does not keep the method alive.
class MethodView {
public:
    template <Method M>
    MethodView(const M& method)  // NOLINT(google-explicit-constructor): like a string_view of a string
        : method_(&method), common_(&common_of<M>) {}
    template <Method... M>
    MethodView(const std::variant<M...>& one)  // NOLINT(google-explicit-constructor)
        : MethodView(std::visit([](const auto& method) { return MethodView(method); }, one)) {}

    const MethodText& about() const { return common_->about; }
    /// The Lua expression that constructs the method.
    std::string lua_text(text::Defaults defaults) const { return common_->lua_text(method_, defaults); }
    /// An error if an option is out of range, or wrong for this system or excitation.
    [[nodiscard]] std::optional<text::Error> wrong(const model::Oscillator& system,
                                                   const model::Excitation& excitation) const {
        return common_->wrong(method_, system, excitation);
    }
    Resolution resolution(const model::Oscillator& system) const { return common_->resolution(method_, system); }
    Run run(const Problem& problem) const { return common_->run(method_, problem); }
    std::optional<OwnRule> own_rule() const { return common_->own_rule(method_); }
    /// Returns whether M is evaluated in order of time, so that a memory in M does no harm.
    bool evaluates_in_order() const { return common_->evaluates_in_order; }
    /// The stretches of a method that runs any system with states, user events, belts, bases and controllers; otherwise
    /// empty.
    std::optional<Cut> cut() const { return common_->cut(method_); }

private:
    struct Common {
        const MethodText& about;
        std::string (*lua_text)(const void* method, text::Defaults defaults);
        std::optional<text::Error> (*wrong)(const void* method, const model::Oscillator& system,
                                            const model::Excitation& excitation);
        Resolution (*resolution)(const void* method, const model::Oscillator& system);
        Run (*run)(const void* method, const Problem& problem);
        std::optional<OwnRule> (*own_rule)(const void* method);
        std::optional<Cut> (*cut)(const void* method);
        bool evaluates_in_order;
    };
    template <class M>
    static constexpr bool is_in_order() {
        if constexpr (requires { M::evaluates_in_order; }) {
            return M::evaluates_in_order;
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
