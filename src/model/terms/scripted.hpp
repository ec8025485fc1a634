// excitation.scripted, and every user function used as M.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "model/oscillator.hpp"
#include "model/terms/term.hpp"
#include "text/not_copied.hpp"

namespace dinal::model {
class Formula;
}

namespace dinal::model::terms {

/// A function's memory between its calls in one run.
class FunctionMemory : text::NotCopied {
public:
    virtual ~FunctionMemory() = default;
    /// A copy with the same content, for a continued run; null if that fails (the owner knows why).
    virtual std::shared_ptr<FunctionMemory> copy() const = 0;
};

/// The decisions that a formula's conditions on the motion have taken; while they hold it is smooth. Bit masks stand
/// for theta, velocity and the states.
struct Piece {
    struct Condition {
        std::size_t step;  ///< index in its formula
        double beyond;     ///< the decision on the other side
        std::uint64_t of;  ///< bit mask of the variables it depends on
    };
    std::vector<double> decisions{};  ///< one for each step; NaN for steps without a decision
    std::vector<Condition> conditions{};
    std::shared_ptr<const void> owner{};  ///< identifies the formula

    void cross(std::size_t condition) { decisions[conditions[condition].step] = conditions[condition].beyond; }
};

/// A user's function of t or of t, theta, velocity. Virtual because the core must not depend on its language.
class UserFunction : text::NotCopied {
public:
    virtual ~UserFunction() = default;
    /// Returns NaN if the function failed (its owner knows why): the run ends there.
    virtual double value(double t, const State& state) = 0;
    /// The same for a run with own states, in the order of their names.
    virtual double value_with(double t, const State& state, std::span<const double> /*states*/) {
        return value(t, state);
    }
    /// out[i] = value(times[i]) in this order, up to and including the first that is not finite; returns the number of
    /// finite values. Virtual: a block enters the user's language only once.
    virtual std::size_t fill(std::span<const double> times, std::span<double> out) {
        for (std::size_t i = 0; i < times.size(); ++i) {
            out[i] = value(times[i], State{});
            if (!std::isfinite(out[i])) {
                return i;
            }
        }
        return times.size();
    }
    /// The function as a formula, or null; valid until other user code runs.
    virtual Formula* read() { return nullptr; }
    /// The first known jump or kink after t; `never` if unknown.
    virtual double next_break(double /*t*/) { return never; }
    /// The latest end of an interval from t on in which the function has no detail between samples; `never` if unknown.
    virtual double known_until(double /*t*/) { return never; }
    /// Returns whether its conditions on theta, velocity and states are known.
    virtual bool has_pieces() { return false; }
    /// Decides the piece at this moment. Existing decisions stay, except those that depend on a variable in `again`.
    virtual void decide(Piece& piece, double /*t*/, const State& /*state*/, std::span<const double> /*states*/,
                        std::uint64_t /*again*/) {
        piece = {};
    }
    /// The value with the decisions of the piece, also beyond it. `margins`, if not null, receives the distance to each
    /// condition, positive inside the piece.
    virtual double value_on(const Piece& /*piece*/, double t, const State& state, std::span<const double> states,
                            std::vector<double>* /*margins*/) {
        return value_with(t, state, states);
    }
    /// Returns, after a failure, whether the function may be evaluated at other times. The owner keeps the failure.
    virtual bool may_go_on() { return true; }
    /// Drops a failure that occurred only in a rejected trial step.
    virtual void forget_failure() {}
    /// A new memory for a run; null if the function needs none, or on failure.
    virtual std::shared_ptr<FunctionMemory> new_memory() { return nullptr; }
    /// Sets the memory for the following calls.
    virtual void use(const std::shared_ptr<FunctionMemory>& /*memory*/) {}
};

/// A copy that is not shared; null for null.
inline std::shared_ptr<FunctionMemory> copied(const std::shared_ptr<FunctionMemory>& memory) {
    return memory == nullptr ? nullptr : memory->copy();
}

/// A user's function, delayed by `delay`, with its declared properties. The excitation itself evaluates it, as it may
/// need the state and may fail.
// Shared: every excitation and run with the function keeps it alive.
struct Scripted {
    static const TermText about;

    std::shared_ptr<UserFunction> function;
    bool feedback = false;            ///< whether it is called with theta and velocity
    std::vector<double> breaks = {};  ///< its jumps and kinks (in its own time), increasing
    double period = 0;                ///< if > 0, the breaks repeat with this period
    double delay = 0;
    std::shared_ptr<UserFunction> original = {};  ///< knows the breaks if `function` is a replacement

    double next_break(double t) const {
        const double own = (original != nullptr ? original : function)->next_break(t - delay);
        const double announced = next_announced_break(t);
        return own == never ? announced : std::min(announced, later(t, own + delay));
    }
    double next_announced_break(double t) const {
        if (breaks.empty()) {
            return never;
        }
        const auto first_in_cycle = [this, t](double n) {
            const auto at = [this, n](double b) { return b + n * period + delay; };
            const auto found = std::ranges::partition_point(breaks, [&](double b) { return at(b) <= t; });
            return found == breaks.end() ? never : at(*found);
        };
        if (!(period > 0)) {
            return first_in_cycle(0);
        }
        const double n = std::floor((t - delay - breaks.front()) / period);
        for (int offset = -1; offset <= 2; ++offset) {
            if (const double found = first_in_cycle(n + offset); found < never) {
                return found;
            }
        }
        return std::nextafter(t, never);
    }
    double constant_from() const { return never; }
    double most() const { return never; }
    double repeats_after() const { return period; }
    void delay_by(double d) { delay += d; }
    [[nodiscard]] std::optional<text::Error> complaint() const;
    /// Removes a break listed twice: breaks = {0, 1.5, 3} with period = 3 has only two, to rounding.
    void drop_repeated_corner();
};

inline void repeat_after(Scripted& s, double period) {
    s.period = period;
}
inline constexpr text::Option scripted_options[] = {
    text::option<&Scripted::breaks>("breaks", "times at which it jumps or kinks", {.unit = "time units"}),
    {"period", "time units", text::its_own, text::positive, "period of the breaks", text::sets<repeat_after>},
};
inline constexpr TermText Scripted::about{
    {"excitation.scripted", "excitation.scripted(f, { breaks = { 0.5, 2 }, period = 3 })", scripted_options, true},
    "Any Lua function of t, or of t, theta, velocity: with two or more parameters (or ...) it "
    "is called with all three. breaks are times at which it jumps or kinks, so integrators do "
    "not step across them; with a period they repeat. M may also be the function itself. A "
    "function that is a formula (arithmetic, comparisons, if, for with constant bounds, math, "
    "numbers and excitations that it only reads) is read: it runs without Lua, with the same bits, and "
    "the times at which its conditions change are breaks; see e:obstacle. Runs with "
    "integrator.spectral{} also locate its conditions on theta, velocity and states. A function "
    "that is a sum of constants, powers of t, sines, exponentials and excitations between its breaks runs as "
    "native terms do, equal to rounding, where the run names no integrator.",
    "M = excitation.scripted(function(t) return t % 3 < 2 and 1 or 0 end, { breaks = { 0, 2 }, period = 3 "
    "})\nprint(M(7), M:next_break(7))  --> 1.0\t8.0"};

}  // namespace dinal::model::terms
