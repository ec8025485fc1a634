#include "motion/witness.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "model/controller.hpp"
#include "model/functions.hpp"

namespace dinal::motion {

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

// At most three of a hundred evaluations are repeated: one in 64 routinely, and two in 160 because of jumps.
constexpr std::uint64_t first_again = 12;  ///< the number of evaluations after which repetition begins
constexpr std::uint64_t questions_between = 64;
constexpr std::uint64_t questions_a_jump = 160;
/// A jump is a change this many times larger than usual.
constexpr double jump_factor = 8;

}  // namespace

Witness::Witness(std::shared_ptr<model::UserFunction> function, std::shared_ptr<Testimony> testimony, std::string who,
                 const char* argument, std::size_t states)
    : function_(std::move(function)),
      testimony_(std::move(testimony)),
      name_(std::move(who)),
      argument_(argument),
      next_(first_again),
      states_(places * states) {}

void Witness::keep(std::size_t place, const Answer& answer, std::span<const double> states) {
    answers_[place] = answer;
    known_ |= std::uint64_t{1} << place;
    if (states_.empty()) return;
    const std::size_t count = states_.size() / places;
    for (std::size_t i = 0; i < count; ++i) states_[place * count + i] = i < states.size() ? states[i] : 0;
}

/// Keeps every fourth answer; older answers are sparser.
void Witness::keep_for_later(const Answer& answer, std::span<const double> states) {
    if (evaluations_ == 1) keep(first_place, answer, states);
    if (evaluations_ % 4 != 0) return;
    const std::uint64_t n = evaluations_ / 4;
    const auto age = std::min(static_cast<std::size_t>(std::countr_zero(n)), ages - 1);
    keep(2 * age + static_cast<std::size_t>(n >> (age + 1) & 1U), answer, states);
}

/// Keeps an answer that is later in time than all before, so that a long search near one time does not displace the
/// answers of other times.
void Witness::keep_milestone(const Answer& answer, std::span<const double> states) {
    latest_ = answer.t;
    if (ahead_++ % way_ != 0) return;
    std::size_t place = first_milestone + static_cast<std::size_t>((ahead_ - 1) / way_);
    if (place == first_milestone + milestones) {  // keeps every second one
        const std::size_t count = states_.size() / places;
        for (std::size_t i = 1; i < milestones / 2; ++i) {
            const std::size_t to = first_milestone + i, from = first_milestone + 2 * i;
            answers_[to] = answers_[from];
            std::copy_n(states_.begin() + static_cast<std::ptrdiff_t>(from * count), count,
                        states_.begin() + static_cast<std::ptrdiff_t>(to * count));
        }
        way_ *= 2;
        place = first_milestone + milestones / 2;
    }
    keep(place, answer, states);
}

/// Repeats an evaluation; returns whether the answer is the same. A failure now would also have occurred without the
/// witness.
bool Witness::repeats_answer(std::size_t place) {
    const Answer& answer = answers_[place];
    const std::size_t count = states_.size() / places;
    const std::span<const double> states{states_.data() + place * count, count};
    const double again = function_->value_with(answer.t, answer.state, states);
    // Equal except for the sign of zero, which does not matter.
    if (again == answer.value) return true;
    if (std::isfinite(again)) {
        testimony_->found = model::Contradiction{name_, argument_, answer.t, answer.value, again};
    }
    return false;
}

/// Repeats an evaluation, each time of a different age.
bool Witness::repeat_one() {
    next_ = evaluations_ + questions_between;
    for (std::size_t i = 0; i < places_in_turn; ++i) {
        constexpr std::size_t stride = 7;  // coprime to places_in_turn = 45
        turn_ = (turn_ + stride) % places_in_turn;
        if ((known_ >> turn_ & 1U) != 0) return repeats_answer(turn_);
    }
    return true;
}

/// Records an answer and repeats doubtful evaluations. Returns false if the function contradicted itself.
bool Witness::record(const Answer& answer, std::span<const double> states) {
    ++evaluations_;
    bool jumped = false;
    if (evaluations_ >= first_again && answer.t >= answers_[last_].t) {
        const double change = std::fabs(answer.value - answers_[last_].value);
        if (change > jump_factor * usual_) {
            std::swap(last_, before_jump_);
            jumped = jumps_repeated_ * questions_a_jump <= evaluations_;
        }
        usual_ += (change - usual_) / 16;
    }
    keep(last_, answer, states);
    keep_for_later(answer, states);
    if (answer.t > latest_) keep_milestone(answer, states);
    if (!jumped) return true;
    ++jumps_repeated_;
    // A relay in a closure no longer returns its value from before the switch, and random numbers do not repeat.
    return repeats_answer(before_jump_) && repeats_answer(last_);
}

double Witness::value_with(double t, const model::State& state, std::span<const double> states) {
    if (testimony_->over) return function_->value_with(t, state, states);
    // The repetition comes first, so that side effects that others see are those of the latest call.
    if (testimony_->found || (evaluations_ >= next_ && !repeat_one())) return no_number;
    const double value = function_->value_with(t, state, states);
    if (!std::isfinite(value)) return value;
    return record({t, state, value}, states) ? value : no_number;
}

std::size_t Witness::fill(std::span<const double> times, std::span<double> out) {
    if (testimony_->over) return function_->fill(times, out);
    if (!testimony_->found) {
        const std::size_t good = function_->fill(times, out);
        if (good < times.size()) return good;
        std::size_t i = 0;
        while (i < good && record({times[i], {}, out[i]}, {}) && (evaluations_ < next_ || repeat_one())) ++i;
        if (i == good) return good;
    }
    out[0] = no_number;
    return 0;
}

/// Repeats kept evaluations after all other functions have run, because those may have changed variables that this one
/// reads.
void Witness::repeat_kept() {
    if (evaluations_ < 2 || testimony_->found || !repeats_answer(first_place)) return;
    for (std::size_t place = first_milestone; place < places_in_turn; ++place) {
        if ((known_ >> place & 1U) != 0 && !repeats_answer(place)) return;
    }
}

bool Witness::repeat_end(bool last) {
    if (evaluations_ < 2 || testimony_->found) return !testimony_->found;
    std::size_t place = first_place;
    for (std::size_t later = first_milestone; last && later < places_in_turn; ++later) {
        if ((known_ >> later & 1U) != 0) place = later;
    }
    return repeats_answer(place);
}

namespace {

bool has_functions(const model::Oscillator& system) {
    return model::user_law(system.friction()) != nullptr || system.spring().as<model::springs::UserSpring>() != nullptr;
}

std::shared_ptr<model::UserFunction> with_witness_inside(const model::Controller& controller, auto&& with_witness) {
    if (const auto* delayed = dynamic_cast<const model::DelayedController*>(&controller)) {
        auto own = std::make_shared<model::DelayedController>();
        own->function = with_witness(delayed->function);
        own->by = delayed->by;
        return own;
    }
    const auto* relay = dynamic_cast<const model::RelayController*>(&controller);
    if (relay == nullptr || relay->function == nullptr) return nullptr;
    return model::copied(*relay, with_witness(relay->function));
}

}  // namespace

std::shared_ptr<model::UserFunction> Witnesses::with_witness(const std::shared_ptr<model::UserFunction>& function,
                                                             std::string who, const char* argument,
                                                             std::size_t more_states) {
    witnesses_.push_back(
        std::make_shared<Witness>(function, testimony_, std::move(who), argument, states_ + more_states));
    return witnesses_.back();
}

model::Excitation Witnesses::with_witness(const model::Excitation& excitation, const std::string& who) {
    return excitation.with_functions([&](const std::shared_ptr<model::UserFunction>& function) {
        if (const auto* controller = dynamic_cast<const model::Controller*>(function.get())) {
            // A sampled controller is evaluated in order and may have a memory.
            const auto inside =
                with_witness_inside(*controller, [&](const auto& inner) { return with_witness(inner, who); });
            return inside == nullptr ? function : inside;
        }
        return with_witness(function, who);
    });
}

model::Drive Witnesses::with_witness(model::Drive drive, const Called& called) {
    for (std::size_t i = 0; i < drive.loads.size(); ++i) drive.loads[i] = with_witness(drive.loads[i], called("M", i));
    for (std::size_t j = 0; j < drive.belts.size(); ++j)
        drive.belts[j] = with_witness(drive.belts[j], called("belt", j));
    drive.base = with_witness(drive.base, "base");
    for (model::OwnState& state : drive.states) state.rate = with_witness(state.rate, "states." + state.name + ".rate");
    for (model::WantedEvent& event : drive.events) {
        event.when = with_witness(event.when, event.name.empty() ? "an event" : "the event " + event.name);
    }
    return drive;
}

UnderOath::UnderOath(const model::Oscillator& system, const model::Drive& drive)
    : witnesses_(drive.states.size()),
      system_(system),
      drive_(witnesses_.with_witness(drive, [](const char* what, std::size_t) { return std::string(what); })) {
    model::OscillatorParameters parameters = system.parameters();
    const auto with_witness = [this](const char* who, const char* argument) {
        return [=, this](const auto& function) { return witnesses_.with_witness(function, who, argument); };
    };
    if (parameters.friction)
        parameters.friction = model::with_functions(*parameters.friction, with_witness("friction", "speed"));
    parameters.spring = model::with_functions(parameters.spring, with_witness("spring", "theta"));
    if (!has_functions(system)) return;
    if (auto made = model::Oscillator::make(parameters)) system_ = *made;
}

void Witnesses::repeat_others_after(Witness& writer) {
    if (writer.read() != nullptr) return;
    for (const bool last : {false, true}) {
        if (!writer.repeat_end(last)) return;
        for (const auto& reader : witnesses_) {
            if (reader.get() == &writer) continue;
            if (!reader->repeat_end(false) || !reader->repeat_end(true)) return;
        }
    }
}

std::optional<model::Contradiction> Witnesses::verdict(bool whole) {
    if (whole) {
        for (const auto& witness : witnesses_) witness->repeat_kept();
        for (const auto& writer : witnesses_) repeat_others_after(*writer);
    }
    testimony_->over = true;
    return testimony_->found;
}

namespace {

bool has_functions(const model::Drive& drive) {
    const auto has = [](const model::Excitation& one) { return one.has_script(); };
    return std::ranges::any_of(drive.loads, has) || std::ranges::any_of(drive.belts, has) || drive.base.has_script() ||
           !drive.states.empty() || !drive.events.empty();
}

}  // namespace

bool has_functions(const model::Oscillator& system, const model::Drive& drive) {
    return has_functions(system) || has_functions(drive);
}

bool has_functions(const model::System& system, const model::Drive& drive) {
    const auto has = [](const model::Joint& joint) {
        return !joint.friction.is_constant() || model::user_law(joint.friction.law) != nullptr ||
               joint.spring.as<model::springs::UserSpring>() != nullptr;
    };
    return std::ranges::any_of(system.joints, has) || has_functions(drive);
}

}  // namespace dinal::motion
