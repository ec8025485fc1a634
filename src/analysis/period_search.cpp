// The search on the period map of one plain body that is linear between events.
#include "analysis/period_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/forced_search.hpp"
#include "analysis/single_sine.hpp"
#include "analysis/steady_facts.hpp"

namespace dinal::analysis {
namespace {

class PeriodSearch final : public ForcedSearch {
public:
    PeriodSearch(const SteadyQuestion& question, const motion::Monitor& monitor)
        : question_(question),
          system_(question.body),
          monitor_(monitor),
          symmetric_(is_symmetric_problem(question)),
          start_(inside(question.body, (symmetric_ ? half() : whole()).place(question.drive.start()))) {}

    SteadyMotion found(bool near) {
        facts_.period = question_.repeats.period;
        const double growth = resonant_growth();
        if (growth > 0) {
            grow(growth);
        } else {
            look(contracts(question_), near);
        }
        for (const std::optional<PeriodMap>* map : {&whole_, &half_}) {
            if (*map && (*map)->contradiction()) contradiction_ = (*map)->contradiction();
        }
        if (contradiction_) {
            facts_.contradiction = contradiction_;
            facts_.outcome = model::Outcome::not_a_function;
            facts_.status = SteadyStatus::none;
        }
        return std::move(facts_);
    }

private:
    PeriodMap& whole() {
        if (!whole_) whole_.emplace(question_, 1, monitor_);
        return *whole_;
    }
    PeriodMap& half() {
        if (!half_) half_.emplace(PeriodMap::half(question_, monitor_));
        return *half_;
    }
    Map& map() override { return whole(); }

    std::optional<Map::Return> begin() override { return measured_at(start_); }
    std::optional<Map::Return> measured(const Map::Return& from) override {
        return measured_at(whole().place(from.to));
    }
    std::optional<Map::Return> measured_at(const Place& place) {
        const Map::Return first = whole().measured(place);
        facts_.outcome = first.outcome;
        if (first.outcome == model::Outcome::state_not_finite) facts_.status = SteadyStatus::grows;
        if (!first.finished) return {};
        const MapStep step = whole().step(place);
        range_ = step.high - step.low;
        return first;
    }
    double range() const override { return range_; }
    double size_at(const Map::Return& at) const override { return length_of(whole_->place(at.to)); }
    bool complete(const Closed& found, bool any) override {
        const Place x = whole().place(found.x);
        if (found.returns == 1) return settle(whole(), x, 1, any);
        PeriodMap longer(question_, found.returns, monitor_);
        const bool settled = settle(longer, x, found.returns, any);
        if (longer.contradiction()) contradiction_ = longer.contradiction();
        return settled;
    }
    bool is_bounded() const override {
        return system_.stiffness() > 0 && system_.damping() >= 0 && !question_.body.walls();
    }

    void look(bool contracting, bool near) {
        const bool at_once = contracting || near, halves = question_.periods <= 1 && symmetric_;
        if (halves && at_once && found_by_half(start_, contracting)) return;
        const auto last = search(question_, at_once);
        if (!last) return;
        // Near resonance a beat may be slower than the whole search.
        if (halves && is_bounded() && found_by_half(whole().place(last->to), true)) return;
        look_beside(*last, question_.periods);
    }

    bool is_free() const override { return !(system_.stiffness() > 0) && !question_.body.walls(); }

    /// The growth per natural period without viscous damping: a harmonic of M at the natural frequency adds pi |M_n| /
    /// k, and friction takes 2 (Rd forward + Rd backward) / k.
    double resonant_growth() const {
        const model::Oscillator& system = question_.body;
        if (system.damping() != 0 || !(system.stiffness() > 0) || system.walls()) return 0;
        const double ratio = question_.repeats.period / system.natural_period(), n = std::round(ratio);
        if (n < 1 || std::fabs(ratio - n) > 1e-12 * n) return 0;
        const double fed = std::numbers::pi * std::abs(harmonic_of(question_.drive.M(), question_.repeats, n));
        const double taken = 2 * (system_.braking(model::Motion::forward) - system_.braking(model::Motion::backward));
        const double growth = n * (fed - taken) / system.stiffness();
        const double most = question_.drive.M().most();
        const double rounding = 1e-9 * n * (std::isfinite(most) ? most : fed) / system.stiffness();
        return growth > rounding ? growth : 0;
    }

    void grow(double growth) {
        constexpr int periods = 30;  // in this time friction may stop the mass for good
        Place x = start_;
        MapStep step = whole().step(x);
        for (int i = 0; i < periods && step.finished && step.moved; ++i) {
            x = step.to;
            step = whole().step(x);
            ++facts_.maps;
        }
        if (step.finished && !step.moved && settle(whole(), x, 1, true)) return;
        facts_.status = SteadyStatus::grows;
        facts_.growth = growth;
        facts_.outcome = step.outcome;
    }

    /// Searches a symmetric motion of a symmetric problem over half a period. Under a single sine, closed forms between
    /// events give a start that one run confirms; a motion too small for runs has a map in closed form.
    bool found_by_half(const Place& from, bool by_sine) {
        if (const auto slides = by_sine ? ShortSlides::closed(question_) : std::nullopt) {
            const int maps = facts_.maps;
            facts_ = slides->motion(question_);
            facts_.maps = maps;
            judge(question_, slides->multipliers(), {.error = 0}, facts_);
            return true;
        }
        const auto sine = by_sine ? single_sine(question_) : std::nullopt;
        const auto start = sine ? sine_start(*sine) : std::nullopt;
        const Map::Return first = half().measured(start ? half().place(*start) : from);
        if (!first.finished) return false;
        const auto found = ClosedSearch(half(), facts_.maps, 1).at_once(first, 1, true);
        if (!found) return false;
        const Place x = half().place(found->x);
        return repeats(x) && settle(half(), x, 1, false);
    }

    /// Verifies antisymmetry over a whole period, because that of a function was only sampled.
    [[nodiscard]] bool repeats(const Place& x) {
        if (std::isfinite(question_.drive.M().most())) return true;
        const MapStep step = whole().step(x);
        ++facts_.maps;
        const double alike = std::max(1e-9 * PeriodMap::size_of(x, step), 4 * whole().rounding_of_place());
        return step.finished && length_of(step.to - x) <= alike && std::fabs(step.high + step.low) <= alike;
    }

    /// Completes the answer for the motion through a fixed point of a map over this number of periods.
    bool settle(PeriodMap& map, const Place& x, int periods, bool any) {
        MapStep step = map.step(x);
        if (const auto rest = step.moved ? rest_beside(x, step) : std::nullopt) {
            if (!whole().step(*rest).moved) return stand(rest_of_run().value_or(*rest));
        }
        // Newton's method may end at any of the places where the mass may rest.
        if (!step.moved) return stand(rest_of_run().value_or(x));
        facts_.outcome = step.outcome;
        if (!step.finished) return false;
        if (step.has_corner) {
            step.differentiable = false;
        } else if (!step.differentiable) {
            const Map::Return first = map.measured(x);
            if (const auto D = map.derivative(first.to, {}, 1, 2)) {
                step.derivative = map.is_half() ? -D->by_place : D->by_place;
                step.differentiable = true;
            }
        }
        const int maps = facts_.maps;
        SteadyMotion motion = facts_of(question_, map, step, x, periods);
        if (!motion.stable && !any) return false;
        facts_ = std::move(motion);
        facts_.maps = maps;
        if (!map.is_half()) facts_.symmetric = periods == 1 && is_symmetric(x, PeriodMap::size_of(x, step));
        return true;
    }

    /// Completes the answer for a mass that adheres at this place.
    bool stand(const Place& x) {
        const int maps = facts_.maps;
        facts_ = facts_of(question_, whole(), whole().step(x), x, 1);
        facts_.maps = maps;
        facts_.symmetric = is_symmetric(x, length_of(x));
        facts_.rest = rest_of(question_, x[0]);
        if (facts_.rest.first < facts_.rest.second) facts_.unique = false;
        return true;
    }

    /// The place where a run from the start comes to rest; empty if that takes too long.
    [[nodiscard]] std::optional<Place> rest_of_run() {
        constexpr int periods = 60;
        Place x = start_;
        for (int i = 0; i < periods; ++i) {
            const MapStep step = whole().step(x);
            if (!step.finished) break;
            if (!step.moved) return x;
            x = step.to;
            ++facts_.maps;
        }
        return {};
    }

    /// The edge of the resting range, for a motion that would creep up to it for ever.
    [[nodiscard]] std::optional<Place> rest_beside(const Place& x, const MapStep& step) {
        const double k = system_.stiffness(), size = system_.greatest_holding() / k;
        if (!question_.body.has_linear_spring() || !(step.high - step.low <= 1e-8 * size)) return {};
        const auto [low, high] = rest_of(question_, x[0]);
        const double inside = std::max(1e-15 * std::max(std::fabs(low), std::fabs(high)), whole().rounding_of_place());
        return Place(std::clamp(x[0], std::min(low + inside, high), std::max(high - inside, low)), 0);
    }

    [[nodiscard]] bool is_symmetric(const Place& x, double size) {
        const MapStep step = half().step(x);
        ++facts_.maps;
        return step.finished && length_of(step.to + x) <= std::max(1e-8 * size, 4 * half().rounding_of_place());
    }

    const SteadyQuestion& question_;
    model::Lowered system_;
    const motion::Monitor& monitor_;
    std::optional<PeriodMap> whole_, half_;  // made when needed
    bool symmetric_;
    Place start_;
    double range_ = 0;  // range of theta in the last measured period
    std::optional<model::Contradiction> contradiction_;
};

}  // namespace

SteadyMotion motion_by_periods(const SteadyQuestion& question, bool near, const motion::Monitor& monitor) {
    return PeriodSearch(question, monitor).found(near);
}

}  // namespace dinal::analysis
