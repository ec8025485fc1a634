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

/// An operation on registers. Floats and whole numbers (64 bits that wrap) are told apart by the operation, not by the
/// register.
enum class Op : std::uint16_t {
    move,
    // floats
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
    native,  ///< the value at a time (a) of the excitation whose address b holds; fails at a time that is not finite
    // whole numbers
    add_whole,
    subtract_whole,
    multiply_whole,
    modulo_whole,
    divide_whole,
    negate_whole,
    abs_whole,
    // from whole to float, and back; `exact` is the former but fails beyond 2^53, the latter two fail beyond 64 bits
    to_float,
    exact,
    floor,
    ceil,
    // conditions: go on at `yes` or `no`
    less,
    less_equal,
    equal,
    less_whole,
    less_equal_whole,
    equal_whole,
    jump,  ///< to `yes`
    give,
    give_whole,
    fail,  ///< what the function does here is left to the function
};

/// The operation on two registers (of one operand: the same twice); false where it fails, as a whole number // 0 does.
bool apply(Op op, double a, double b, double& to);

/// The piece of an operation on which a result lies: whether a comparison holds, the sign within abs, the whole part of
/// a quotient.
double decision_of(Op op, double a, double b, double result);

inline bool is_comparison(Op op) {
    return op >= Op::less && op <= Op::equal_whole;
}
inline bool is_fold(Op op) {
    return op == Op::abs || op == Op::floor || op == Op::ceil || op == Op::modulo || op == Op::floor_divide ||
           op == Op::fmod;
}

/// A register holds either; a whole number in its bits.
inline double from_whole(std::int64_t whole) {
    return std::bit_cast<double>(whole);
}
inline std::int64_t to_whole(double bits) {
    return std::bit_cast<std::int64_t>(bits);
}
/// Or the address of an excitation of native terms, which the formula owns.
inline double from_excitation(const Excitation& excitation) {
    return std::bit_cast<double>(&excitation);
}
inline const Excitation& to_excitation(double bits) {
    return *std::bit_cast<const Excitation*>(bits);
}

/// Steps only lead forward, so that a program is bounded by its length.
class Formula {
public:
    struct Step {
        Op op;
        std::uint16_t to = 0, a = 0, b = 0;
        std::uint32_t yes = 0, no = 0;
    };
    using Excitations = std::vector<std::shared_ptr<const Excitation>>;
    /// Registers at the start: t comes into the first, with `motion` theta and velocity into the next two, and so many
    /// states from `states` on.
    /// `timeless`: t is a speed. `excitations` are those whose addresses stand in registers.
    Formula(std::vector<Step> steps, std::vector<double> registers, bool motion, std::size_t states,
            std::size_t state_count, bool timeless = false, Excitations excitations = {});

    /// NaN where the function must be asked.
    [[nodiscard]] double value(double t, const State& state, std::span<const double> states);

    /// See terms::UserFunction. Bits stand for theta and velocity, with `motion`, and then the states; the last one for
    /// a speed.
    void decide(terms::Piece& piece, double t, const State& state, std::span<const double> states, std::uint64_t again);
    [[nodiscard]] double value_on(const terms::Piece& piece, double t, const State& state,
                                  std::span<const double> states, std::vector<double>* margins);

    /// The rate at which that margin of a piece changes along a motion with these rates; NaN if it has none.
    [[nodiscard]] double margin_rate(const terms::Piece& piece, std::size_t condition, double t, const State& state,
                                     std::span<const double> states, const State& rate, std::span<const double> rates);

    /// The first time after t at which a condition of t changes: a comparison, the sign within abs, the step of floor,
    /// ceil, // or %, or at which an excitation in it breaks. It is the very double at which the function itself sees
    /// the change.
    [[nodiscard]] double next_break(double t);
    /// The same without the breaks of excitations.
    [[nodiscard]] double next_condition(double t) { return next_break(t, Breaks::own); }
    /// So long a time is of interest now: conditions that change far more often are noise, and no breaks.
    void begin(double span) {
        if (span != span_) knows_greatest_ = false, greatest_ = 0;
        span_ = span, gave_up_ = false, unfinished_ = 0;
    }

    /// The native terms whose sum it is, to rounding, from a time on, as long as its conditions are what they are at
    /// the time `inside`; none if it is no such sum.
    [[nodiscard]] std::optional<Excitation> terms(double from, double inside) const;
    /// After which time it is proven to repeat; 0 when that is not known, or when it is constant.
    [[nodiscard]] double period() const;

    // Its parts, for those who run it on other numbers.
    [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
    [[nodiscard]] const std::vector<double>& registers() const { return registers_; }
    [[nodiscard]] bool takes_motion() const { return motion_; }
    [[nodiscard]] std::size_t first_state() const { return states_; }
    [[nodiscard]] std::size_t state_count() const { return state_count_; }

    /// It compares, rounds or folds at all.
    [[nodiscard]] bool has_conditions() const { return has_conditions_; }
    /// Such a condition depends on theta, velocity or a state.
    [[nodiscard]] bool has_conditions_of_motion() const { return of_motion_; }
    /// Returns whether an excitation in it is evaluated at a time that depends on these.
    [[nodiscard]] bool moves_excitations() const {
        return !excitations_.empty() && depends_on_motion([](Op op) { return op == Op::native; });
    }
    /// The times of its conditions could not be found in bounded work: next_break() says `never`.
    [[nodiscard]] bool gave_up() const { return gave_up_; }

private:
    struct Range;
    class Look;
    enum class Breaks { own, all };
    double next_break(double t, Breaks which);
    double search(double t, Breaks which);
    [[nodiscard]] std::vector<std::uint64_t> sources() const;
    [[nodiscard]] bool depends_on_motion(bool (*wanted)(Op op)) const;
    void start(double t, const State& state, std::span<const double> states);
    bool is_dubious(double t, double found);
    [[nodiscard]] bool is_of_excitation(double found) const;

    std::vector<Step> steps_;
    std::vector<double> registers_;
    Excitations excitations_;
    bool motion_;
    std::size_t states_, state_count_;
    bool timeless_, has_conditions_, of_motion_, gave_up_ = false;
    std::array<std::map<double, double>, 2> known_;  ///< from a time to the next break, of its own and of all
    int unfinished_ = 0;                             ///< searches that ended before they found one
    double span_ = 1, greatest_ = 0;                 ///< value at some times
    bool knows_greatest_ = false;
};

}  // namespace dinal::model
