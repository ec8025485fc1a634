// What a user gives as a number, an excitation or a function: a load, the velocity of a belt, a normal load. Compiled
// from an excitation, and asked with the whole state of a run.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "model/controller.hpp"
#include "model/formula.hpp"
#include "model/system.hpp"
#include "motion/engine/nodes.hpp"

namespace dinal::motion::engine {

/// One moment of a run: y is all angles, all velocities, and then the states of the user's.
struct Moment {
    double t;
    Side side;
    std::span<const double> y;
};

/// How a user's function is asked.
struct Asking {
    bool named = true;     ///< with all of y as states, but those of bristles
    std::size_t told = 0;  ///< so much of y
    /// The motion at an earlier time, for what acts with a delay.
    std::function<std::vector<double>(double t, Side side)> past = {};

    [[nodiscard]] double ask(model::UserFunction& function, const Moment& at) const {
        return ask_at(function, towards(at.t, at.side), at.y);
    }
    [[nodiscard]] double ask_at(model::UserFunction& function, double t, std::span<const double> y) const {
        if (y.empty()) return function.value(t, {});  // of the time alone
        return function.value_with(t, state(y), states(y));
    }
    [[nodiscard]] model::State state(std::span<const double> y) const {
        return named ? model::State{} : model::State{y[0], y[1]};
    }
    [[nodiscard]] std::span<const double> states(std::span<const double> y) const {
        return y.first(told).subspan(named ? 0 : 2);
    }
};

/// A user's function of the motion. If its conditions of the motion are known, it is held to the piece between them.
class Piecewise {
public:
    Piecewise(const Asking* asking, model::UserFunction* function, double delay)
        : asking_(asking), function_(function), delay_(delay), has_pieces_(function->has_pieces()) {}

    /// Of a law of friction, which is called with a speed, alone or before all else. It acts one way at a time.
    struct Law {
        bool alone;
        std::function<double(const Moment&)> slip;
        double way = 0;         ///< 0: its joint does not slide
        bool of_angle = false;  ///< it is a spring, and what it is called with may have any sign
    };
    Piecewise(const Asking* asking, model::UserFunction* function, Law law) : Piecewise(asking, function, 0) {
        law_ = std::move(law);
    }
    /// From now on it acts this way.
    void act(double way) {
        if (law_->way != way) let_go();
        law_->way = way;
    }

    [[nodiscard]] bool has_pieces() const { return has_pieces_; }
    [[nodiscard]] bool is_law() const { return law_.has_value(); }
    [[nodiscard]] bool is_held() const { return piece_.owner != nullptr; }
    /// The next time at which a rate or a law changes its formula.
    [[nodiscard]] double next_break(double t) const {
        return law_ && law_->alone ? model::never : function_->next_break(t);
    }
    [[nodiscard]] double value(const Moment& at) const {
        if (law_) return value(at, law_->way * law_->slip(at));
        if (piece_.conditions.empty()) return asking_->ask_at(*function_, time(at), at.y);
        return function_->value_on(piece_, time(at), asking_->state(at.y), asking_->states(at.y), nullptr);
    }
    /// Of a law, at this speed. At 0 it is what the function gives, whichever piece it is held to.
    [[nodiscard]] double value(const Moment& at, double speed) const {
        return called(at, speed, [&](double t, const model::State& state, std::span<const double> states) {
            return is_held() && (speed != 0 || law_->of_angle) ? function_->value_on(piece_, t, state, states, nullptr)
                                                               : function_->value_with(t, state, states);
        });
    }
    /// Decides the conditions at this moment; decisions stay, except those that depend on what `again` has bits for.
    void decide(const Moment& at, std::uint64_t again) {
        if (!has_pieces_ || (law_ && law_->way == 0)) return;
        const bool stays = std::none_of(piece_.conditions.begin(), piece_.conditions.end(),
                                        [again](const auto& condition) { return (condition.of & again) != 0; });
        if (is_held() && stays && !crossed_) return;
        crossed_ = false;
        // What sets off is on its way already.
        const double given = law_ ? law_->way * law_->slip(at) : 0;
        const double speed = law_ && !law_->of_angle ? std::max(given, std::numeric_limits<double>::min()) : given;
        called(at, speed, [&](double t, const model::State& state, std::span<const double> states) {
            function_->decide(piece_, t, state, states, again);
        });
    }
    [[nodiscard]] const std::vector<model::terms::Piece::Condition>& conditions() const { return piece_.conditions; }
    /// Positive as long as each condition stays as it was decided.
    void margins(const Moment& at, std::vector<double>& out) const {
        const double speed = law_ ? law_->way * law_->slip(at) : 0;
        called(at, speed, [&](double t, const model::State& state, std::span<const double> states) {
            function_->value_on(piece_, t, state, states, &out);
        });
    }
    [[nodiscard]] double decision(std::size_t step) const { return piece_.decisions[step]; }
    void cross(std::size_t condition) { piece_.cross(condition), crossed_ = true; }
    void let_go() { piece_ = {}; }
    /// Null while it is not held.
    [[nodiscard]] const model::terms::Piece* piece() const { return is_held() ? &piece_ : nullptr; }

private:
    [[nodiscard]] double time(const Moment& at) const { return towards(at.t - delay_, at.side); }
    /// Calls it with the arguments of the function: t, or the speed alone; the state; the states.
    template <class F>
    std::invoke_result_t<F, double, const model::State&, std::span<const double>> called(const Moment& at, double speed,
                                                                                         F call) const {
        if (!law_) return call(time(at), asking_->state(at.y), asking_->states(at.y));
        if (law_->alone) return call(speed, model::State{}, std::span<const double>());
        with_speed_.assign(1, speed);
        const auto states = asking_->states(at.y);
        with_speed_.insert(with_speed_.end(), states.begin(), states.end());
        return call(time(at), asking_->state(at.y), std::span<const double>(with_speed_));
    }

    const Asking* asking_;
    model::UserFunction* function_;
    double delay_;
    bool has_pieces_, crossed_ = false;
    std::optional<Law> law_ = {};
    mutable std::vector<double> with_speed_ = {};  ///< the states that a law is given
    model::terms::Piece piece_ = {};
};

class Signal {
public:
    Signal() = default;
    Signal(const model::Excitation& excitation, const Asking* asking);

    [[nodiscard]] bool none() const { return parts_.empty(); }
    /// A function wants to know the motion.
    [[nodiscard]] bool asks_the_motion() const { return asks_the_motion_; }
    /// A function that is known where it was asked only.
    [[nodiscard]] bool asks_functions() const { return asks_functions_; }
    /// A function that may do anything at any time, be it where nothing of the motion changes.
    [[nodiscard]] bool asks_in_time() const { return asks_in_time_; }
    [[nodiscard]] bool has_script() const { return excitation_.has_script(); }
    /// A user's function of the time, of which a series on a stretch tells as much as it does.
    [[nodiscard]] bool is_sampled() const { return asks_in_time_ && of_time_only_; }
    [[nodiscard]] double value(const Moment& at) const { return of_time(at) + of_motion(at); }
    /// What depends on the time alone, controllers that hold a value among it.
    [[nodiscard]] double of_time(const Moment& at) const {
        if (!of_time_only_) return sum(at, false);
        if (at.t != asked_last_.t || at.side != asked_last_.side) asked_last_ = {at.t, at.side, sum(at, false)};
        return asked_last_.M;
    }
    [[nodiscard]] double of_motion(const Moment& at) const { return asks_the_motion_ ? sum(at, true) : 0; }
    /// of_time() at all nodes of a stretch. What is not finite ends them: from there on they are no numbers.
    void sample(const NodeTimes& when, Nodes& out) const;

    [[nodiscard]] double next_break(double t) const;
    [[nodiscard]] double view(double t, double spacing) const { return excitation_.view(t, spacing); }
    [[nodiscard]] double constant_from() const { return excitation_.constant_from(); }
    /// It is known between doubles of the time, too.
    [[nodiscard]] bool tells_rests() const { return excitation_.tells_rests(); }
    /// It is never greater than this, either way.
    [[nodiscard]] double most() const {
        return asks_the_motion_ || model::has_memory(excitation_) ? model::never : excitation_.most();
    }
    void each_function(const std::function<void(model::UserFunction&)>& call) const { excitation_.each_function(call); }
    [[nodiscard]] const std::vector<double>& delays() const { return delays_; }
    /// All its functions are read, but for controllers that hold a value, and the times of their changes are known.
    [[nodiscard]] bool is_read() const {
        return std::all_of(parts_.begin(), parts_.end(), [](const Part& part) {
            if (part.function == nullptr) return part.delayed == nullptr;
            const model::Formula* read = part.function->function->read();
            return read != nullptr && !read->gave_up();
        });
    }
    /// Its functions that act at this time and are read: the formula, the piece that it is held to, by how much later
    /// it acts, its gain.
    template <class F>
    void for_each_read(double t, F f) const {
        for (const Part& part : parts_) {
            const model::Component& c = *part.component;
            if (part.function == nullptr || c.gain == 0 || t < c.from || t >= c.to) continue;
            model::Formula* read = part.function->function->read();
            if (read != nullptr)
                f(*read, part.piecewise ? part.piecewise->piece() : nullptr, part.function->delay, c.gain);
        }
    }
    /// A function of the motion has no pieces that are known.
    [[nodiscard]] bool samples_the_motion() const {
        return std::any_of(parts_.begin(), parts_.end(),
                           [](const Part& part) { return part.piecewise && !part.piecewise->has_pieces(); });
    }
    /// Its functions of the motion that act at this time; the others hold no piece.
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

    /// Calls its functions that are not read, whatever they give.
    void call_unread(const Moment& at) const;

    // Controllers.
    [[nodiscard]] bool has_sampled() const {
        return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.sampled != nullptr; });
    }
    /// At the start of a run.
    void begin(const Moment& at, const std::vector<std::string>& names);
    /// At the time of `at`: outputs that have waited until now, and the instants of this time. False when one failed.
    bool arrive(const Moment& at);
    [[nodiscard]] std::size_t relays() const { return relays_.size(); }
    /// The functions of relays, if they have one.
    template <class F>
    void for_each_relay_function(F f) const {
        for (const std::size_t i : relays_) {
            if (parts_[i].relay->function != nullptr) f(*parts_[i].relay->function);
        }
    }
    /// Positive until the relay is to switch.
    [[nodiscard]] double until_switch(std::size_t relay, const Moment& at) const;
    void toggle(std::size_t relay) { memory_[relays_[relay]].on = !memory_[relays_[relay]].on; }

    struct Memory {
        double output = 0;
        std::deque<std::pair<double, double>> pending{};  ///< the time from when on, and the output
        std::int64_t instant = 0;
        bool on = true;                               ///< of a relay
        std::optional<std::size_t> place{};           ///< in y, of what a relay looks at
        std::shared_ptr<model::terms::Memory> own{};  ///< of the function of one that samples
    };
    [[nodiscard]] const std::vector<Memory>& memory() const { return memory_; }
    /// As a run left it that goes on, and may go on again.
    void remember(const std::vector<Memory>& memory) {
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
    [[nodiscard]] double sum(const Moment& at, bool of_motion) const;
    [[nodiscard]] double value_of(std::size_t i, const Moment& at) const;

    model::Excitation excitation_;
    const Asking* asking_ = nullptr;
    std::vector<Part> parts_;
    std::vector<Memory> memory_;
    std::vector<std::size_t> relays_, held_;
    std::vector<double> delays_;
    bool asks_the_motion_ = false, asks_functions_ = false, asks_in_time_ = false, of_time_only_ = true;
    mutable model::Spread spread_{.places = cheb::nodes};
    /// Of the last stretch: of_time() at both ends, where the next one begins at one of these.
    static constexpr double nowhen = std::numeric_limits<double>::quiet_NaN();
    struct Known {
        double t = nowhen, rest = 0, M = 0;
    };
    mutable std::array<Known, 2> known_{};
    mutable struct {
        double t = nowhen;
        Side side = Side::at;
        double M = 0;
    } asked_last_{};
};

}  // namespace dinal::motion::engine
