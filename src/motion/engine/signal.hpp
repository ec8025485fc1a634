// A user's quantity compiled from an excitation and evaluated with the whole state of a run: a load, the velocity of a
// belt, a normal load.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "model/bounds.hpp"
#include "model/controller.hpp"
#include "model/formula.hpp"
#include "model/system.hpp"
#include "motion/engine/nodes.hpp"

namespace dinal::motion::engine {

/// Bounds of the motion over some steps, which give bounds of formulas.
struct Ranges {
    model::bounds::Interval t;
    std::vector<model::bounds::Interval> y{};  ///< ranges of all entries of y

    /// The range of the formula, on its piece if given, or of the quantity that decides `condition`; empty if unknown.
    /// `named`: the formula receives all of y as states.
    std::optional<model::bounds::Interval> of(const model::Formula* formula, const model::terms::Piece* piece,
                                              bool named, double delay = 0,
                                              std::optional<std::size_t> condition = {}) const;
};

/// One moment of a run; y has all angles, all velocities, and then the user's states.
struct Moment {
    double t;
    Side side;
    std::span<const double> y;
    bool freely = false;  ///< whether functions that do not slide are evaluated directly, not on their pieces
    /// greatest speed of joints whose springs are evaluated so; faster joints pass a jump anyway
    double slow = model::never;
};

struct CallConvention {
    bool named = true;       ///< whether they receive all of y (without bristles) as states
    std::size_t passed = 0;  ///< length of the part of y that is passed
    /// Returns the motion at an earlier time, for delayed terms.
    std::function<std::vector<double>(double t, Side side)> past = {};

    double evaluate(model::UserFunction& function, const Moment& at) const {
        return evaluate_at(function, towards(at.t, at.side), at.y);
    }
    double evaluate_at(model::UserFunction& function, double t, std::span<const double> y) const {
        if (y.empty()) return function.value(t, {});  // depends on time only
        return function.value_with(t, state(y), states(y));
    }
    model::State state(std::span<const double> y) const { return named ? model::State{} : model::State{y[0], y[1]}; }
    std::span<const double> states(std::span<const double> y) const { return y.first(passed).subspan(named ? 0 : 2); }
};

/// A user's function of the motion. If its conditions are known, it is evaluated on the current piece.
class Piecewise {
public:
    Piecewise(const CallConvention* convention, model::UserFunction* function, double delay)
        : convention_(convention), function_(function), delay_(delay), has_pieces_(function->has_pieces()) {}

    /// A friction law or spring, whose first argument is a speed or an angle, alone or before the other states. It acts
    /// in one direction at a time.
    struct Law {
        bool alone;
        std::function<double(const Moment&)> slip;
        double way = 0;  ///< 0 if its joint does not slide
        /// The speed of the joint of a spring, whose argument is an angle of any sign; empty: a friction law.
        std::function<double(const Moment&)> speed = {};
        [[nodiscard]] bool of_angle() const { return speed != nullptr; }
    };
    Piecewise(const CallConvention* convention, model::UserFunction* function, Law law)
        : Piecewise(convention, function, 0) {
        law_ = std::move(law);
    }
    /// Sets the direction in which it acts.
    void set_direction(double way) {
        if (law_->way != way) let_go();
        law_->way = way;
    }

    /// A slide along a condition: the value is a mixture of those on both sides.
    struct Slide {
        enum class Side { both, own, beyond };
        std::function<double(const Moment&)> share{};  ///< fraction of the value from beyond
        Side used = Side::both;
        model::terms::Piece beyond{};
        std::size_t condition = 0;  ///< index in the function's own piece
        /// First the two limits 0 and 1 of the fraction, then the other conditions of both pieces.
        std::vector<model::terms::Piece::Condition> conditions{};
        std::vector<std::pair<Side, std::size_t>> others{};
        std::array<model::terms::Piece, 2> apart{};  ///< both pieces with these other conditions only
    };

    bool has_pieces() const { return has_pieces_; }
    bool is_friction() const { return law_ && !law_->of_angle(); }
    bool is_spring() const { return law_ && law_->of_angle(); }
    bool is_held() const { return piece_.owner != nullptr; }
    /// The next time at which the formula changes.
    double next_break(double t) const { return law_ && law_->alone ? model::never : function_->next_break(t); }
    double value(const Moment& at) const {
        if (slide_) return sliding(at);
        if (law_) return value(at, law_->way * law_->slip(at));
        if (piece_.conditions.empty() || at.freely) return convention_->evaluate_at(*function_, time(at), at.y);
        return function_->value_on(piece_, time(at), convention_->state(at.y), convention_->states(at.y), nullptr);
    }
    /// The value of a law at this speed. At speed 0 it ignores the piece and evaluates the function.
    double value(const Moment& at, double speed) const {
        return called(at, speed, [&](double t, const model::State& state, std::span<const double> states) {
            const bool freely = law_->of_angle() ? at.freely && !(law_->speed(at) > at.slow) : speed == 0;
            const bool on_piece = is_held() && !freely;
            return on_piece ? function_->value_on(piece_, t, state, states, nullptr)
                            : function_->value_with(t, state, states);
        });
    }
    /// Decides the conditions at this moment; existing decisions stay, except those that depend on a variable in
    /// `again`.
    void decide(const Moment& at, std::uint64_t again) {
        if (!has_pieces_ || (law_ && law_->way == 0) || slide_) return;
        // If time alone selects another branch, a piece without conditions may gain some.
        const bool stays = ~again != 0 && std::none_of(piece_.conditions.begin(), piece_.conditions.end(),
                                                       [again](const auto& c) { return (c.of & again) != 0; });
        if (is_held() && stays && !crossed_) return;
        crossed_ = false;
        // A joint about to slip counts as moving already.
        const double given = argument(at);
        const double speed = law_ && !law_->of_angle() ? std::max(given, std::numeric_limits<double>::min()) : given;
        called(at, speed, [&](double t, const model::State& state, std::span<const double> states) {
            function_->decide(piece_, t, state, states, again);
        });
    }
    const std::vector<model::terms::Piece::Condition>& conditions() const {
        return slide_ ? slide_->conditions : piece_.conditions;
    }
    /// Computes margins that are positive while each condition keeps its decision.
    void margins(const Moment& at, std::vector<double>& out) const {
        if (slide_) return sliding_margins(at, out);
        const double speed = argument(at);
        called(at, speed, [&](double t, const model::State& state, std::span<const double> states) {
            function_->value_on(piece_, t, state, states, &out);
        });
    }
    /// Returns whether a comparison or sign condition certainly keeps its decision while the motion is within these
    /// ranges.
    bool keeps(std::size_t condition, const Ranges& ranges, bool named) const;
    double decision(std::size_t step) const { return piece_.decisions[step]; }
    void cross(std::size_t condition) { piece_.cross(condition), crossed_ = true; }
    void let_go() { piece_ = {}, slide_ = nullptr; }
    /// The current piece, or nullptr.
    const model::terms::Piece* piece() const { return slide_ ? slide_->apart.data() : is_held() ? &piece_ : nullptr; }
    /// The piece beyond the condition that it slides along, or nullptr.
    const model::terms::Piece* beyond() const { return slide_ ? &slide_->apart[1] : nullptr; }

    /// Starts to slide along the first condition that differs between two moments on either side of it and depends on
    /// these arguments only. Returns false if there is none. The caller then sets the share.
    bool slide(const Moment& own, const Moment& beyond, std::uint64_t arguments = ~std::uint64_t{0});
    /// Also watches the other conditions. A condition counts as the same surface if its margin is below `near` and
    /// changes from one side to the other.
    void watch_others(const Moment& one_side, const Moment& other_side, double near);
    bool slides() const { return slide_ != nullptr; }
    [[nodiscard]] Slide& sliding() { return *slide_; }
    /// Ends the slide at the crossed condition: 0 or 1 for a limit of the fraction, otherwise a condition of both
    /// sides.
    void leave(std::size_t condition);
    /// The margin of the condition along which it slides, and the rate of this margin for the given rates of y.
    std::pair<double, double> margin(const Moment& at, std::span<const double> rates) const;
    /// The second derivative of this margin, if it depends on time and angles only, of which y has `angles`; `stretch`
    /// is a short time.
    double margin_bend(const Moment& at, std::span<const double> rates, std::size_t angles, double stretch) const;

private:
    double on(const model::terms::Piece& piece, const Moment& at, std::vector<double>* margins) const {
        return called(at, argument(at), [&](double t, const model::State& state, std::span<const double> states) {
            return function_->value_on(piece, t, state, states, margins);
        });
    }
    double margin_rate(model::Formula& of, const Moment& at, std::span<const double> rates) const;
    double sliding(const Moment& at) const;
    void sliding_margins(const Moment& at, std::vector<double>& out) const;
    double time(const Moment& at) const { return towards(at.t - delay_, at.side); }
    /// Calls `call` with the function's arguments: t, or the speed alone; the state; the states.
    template <class F>
    std::invoke_result_t<F, double, const model::State&, std::span<const double>> called(const Moment& at, double speed,
                                                                                         F call) const {
        if (!law_) return call(time(at), convention_->state(at.y), convention_->states(at.y));
        if (law_->alone) return call(speed, model::State{}, std::span<const double>());
        with_speed_.assign(1, speed);
        const auto states = convention_->states(at.y);
        with_speed_.insert(with_speed_.end(), states.begin(), states.end());
        return call(time(at), convention_->state(at.y), std::span<const double>(with_speed_));
    }

    /// The speed or angle at which a law is evaluated; 0 for other functions.
    double argument(const Moment& at) const { return law_ ? law_->way * law_->slip(at) : 0; }

    const CallConvention* convention_;
    model::UserFunction* function_;
    double delay_;
    bool has_pieces_, crossed_ = false;
    std::optional<Law> law_ = {};
    mutable std::vector<double> with_speed_ = {};  ///< the states passed to a law
    model::terms::Piece piece_ = {};
    std::shared_ptr<Slide> slide_ = {};
};

class Signal {
public:
    Signal() = default;
    Signal(const model::Excitation& excitation, const CallConvention* convention);

    bool none() const { return parts_.empty(); }
    bool depends_on_motion() const { return depends_on_motion_; }
    /// Returns whether some function is known only at sampled points.
    bool samples_functions() const { return samples_functions_; }
    /// Returns whether some function may change at any time, also while the motion does not.
    bool changes_in_time() const { return changes_in_time_; }
    bool has_script() const { return excitation_.has_script(); }
    /// Returns whether it is a user's function of time alone, which its series on a stretch represents.
    bool is_sampled() const { return changes_in_time_ && of_time_only_; }
    double value(const Moment& at) const { return of_time(at) + of_motion(at); }
    /// The part that depends on time only, including controllers that hold a value.
    double of_time(const Moment& at) const {
        if (!of_time_only_) return sum(at, false);
        if (at.t != last_evaluated_.t || at.side != last_evaluated_.side)
            last_evaluated_ = {at.t, at.side, sum(at, false)};
        return last_evaluated_.M;
    }
    double of_motion(const Moment& at) const { return depends_on_motion_ ? sum(at, true) : 0; }
    /// Evaluates of_time() at all nodes of a stretch; NaN from the first value on that is not finite.
    void sample(const NodeTimes& when, Nodes& out) const;
    /// Keeps the series of sampled functions of a resolved stretch, if it has decayed to `tolerance`. A next stretch
    /// that begins within it evaluates the series up to its end instead of calling the functions again.
    void keep(const NodeTimes& when, double tolerance) const;
    double kept_until() const { return sampled_ == nullptr ? -model::never : sampled_->until; }

    double next_break(double t) const;
    double view(double t, double spacing) const { return excitation_.view(t, spacing); }
    double constant_from() const { return excitation_.constant_from(); }
    /// Returns whether it can be evaluated between two doubles of the time.
    bool takes_rests() const { return excitation_.takes_rests(); }
    /// An upper bound of its magnitude.
    double most() const {
        return depends_on_motion_ || model::has_memory(excitation_) ? model::never : excitation_.most();
    }
    void each_function(const std::function<void(model::UserFunction&)>& call) const { excitation_.each_function(call); }
    const std::vector<double>& delays() const { return delays_; }
    /// Returns whether all its functions, except controllers that hold a value, are formulas with known breaks.
    bool is_read() const {
        return std::all_of(parts_.begin(), parts_.end(), [](const Part& part) {
            if (part.function == nullptr) return part.delayed == nullptr;
            const model::Formula* read = part.function->function->read();
            return read != nullptr && !read->gave_up();
        });
    }
    /// Visits its formulas that act at this time, with their piece, delay and gain.
    template <class F>
    void for_each_read(double t, F f) const {
        for (const Part& part : parts_) {
            const model::Component& c = *part.component;
            if (part.function == nullptr || c.gain == 0 || t < c.from || t >= c.to) continue;
            model::Formula* read = part.function->function->read();
            if (read == nullptr) continue;
            f(*read, part.piecewise ? part.piecewise->piece() : nullptr, part.function->delay, c.gain);
            if (part.piecewise && part.piecewise->beyond() != nullptr)
                f(*read, part.piecewise->beyond(), part.function->delay, c.gain);
        }
    }
    /// Visits its formulas of the past motion that act at this time, with the gain and a function that returns the past
    /// motion for a time.
    template <class F>
    void for_each_delayed(double t, F f) const {
        for (const Part& part : parts_) {
            const model::Component& c = *part.component;
            if (part.delayed == nullptr || c.gain == 0 || t < c.from || t >= c.to) continue;
            model::Formula* read = part.delayed->function->read();
            if (read == nullptr) continue;
            f(*read, c.gain, [&](double now) { return convention_->past(now - part.delayed->by, Side::at); });
        }
    }
    /// Returns whether some function of the motion has unknown pieces.
    bool samples_the_motion() const {
        return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) {
            if (!part.piecewise || part.piecewise->has_pieces()) return false;
            const model::Formula* read = part.function->function->read();
            return read == nullptr || read->gave_up();
        });
    }
    /// Visits its functions of the motion that act at this time; the others drop their piece.
    template <class F>
    void for_each_piecewise(double t, F f) {
        for (const std::size_t i : held_) {
            const model::Component& c = *parts_[i].component;
            if (c.gain != 0 && t >= c.from && t < c.to) {
                f(*parts_[i].piecewise);
            } else {
                parts_[i].piecewise->let_go();
            }
        }
    }

    /// Calls its functions that are not known as formulas, and ignores the results.
    void call_unread(const Moment& at) const;

    // Controllers.
    bool has_sampled() const {
        return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.sampled != nullptr; });
    }
    /// Starts a run.
    void begin(const Moment& at, const std::vector<std::string>& names);
    /// Applies pending outputs and sampling instants at the time of `at`. Returns false if one failed.
    bool update_controllers(const Moment& at);
    std::size_t relays() const { return relays_.size(); }
    /// Visits the functions of relays that have one.
    template <class F>
    void for_each_relay_function(F f) const {
        for (const std::size_t i : relays_) {
            if (parts_[i].relay->function != nullptr) f(*parts_[i].relay->function);
        }
    }
    /// A relay's watched value is sign * (input - level), positive until it must switch.
    struct Switching {
        double sign, level;
        std::optional<std::size_t> place;  ///< index of the input in y; none: a function
    };
    Switching switching(std::size_t relay) const;
    /// The watched value of the relay: positive until it must switch.
    double until_switch(std::size_t relay, const Moment& at) const;
    void toggle(std::size_t relay) { memory_[relays_[relay]].on = !memory_[relays_[relay]].on; }

    struct Memory {
        double output = 0;
        std::deque<std::pair<double, double>> pending{};  ///< pairs of time and output
        std::int64_t instant = 0;
        bool on = true;                                       ///< level of a relay
        std::optional<std::size_t> place{};                   ///< index in y of a relay's input
        std::shared_ptr<model::terms::FunctionMemory> own{};  ///< memory of a sampled function
    };
    const std::vector<Memory>& memory() const { return memory_; }
    /// Restores the memory of an earlier run, with copies, as that run may be continued again.
    void restore(const std::vector<Memory>& memory) {
        memory_ = memory;
        for (Memory& each : memory_) each.own = model::terms::copied(each.own);
    }

private:
    struct Part {
        const model::Component* component;
        const model::Scripted* function = nullptr;
        const model::SampledController* sampled = nullptr;
        const model::RelayController* relay = nullptr;
        const model::DelayedController* delayed = nullptr;
        bool of_motion = false;
        std::optional<Piecewise> piecewise = {};
    };
    double sum(const Moment& at, bool of_motion) const;
    double value_of(std::size_t i, const Moment& at) const;

    model::Excitation excitation_;
    const CallConvention* convention_ = nullptr;
    std::vector<Part> parts_;
    std::vector<Memory> memory_;
    std::vector<std::size_t> relays_, held_;
    std::vector<double> delays_;
    bool depends_on_motion_ = false, samples_functions_ = false, changes_in_time_ = false, of_time_only_ = true;
    /// whether everything that does not depend on the motion is a controller that holds its value for ever
    bool is_held_ = true;
    mutable model::Spread spread_{.places = cheb::nodes};
    /// Values of of_time() at both ends of the last stretch, one of which begins the next one.
    static constexpr double nowhen = std::numeric_limits<double>::quiet_NaN();
    struct Known {
        double t = nowhen, rest = 0, M = 0;
    };
    mutable std::array<Known, 2> known_{};
    mutable struct {
        double t = nowhen;
        Side side = Side::at;
        double M = 0;
    } last_evaluated_{};
    struct Sampled {
        Nodes values{};  ///< values on the last stretch, resolved or not
        NodeTimes when{};
        double until = -model::never;  ///< end of the time in which the series is valid
        Series series{};
    };
    std::unique_ptr<Sampled> sampled_;  ///< null if nothing is sampled
};

}  // namespace dinal::motion::engine
