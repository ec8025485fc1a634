// excitation.scripted, and every function that stands for M: what a user has written.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "model/oscillator.hpp"
#include "model/terms/term.hpp"

namespace dinal::model {
class Formula;
}

namespace dinal::model::terms {

/// What a function remembers from one call to the next in one run.
class Memory {
public:
    Memory() = default;
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    virtual ~Memory() = default;
    /// Another one with the same content, for a run that goes on from here. None when that fails (and its owner knows
    /// why).
    [[nodiscard]] virtual std::shared_ptr<Memory> copy() const = 0;
};

/// The decisions of a function that was read, by its conditions of the motion: while they stay it is smooth. Bits stand
/// for theta, velocity and the states.
struct Piece {
    struct Condition {
        std::size_t step;  ///< of its formula
        double beyond;     ///< the decision on the other side
        std::uint64_t of;  ///< what it depends on
    };
    std::vector<double> decisions{};  ///< of each step; NaN where it has none
    std::vector<Condition> conditions{};
    std::shared_ptr<const void> owner{};  ///< what they were decided for

    void cross(std::size_t condition) { decisions[conditions[condition].step] = conditions[condition].beyond; }
};

/// A user's function of t or of t, theta, velocity. Virtual because the core must not know who wrote it.
class UserFunction {
public:
    UserFunction() = default;
    UserFunction(const UserFunction&) = delete;
    UserFunction& operator=(const UserFunction&) = delete;
    virtual ~UserFunction() = default;
    /// NaN says that the function failed (and that its owner knows why): the run ends there.
    virtual double value(double t, const State& state) = 0;
    /// The same for a run that has states of its own, in the order of their names.
    virtual double value_with(double t, const State& state, std::span<const double> /*states*/) {
        return value(t, state);
    }
    /// out[i] = value(times[i]) in this order, up to and including the first that is not finite; returns how many are.
    // Virtual, too: the way into the user's language is paid once for a block.
    virtual std::size_t fill(std::span<const double> times, std::span<double> out) {
        for (std::size_t i = 0; i < times.size(); ++i) {
            out[i] = value(times[i], State{});
            if (!std::isfinite(out[i])) {
                return i;
            }
        }
        return times.size();
    }
    /// What it computes, where that is known to the letter: null, or valid until something else of the user's runs.
    virtual Formula* read() { return nullptr; }
    /// The first time after t at which it is known to jump or kink; `never` when nothing is known.
    virtual double next_break(double /*t*/) { return never; }
    /// Its conditions of theta, velocity and states are known.
    virtual bool has_pieces() { return false; }
    /// The piece at this moment. Decisions that the piece holds already stay, except those that depend on `again`.
    virtual void decide(Piece& piece, double /*t*/, const State& /*state*/, std::span<const double> /*states*/,
                        std::uint64_t /*again*/) {
        piece = {};
    }
    /// The value with the decisions of the piece, also beyond it; `margins`, where given, are positive within, one for
    /// each condition.
    virtual double value_on(const Piece& /*piece*/, double t, const State& state, std::span<const double> states,
                            std::vector<double>* /*margins*/) {
        return value_with(t, state, states);
    }
    /// After a failure: whether it may be asked again, at other times. What failed stays known to the owner.
    virtual bool may_go_on() { return true; }
    /// The run got past where it failed: what failed was asked for a motion that was tried, and was none.
    virtual void forget_failure() {}
    /// A new memory for a run; none when it wants none, or when that fails.
    virtual std::shared_ptr<Memory> new_memory() { return nullptr; }
    /// The memory of the calls that follow.
    virtual void use(const std::shared_ptr<Memory>& /*memory*/) {}
};

/// The same content, shared with nobody; none for none.
inline std::shared_ptr<Memory> copied(const std::shared_ptr<Memory>& memory) {
    return memory == nullptr ? nullptr : memory->copy();
}

/// A user's function, delayed by `delay`, with what he says about it. The excitation itself asks for its value: it may
/// need the state, and may fail.
// Shared ownership: every excitation and every trajectory that contains the function keeps it alive.
struct Scripted {
    static const TermText about;

    std::shared_ptr<UserFunction> function;
    bool feedback = false;            ///< called with theta and velocity, too
    std::vector<double> breaks = {};  ///< where it jumps or kinks (in its own time), increasing
    double period = 0;                ///< > 0: the breaks repeat with this period
    double delay = 0;
    std::shared_ptr<UserFunction> original = {};  ///< knows its breaks, where another function stands for it

    [[nodiscard]] double next_break(double t) const {
        const double own = (original != nullptr ? original : function)->next_break(t - delay);
        const double announced = next_announced_break(t);
        return own == never ? announced : std::min(announced, later(t, own + delay));
    }
    [[nodiscard]] double next_announced_break(double t) const {
        if (breaks.empty()) {
            return never;
        }
        const auto first_in_cycle = [this, t](double n) {
            const auto at = [this, n](double b) { return b + n * period + delay; };
            const auto found = std::partition_point(breaks.begin(), breaks.end(), [&](double b) { return at(b) <= t; });
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
    [[nodiscard]] double constant_from() const { return never; }
    [[nodiscard]] double most() const { return never; }
    [[nodiscard]] double repeats_after() const { return period; }
    [[nodiscard]] Detail detail() const { return no_detail; }
    void delay_by(double d) { delay += d; }
    [[nodiscard]] std::optional<text::Error> complaint() const;
    /// breaks = {0, 1.5, 3} with period = 3 names the same corner twice; to rounding, it must not count twice.
    void drop_repeated_corner();
};

inline void repeat_after(Scripted& s, double period) {
    s.period = period;
}
inline constexpr text::Option scripted_options[] = {
    {"breaks", "time units", text::its_own, text::any_finite, "times at which it jumps or kinks",
     text::fills<&Scripted::breaks>},
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
