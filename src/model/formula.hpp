// A user's function as a program of a few operations: it computes the same bits as the function, but needs no Lua, and
// can be analysed. lua/formula_reader writes the program.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "model/excitation.hpp"
#include "model/oscillator.hpp"

namespace dinal::model {

/// An operation on registers. Lua's whole numbers are doubles here, which `exact` keeps below 2^53.
enum class Op : std::uint16_t {
    move,
    add,
    subtract,
    multiply,
    divide,
    modulo,
    floor_divide,
    power,
    negate,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan2,
    exp,
    log,
    log2,
    log10,
    sqrt,
    abs,
    fmod,
    native,  ///< the value at a time (a) of the excitation whose address b holds; fails if the time is not finite
    exact,   ///< the same whole number, without the sign of -0; fails beyond 2^53, as floor and ceil do
    floor,
    ceil,
    // conditions: continue at the step `yes` or `no`
    less,
    less_equal,
    equal,
    jump,  ///< continues at `yes`
    give,
    fail,  ///< the formula has no result here: call the function itself
};

/// Applies the operation to two registers (a unary operation gets the same one twice). Returns false on failure; a
/// comparison returns its truth.
bool apply(Op op, double a, double b, double& to);

/// The decision that selects the smooth piece of an operation: the truth of a comparison, the sign of the operand of
/// abs, the integer quotient.
double decision_of(Op op, double a, double b, double result);

inline bool is_comparison(Op op) {
    return op >= Op::less && op <= Op::equal;
}
inline bool is_fold(Op op) {
    return op == Op::abs || op == Op::floor || op == Op::ceil || op == Op::modulo || op == Op::floor_divide ||
           op == Op::fmod;
}

/// A register can also hold the address of an excitation of native terms that the formula owns.
inline double from_excitation(const Excitation& excitation) {
    return std::bit_cast<double>(&excitation);
}
inline const Excitation& to_excitation(double bits) {
    return *std::bit_cast<const Excitation*>(bits);
}

/// The program of a function. Jumps only lead forward, so the number of steps bounds its run time.
class Formula {
public:
    struct Step {
        Op op;
        std::uint16_t to = 0, a = 0, b = 0;
        std::uint32_t yes = 0, no = 0;
    };
    using Excitations = std::vector<std::shared_ptr<const Excitation>>;
    /// `registers` are the initial values. The first register receives t (or the speed, if `timeless`), the next two
    /// theta and velocity if `motion`, and `state_count` registers from index `states` the states. `excitations` owns
    /// those whose addresses are in registers.
    Formula(std::vector<Step> steps, std::vector<double> registers, bool motion, std::size_t states,
            std::size_t state_count, bool timeless = false, Excitations excitations = {});

    /// Returns NaN if the formula fails and the function itself must be called.
    [[nodiscard]] double value(double t, const State& state, std::span<const double> states);

    /// See terms::UserFunction. In `again`, the first bits stand for theta and velocity (if `motion`), the next for the
    /// states, the last bit for the speed.
    void decide(terms::Piece& piece, double t, const State& state, std::span<const double> states, std::uint64_t again);
    [[nodiscard]] double value_on(const terms::Piece& piece, double t, const State& state,
                                  std::span<const double> states, std::vector<double>* margins);

    /// The rate of change of margin `condition` of the piece along a motion with these rates; NaN if it is unknown.
    [[nodiscard]] double margin_rate(const terms::Piece& piece, std::size_t condition, double t, const State& state,
                                     std::span<const double> states, const State& rate, std::span<const double> rates);

    /// The first time after t at which a condition of t changes: a comparison, the sign within abs, a step of floor,
    /// ceil, // or %, or a break of an excitation. The result is the exact double at which the function changes.
    [[nodiscard]] double next_break(double t);
    /// Like next_break(t), but ignores the breaks of excitations.
    [[nodiscard]] double next_condition(double t) { return next_break(t, Breaks::own); }
    /// Sets the time span of interest. Conditions that change very often within it are treated as noise, not as breaks.
    void begin(double span) {
        if (span != span_) knows_greatest_ = false, greatest_ = 0;
        span_ = span, gave_up_ = false, unfinished_ = 0;
    }

    /// The formula as a sum of native terms of the time since `from`, to rounding. It is valid while the conditions
    /// that hold at the time `inside` still hold. Empty if the formula is not such a sum.
    std::optional<Excitation> terms(double from, double inside) const;
    /// The proven period in t; 0 if none is known or the formula is constant.
    double period() const;

    // The program, for evaluation with other kinds of numbers.
    const std::vector<Step>& steps() const { return steps_; }
    const std::vector<double>& registers() const { return registers_; }
    bool takes_motion() const { return motion_; }
    std::size_t first_state() const { return states_; }
    std::size_t state_count() const { return state_count_; }

    /// Returns whether the formula compares, rounds or folds at all.
    bool has_conditions() const { return has_conditions_; }
    /// Returns whether a condition depends on theta, velocity or a state.
    bool has_conditions_of_motion() const { return of_motion_; }
    /// Returns whether an excitation is evaluated at a time that depends on theta, velocity or a state.
    bool moves_excitations() const {
        return !excitations_.empty() && depends_on(sources(), [](Op op) { return op == Op::native; });
    }
    /// Returns whether the search for break times exceeded its limit; next_break() then returns `never`.
    bool gave_up() const { return gave_up_; }

private:
    struct Range;
    class Look;
    enum class Breaks { own, all };
    double next_break(double t, Breaks which);
    double search(double t, Breaks which);
    std::vector<std::uint64_t> sources() const;
    bool depends_on(std::vector<std::uint64_t> of, bool (*wanted)(Op op)) const;
    void find_levels();
    std::pair<double, double> beyond(std::size_t at, double decision) const;
    void start(double t, const State& state, std::span<const double> states);
    bool is_dubious(double t, double found);
    bool is_of_excitation(double found) const;

    std::vector<Step> steps_;
    std::vector<double> registers_;
    Excitations excitations_;
    bool motion_;
    std::size_t states_, state_count_;
    bool timeless_, has_conditions_, of_motion_ = false, of_time_ = false, gave_up_ = false;
    std::map<std::size_t, std::vector<double>> levels_;  ///< of some steps, see find_levels()
    std::array<std::map<double, double>, 2> known_;  ///< from a time to the next break, for Breaks::own and Breaks::all
    int unfinished_ = 0;                             ///< searches that hit their limit without finding a break
    double span_ = 1, greatest_ = 0;                 ///< time span of interest; the greatest |value| at sample times
    bool knows_greatest_ = false;
};

}  // namespace dinal::model
