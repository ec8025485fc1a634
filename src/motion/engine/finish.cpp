#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "motion/engine/engine.hpp"
#include "motion/engine/noise.hpp"

namespace dinal::motion::engine {

using model::Joint;
using model::Motion;
using model::Outcome;

/// Reports user events that pass zero right at the end of the window. Returns false if one of them ends the run.
bool Engine::handle_events_at_end() {
    if (problem_.drive.events.empty() || outcome_ != Outcome::reached_end) return true;
    const auto passing = users_.passing(now_, segment_, pace_.h, *balances_, frames_->of(now_.mode));
    return passing.empty() || act_all(passing);
}

void Engine::finish() {
    if (outcome_ == Outcome::unresolved || outcome_ == Outcome::chattering) explain_end();
    const bool stands_at_now = outcome_ != Outcome::excitation_not_finite && outcome_ != Outcome::unresolved;
    SampledLoads sampled(mechanics_, segment_);
    if (stands_at_now) rows_at_end(sampled);
    if (outcome_ == Outcome::reached_end) outcome_ = at_rest().value_or(outcome_);
    if (now_.mode.friction[0].way != Motion::stuck && !now_.mode.holds(0))
        result_.motion_at_stop = now_.mode.friction[0].way;
    if (!now_.rubs(0) && now_.mode.leans[0] == 0) result_.motion_at_stop = recorder_->heading()[0];
    if (now_.mode.friction[0].creeps != Motion::stuck) result_.motion_at_stop = now_.mode.friction[0].creeps;
    result_.outcome = outcome_;
    result_.located = conditions_->any();
    const bool lost = outcome_ == Outcome::unresolved || outcome_ == Outcome::chattering;
    result_.noise = lost ? 0 : solver_->noise().notable(problem_.tolerance);
    Walls::keep_within(problem_.system, now_.y);  // near a wall the stored distance has digits that theta lacks
    result_.t_start = problem_.window.start;
    result_.t_stop = now_.t.hi;
    auto carry = std::make_shared<Carry>();
    carry->y = now_.y, carry->low = now_.low, carry->mode = now_.mode, carry->watches = users_.watches(),
    carry->echoes = breaks_.echoes(), carry->heading = recorder_->heading(), carry->born = pace_.born,
    carry->floor = solver_->noise().floor();
    if (breaks_.longest_delay() > 0 || !problem_.joined_elsewhere) carry->past = recorder_->history();
    for (const Signal& load : mechanics_.loads()) carry->controllers.push_back(load.memory());
    recorder_->finish(now_, contacts_, std::move(carry));
}

/// Writes the rows at the end. If a load jumps there, the rows show the contacts after the jump, as in a longer run.
/// If a belt jumps there, bodies that stick to it still have its velocity from before the jump.
void Engine::rows_at_end(SampledLoads& sampled) {
    const bool is_break = segment_.to_break && now_.t.hi >= problem_.window.end;
    if (outcome_ != Outcome::reached_end || !is_break || mechanics_.has_belts()) {
        recorder_->rows_at_end({now_, segment_, frames_->of(now_.mode), *balances_, sampled});
        return;
    }
    const Evaluation by{mechanics_, *frames_, *balances_, projection_, conditions_->slides(),
                        segment_,   room_,    pace_.unit};
    Decision made = engine::decide(by, Now(now_), Contacts(contacts_), {.reports = false});
    const Now& then = made.good ? made.now : now_;
    recorder_->rows_at_end({then, segment_, frames_->of(then.mode), *balances_, sampled});
}

/// Returns the outcome if nothing moves at the end except on belts to which it is stuck, otherwise empty.
std::optional<Outcome> Engine::at_rest() {
    const Frame& present = frames_->of(now_.mode);
    bool still = true, for_good = !mechanics_.samples_functions() && !problem_.joined_elsewhere;
    for (std::size_t i = 0; i < n(); ++i) {
        const auto& joints = problem_.system.joints;
        bool rides = problem_.joined_elsewhere;
        for (std::size_t j = 0; j < joints.size() && !rides; ++j) {
            rides = mechanics_.has_belt(j) && now_.mode.holds(j) && joints[j].of.size() == 1 && joints[j].first() == i;
        }
        const bool stands = now_.y[n() + i] == 0;
        still = still && present.bodies[i].empty() && (stands || rides);
        for_good = for_good && stands;
    }
    if (!still) return {};
    mechanics_.for_each_signal([&](const Signal& s) { for_good = for_good && s.constant_from() <= now_.t.hi; });
    for_good = for_good && mechanics_.states() == mechanics_.states_of_user();
    for (const model::WantedEvent& event : problem_.drive.events) for_good = for_good && event.act == nullptr;
    for (const Joint& joint : problem_.system.joints) {
        for_good = for_good && (joint.friction.function == nullptr || joint.friction.holding[0]);
    }
    return for_good ? Outcome::at_rest : Outcome::stuck_at_end;
}

/// Reports a function that is rough on every scale as the cause of a run that could not advance.
void Engine::explain_end() {
    const double most = std::min({pace_.unit, problem_.window.end - now_.t.hi, breaks_.shortest_delay()});
    const double from = now_.t.hi, length = std::min(rough_stretch * pace_.unit, most / 8);
    struct Source {
        std::string name;
        std::function<double(double)> value;
        double beside;  ///< magnitude of the quantity to which it is added
    };
    std::vector<Source> sources;
    const auto of = [&](const char* what, const std::string& who) {
        return problem_.system.named ? fmt::format("{} of {}", what, who) : std::string(what);
    };
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        const auto load = [this, i](double t) { return mechanics_.load(i, {t, Side::at, now_.y}); };
        sources.push_back({of("M", problem_.system.joints[i].name), load, mechanics_.size_of(i, now_.here())});
    }
    sources.push_back({"the base", [&](double t) { return mechanics_.base(t, Side::at); }, 0});
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!mechanics_.has_belt(j)) continue;
        const auto belt = [this, j](double t) { return mechanics_.belt(j, t, Side::at); };
        sources.push_back({of("the belt", problem_.system.joints[j].name), belt, 0});
    }
    std::vector<double> rates(mechanics_.states());
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) {
        const auto rate = [this, k, &rates](double t) {
            mechanics_.rates({t, Side::at, now_.y}, rates.data());
            return rates[k];
        };
        sources.push_back({"the rate of " + problem_.drive.states[k].name, rate, 0});
    }
    double worst = 64 * rounding;
    for (const Source& source : sources) {
        const Roughness look = roughness(source.value, {from, from + 2 * length, from + 5 * length}, length);
        const double part = look.most / (look.size + source.beside);
        const double slope = std::fabs(source.value(from + length) - source.value(from)) / length;
        const bool is_rounding = look.most <= 16 * rounding * std::fabs(from) * slope;  // rounding of the time
        if (!look.is_noise() || is_rounding || !(part > worst)) continue;
        worst = part;
        result_.rough = Rough{source.name, look.most, part};
        outcome_ = Outcome::unresolved;
    }
    const std::string state = result_.rough ? "" : state_driven_back();
    if (state.empty()) return;
    result_.rough = Rough{"the rate of " + state};
    outcome_ = Outcome::chattering;
}

/// Returns the name of a state that is stuck where its rate jumps, because both sides drive it back; empty if there is
/// none.
std::string Engine::state_driven_back() {
    constexpr double near = 1e-9, steep = 1e6;
    mechanics_.for_each_piecewise(now_.t.hi, [](Piecewise& function) { function.let_go(); });
    std::vector<double> y = now_.y, rates(mechanics_.states());
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) {
        const auto rate = [&](double by) {
            y[2 * n() + k] = now_.y[2 * n() + k] + by;
            mechanics_.rates({now_.t.hi, now_.side(), y}, rates.data());
            return rates[k];
        };
        const double own = std::max(std::fabs(rate(0)), std::fabs(rate(near * std::fabs(now_.y[2 * n() + k]))));
        const double d =
            near * std::max(own * pace_.unit, std::fabs(now_.y[2 * n() + k])) + std::numeric_limits<double>::min();
        const double least = std::min(-rate(d), rate(-d));
        y[2 * n() + k] = now_.y[2 * n() + k];
        if (least * pace_.unit > steep * d) return problem_.drive.states[k].name;
    }
    return {};
}

}  // namespace dinal::motion::engine
