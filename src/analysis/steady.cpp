#include "analysis/steady.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "analysis/fixed_point.hpp"
#include "analysis/sine/short_slides.hpp"
#include "analysis/steady_facts.hpp"
#include "model/controller.hpp"
#include "model/lowered.hpp"
#include "motion/engine/part.hpp"

namespace dinal::analysis {
namespace {

class SteadySearch {
public:
    SteadySearch(const SteadyQuestion& question, const motion::Monitor& monitor)
        : question_(question),
          system_(question.body),
          monitor_(monitor),
          map_(question.body, question.drive.M(), question.repeats.start, question.repeats.period, monitor),
          half_(map_, question.repeats.period / 2) {
        symmetric_ = is_alike_both_ways(question);
        contracts_ = contracts(question);
    }

    SteadyMotion found() {
        const Place start = inside(question_.body, place_of(question_.drive.start(), map_.omega()));
        answer_.period = question_.repeats.period;
        if (const double growth = resonant_growth(); growth > 0) return growing(start, growth);
        if (question_.periods > 1) {
            if (!search_multiple(start, question_.periods, true)) answer_.status = SteadyStatus::none;
        } else if (question_.periods == 1 || contracts_) {
            const bool found = (contracts_ && symmetric_ && follows_sine()) || search_once(start, symmetric_) ||
                               search_once(start, false);
            if (!found) brute(start, 1);
        } else {
            brute(start, longest_);
        }
        return answer_;
    }

    SteadyMotion found_near() {
        const Place start = inside(question_.body, place_of(question_.drive.start(), map_.omega()));
        answer_.period = question_.repeats.period;
        if (resonant_growth() > 0) return found();
        if (contracts_ && symmetric_ && follows_sine()) return answer_;
        if (search_once(start, symmetric_) && answer_.stable) return answer_;
        return found();
    }

    /// The answer; status none if M contradicted itself.
    SteadyMotion judged(SteadyMotion motion) const {
        for (const auto* found : {&contradiction_, &map_.contradiction(), &half_.contradiction()}) {
            if (!*found) continue;
            motion.contradiction = *found;
            motion.outcome = model::Outcome::not_a_function;
            motion.status = SteadyStatus::none;
        }
        return motion;
    }

private:
    using Try = FixedPointSearch::Try;

    /// The growth in each natural period without viscous damping: a harmonic of M at the natural frequency adds pi
    /// |M_n| / k, and friction takes 2 (Rd forward + Rd backward) / k.
    [[nodiscard]] double resonant_growth() const {
        const model::Oscillator& system = question_.body;
        if (system.damping() != 0 || !(system.stiffness() > 0)) return 0;
        if (system_.has_remainder() || system.walls() || question_.drive.M().has_feedback()) return 0;
        const double ratio = question_.repeats.period / system.natural_period(), n = std::round(ratio);
        if (n < 1 || std::fabs(ratio - n) > 1e-12 * n) return 0;
        const double fed = std::numbers::pi * std::abs(harmonic_of(question_.drive.M(), question_.repeats, n));
        const double taken = 2 * (system_.braking(model::Motion::forward) - system_.braking(model::Motion::backward));
        const double growth = n * (fed - taken) / system.stiffness();
        const double most = question_.drive.M().most();
        const double rounding = 1e-9 * n * (std::isfinite(most) ? most : fed) / system.stiffness();
        return growth > rounding ? growth : 0;
    }

    SteadyMotion growing(const Place& start, double growth) {
        constexpr int periods = 30;  // within which friction may have stopped it for good
        Place x = start;
        MapStep step = map_(x);
        for (int i = 0; i < periods && step.finished && step.moved; ++i) {
            step = map_(x = step.to);
            ++answer_.maps;
        }
        if (step.finished && !step.moved) {
            settle(FixedPointSearch(map_, 1, answer_.maps).at(x, 0), map_, 1, false);
            return answer_;
        }
        answer_.status = SteadyStatus::grows;
        answer_.growth = growth;
        answer_.outcome = step.outcome;
        return answer_;
    }

    /// Under a single sine, closed forms between events give a start that one period confirms; a motion too small for
    /// that is computed in closed form.
    bool follows_sine() {
        const auto own = sine::single_sine(question_);
        if (!own) return false;
        if (const auto slides = sine::ShortSlides::of(question_)) {
            answer_ = slides->motion(question_);
            return true;
        }
        const auto start = sine::sine_start(*own);
        if (!start) return false;
        const auto found = FixedPointSearch(half_, -1, answer_.maps).confirmed(place_of(*start, half_.omega()));
        return found && found->step.moved && settle(*found, half_, 1, true);
    }

    /// Searches over one period of M, or over half of it if M and friction are antisymmetric.
    bool search_once(const Place& start, bool half) {
        const PeriodMap& map = half ? half_ : map_;
        const auto found = FixedPointSearch(map, half ? -1 : 1, answer_.maps).search(start, 60);
        return found && (!half || repeats(*found)) && settle(*found, map, 1, half);
    }

    /// A function's antisymmetry was only sampled: a whole period verifies it.
    bool repeats(const FixedPointSearch::Try& found) {
        if (std::isfinite(question_.drive.M().most())) return true;
        const MapStep whole = map_(found.x);
        ++answer_.maps;
        const double alike = std::max(1e-9 * found.size, 4 * found.rounding);
        return whole.finished && length_of(whole.to - found.x) <= alike && std::fabs(whole.high + whole.low) <= alike;
    }

    bool search_multiple(const Place& start, int periods, bool any) {
        const PeriodMap map(question_.body, question_.drive.M(), question_.repeats.start,
                            periods * question_.repeats.period, monitor_);
        const auto found = FixedPointSearch(map, 1, answer_.maps).search(start, any ? 40 : 12);
        const bool good = found && (any || length_of(found->x - start) <= 0.2 * found->size);
        const bool settled = good && settle(*found, map, periods, false);
        if (map.contradiction()) contradiction_ = map.contradiction();
        return settled;
    }

    /// The edge of the resting range, for a motion that would creep up to it for ever.
    [[nodiscard]] std::optional<Place> rest_beside(const Place& x, const MapStep& step) const {
        const double k = system_.stiffness(), size = system_.greatest_holding() / k;
        if (!question_.body.has_linear_spring() || !(step.high - step.low <= 1e-8 * size) ||
            question_.drive.M().has_feedback()) {
            return {};
        }
        const auto [low, high] = rest_of(question_, x[0]);
        const double inside = std::max(1e-15 * std::max(std::fabs(low), std::fabs(high)), map_.rounding());
        return Place(std::clamp(x[0], std::min(low + inside, high), std::max(high - inside, low)), 0);
    }

    /// Completes the answer for the motion through a fixed point of a map.
    bool settle(FixedPointSearch::Try last, const PeriodMap& map, int periods, bool half) {
        if (const auto rest = last.step.moved ? rest_beside(last.x, last.step) : std::nullopt) {
            const FixedPointSearch::Try still = FixedPointSearch(map_, 1, answer_.maps).at(*rest, 0);
            if (!still.step.moved) return settle(still, map_, 1, false);
        }
        answer_.outcome = last.step.outcome;
        if (!last.step.finished || !last.at(1e-6)) return false;
        const int maps = answer_.maps;
        answer_ = facts_of(question_, map, last, periods, half);
        answer_.maps = maps;
        answer_.symmetric = half || (periods == 1 && is_symmetric(last.x, last.size));
        if (!last.step.moved) {
            answer_.rest = rest_of(question_, last.x[0]);
            if (answer_.rest.first < answer_.rest.second) answer_.unique = false;
        }
        return true;
    }

    [[nodiscard]] bool is_symmetric(const Place& x, double size) {
        const MapStep step = half_(x);
        ++answer_.maps;
        return step.finished && length_of(step.to + x) <= std::max(1e-8 * size, 4 * half_.rounding());
    }

    /// Runs the motion until it returns after some periods, or grows.
    void brute(const Place& start, int longest) {
        std::vector<Place> places{start};
        std::vector<double> sizes{length_of(start)};
        for (const std::size_t until : {40U, 120U, 320U}) {
            while (places.size() <= until) {
                const MapStep step = map_(places.back());
                ++answer_.maps;
                answer_.outcome = step.outcome;
                if (!step.finished) {
                    grows(sizes, step.outcome == model::Outcome::state_not_finite);
                    return;
                }
                places.push_back(step.to);
                sizes.push_back(std::max({std::fabs(step.low), std::fabs(step.high), length_of(step.to)}));
            }
            for (const double near : {1e-5, 3e-2}) {
                if (recurs(places, sizes.back(), longest, near, true)) return;
            }
        }
        // Near resonance a beat may be as slow as unbounded growth.
        if (is_bounded() && symmetric_ && follows_sine() && answer_.stable) return;
        if (!is_bounded() && grows(sizes, false)) return;
        // No approach was seen; it may be slow, and an unstable motion is better than none.
        for (const double near : {1e-5, 3e-2}) {
            if (recurs(places, sizes.back(), longest, near, false)) return;
        }
        const int maps = answer_.maps;
        if (search_once(places.back(), symmetric_) || search_once(places.back(), false)) return;
        answer_.maps = std::max(answer_.maps, maps);
        answer_.status = SteadyStatus::none;
    }

    bool recurs(const std::vector<Place>& places, double size, int longest, double near, bool approaching) {
        const Place& last = places.back();
        const auto is_it = [&](int m) {
            return answer_.stable && (approaching ? approaches(places, m, size) : is_near(last, 0.2 * size));
        };
        int tries = 0;  // chaotic motions come near to themselves repeatedly
        for (int m = 1; tries < 5 && m <= longest && static_cast<std::size_t>(m) < places.size(); ++m) {
            if (length_of(last - places[places.size() - 1 - static_cast<std::size_t>(m)]) > near * size) continue;
            ++tries;
            if (m == 1 && symmetric_ && search_once(last, true) && is_it(m)) return true;
            if (!search_multiple(last, m, false) || !is_it(m)) continue;
            reduce(m);
            return true;
        }
        return false;
    }
    /// Accepts Newton's result only if the run keeps approaching it, as other motions may exist nearby.
    [[nodiscard]] bool approaches(const std::vector<Place>& places, int m, double size) const {
        const std::size_t last = places.size() - 1, period = static_cast<std::size_t>(m);
        const std::size_t back = period * std::max<std::size_t>(1, last / (2 * period));
        const Place found = place_of(answer_.start, map_.omega());
        constexpr double there = 1e-6, nearer = 0.7;
        const double now = length_of(found - places.back());
        return now <= there * size || now <= nearer * length_of(found - places[last - back]);
    }
    /// Reduces m to the smallest number of periods after which the motion returns.
    void reduce(int m) {
        const SteadyMotion whole = answer_;
        const Place x = place_of(whole.start, map_.omega());
        const double size = std::max({std::fabs(whole.low), std::fabs(whole.high), length_of(x)});
        const double beside = 0.01 * size;
        for (int n = 1; n <= m / 2; ++n) {
            if (m % n != 0) continue;
            const PeriodMap map(question_.body, question_.drive.M(), question_.repeats.start,
                                n * question_.repeats.period, monitor_);
            const MapStep step = map(x);
            ++answer_.maps;
            if (!step.finished || length_of(step.to - x) > 1e-6 * size) continue;
            const bool found =
                n > 1 ? search_multiple(x, n, false)
                      : (symmetric_ && search_once(x, true) && is_near(x, beside)) || search_once(x, false);
            if (found && is_near(x, beside)) return;
            answer_ = whole;
        }
    }
    [[nodiscard]] bool is_near(const Place& place, double distance) const {
        return length_of(place_of(answer_.start, map_.omega()) - place) <= distance;
    }

    /// Returns whether motions are bounded: a linear spring off resonance, and friction that only dissipates.
    [[nodiscard]] bool is_bounded() const {
        return !system_.has_remainder() && !question_.body.walls() && !question_.drive.M().has_feedback() &&
               question_.body.stiffness() > 0 && question_.body.damping() >= 0;
    }

    bool grows(const std::vector<double>& sizes, bool overflow) {
        const std::size_t n = sizes.size();
        constexpr std::size_t span = 20;
        if (n < 3 * span) {
            if (overflow) answer_.status = SteadyStatus::grows;
            answer_.growth = overflow && n > 1 ? sizes[n - 1] - sizes[n - 2] : 0;
            return overflow;
        }
        const double last = sizes[n - 1] - sizes[n - 1 - span], before = sizes[n - 1 - span] - sizes[n - 1 - 2 * span];
        // Steady growth from zero doubles between half time and end; bounded wandering does not.
        const bool keeps_growing = before > 0 && last >= 0.9 * before && last > 1e-3 * sizes[n - 1];
        if (!overflow && !(keeps_growing && sizes[n - 1] >= 1.3 * sizes[n / 2])) return false;
        answer_.status = SteadyStatus::grows;
        answer_.growth = last / static_cast<double>(span);
        return true;
    }

    static constexpr int longest_ = 32;
    const SteadyQuestion& question_;
    model::Lowered system_;
    const motion::Monitor& monitor_;
    PeriodMap map_, half_;
    bool symmetric_ = false, contracts_ = false;
    std::optional<model::Contradiction> contradiction_;
    SteadyMotion answer_;
};

}  // namespace

text::Expected<SteadyQuestion> SteadyQuestion::of(model::SystemHandle system, model::Drive drive,
                                                  std::optional<std::size_t> joint) {
    if (system->has_moved()) {
        return text::Error{"a body is moved by its theta or velocity: simulate does that, steady motions do not yet"};
    }
    auto body = model::oscillator_at(*system, joint.value_or(0));
    if (!body) return body.error();
    return SteadyQuestion{
        .system = std::move(system), .drive = std::move(drive), .body = std::move(body).value(), .joint = joint};
}

SteadyQuestion SteadyQuestion::of(const model::Oscillator& body, model::Drive drive, const Repetition& repeats) {
    return {.system = std::make_shared<const model::System>(model::as_system(body)),
            .drive = std::move(drive),
            .body = body,
            .repeats = repeats};
}

SteadyQuestion SteadyQuestion::seen_at(std::size_t which) const {
    SteadyQuestion own = *this;
    own.joint = which;
    own.body = model::oscillator_at(*system, which).value();
    return own;
}

const model::Excitation& SteadyQuestion::load() const {
    static const model::Excitation nothing;
    if (is_plain()) return drive.M();
    if (!joint || system->is_link(*joint)) return nothing;
    const model::Excitation& own = drive.loads[*joint];
    return own.has_feedback() || model::has_memory(own) ? nothing : own;
}

SteadyMotion steady_motion(const SteadyQuestion& question, const motion::Monitor& monitor) {
    const bool waits = model::has_memory<model::DelayedController>(question.drive.M());
    const bool returns = !question.is_plain() || waits || question.is_timeless() || question.drive.has_more();
    if (returns) return returning_motion(question, monitor);
    SteadySearch search(question, monitor);
    SteadyMotion motion = search.judged(search.found());
    if (model::has_memory(question.drive.M()) && !goes_on(question, motion, monitor) &&
        motion.outcome != model::Outcome::interrupted) {
        return returning_motion(question, monitor);
    }
    return motion;
}

SteadyMotion steady_motion_near(const SteadyQuestion& question, const motion::Monitor& monitor) {
    const bool plain = question.is_plain() && !question.is_timeless() && !question.drive.has_more();
    if (!plain || model::has_memory(question.drive.M())) return steady_motion(question, monitor);
    SteadySearch search(question, monitor);
    return search.judged(search.found_near());
}

namespace {

/// Returns whether the motions are equal or mirror images.
bool are_alike(const SteadyMotion& a, const SteadyMotion& b, double size) {
    if (a.stands() && b.stands()) {
        const double within = 1e-6 * size;
        return b.start.theta >= a.rest.first - within && b.start.theta <= a.rest.second + within;
    }
    if (a.status != b.status) return false;
    if (a.status != SteadyStatus::steady) return true;
    const double apart =
        std::fabs(std::fabs(a.high) - std::fabs(b.high)) + std::fabs(std::fabs(a.low) - std::fabs(b.low));
    return std::fabs(a.amplitude - b.amplitude) <= 1e-6 * size && apart <= 2e-6 * size;
}

/// Questions with starts around the motion.
std::vector<SteadyQuestion> questions_around(const SteadyQuestion& question, const SteadyMotion& known, double size) {
    const double period = known.period > 0 ? known.period : 2 * std::numbers::pi;
    const double omega =
        question.body.stiffness() > 0 ? question.body.natural_frequency() : 2 * std::numbers::pi / period;
    // At resonance a motion may be far larger than the one found, and the mass may also adhere.
    const bool asks = question.drive.M().has_feedback() || question.is_timeless();
    const auto M = asks ? TorqueRange{} : extremes(question.drive.M(), question.repeats);
    const double stiff = question.body.inertia() * omega * omega;
    const double soft = std::max(question.body.damping() * omega, 0.01 * stiff);
    const double widest = std::max(2.5 * size, (M.high - M.low) / 2 / soft);
    std::vector<SteadyQuestion> questions(other_starts, question);
    for (int i = 0; i < other_starts; ++i) {
        const auto spot = i == 0 ? (M.high + M.low) / 2 / stiff : start_around(i, widest);
        const Place start = inside(question.body, Place(spot.real(), spot.imag()));
        SteadyQuestion& other = questions[static_cast<std::size_t>(i)];
        other.periods = 0;
        other.drive.start_at({start[0], start[1] * omega});
    }
    return questions;
}

}  // namespace

namespace {

/// For one plain body.
std::vector<OtherMotion> others_of_one(const SteadyQuestion& question, const SteadyMotion& known,
                                       const motion::Monitor& monitor) {
    const bool family = known.status == SteadyStatus::steady && known.unique.has_value();
    if (!known.is_found() || known.unique.value_or(false) || family) return {};
    double size = std::max({std::fabs(known.low), std::fabs(known.high), std::fabs(known.rest.second), 1e-300});
    // At rest only the initial state indicates the size of motions.
    if (known.stands())
        size = std::max({size, std::fabs(question.drive.start().theta), std::fabs(question.drive.start().velocity)});
    const auto alike = [size](const SteadyMotion& a, const SteadyMotion& b) { return are_alike(a, b, size); };
    return others_from(questions_around(question, known, size), known, alike, monitor);
}

/// For all bodies.
std::vector<OtherMotion> others_of_all(const SteadyQuestion& question, const SteadyMotion& known,
                                       const motion::Monitor& monitor) {
    const bool alone = known.unique.has_value() && known.status == SteadyStatus::steady;
    if (!known.is_found() || alone) return {};
    const std::size_t n = question.system->bodies.size();
    const auto farthest = [](const BodyMotion& body) { return std::max(std::fabs(body.high), std::fabs(body.low)); };
    double size = 1e-300;
    for (std::size_t i = 0; i < n; ++i) {
        const BodyMotion& body = known.bodies[i];
        const double speed = known.period == 0 ? std::fabs(body.turned) : 0;
        size = std::max({size, body.high - body.low, farthest(body), speed});
        if (!known.stands()) continue;
        size = std::max({size, std::fabs(question.drive.theta0[i]), std::fabs(question.drive.velocity0[i])});
    }
    const auto alike = [&](const SteadyMotion& a, const SteadyMotion& b) {
        if (a.stands() && b.stands()) return true;
        if (a.status != b.status) return false;
        const auto moves_alike = [&](const BodyMotion& x, const BodyMotion& y) {
            return std::fabs((x.high - x.low) - (y.high - y.low)) <= 1e-4 * size &&
                   std::fabs(farthest(x) - farthest(y)) <= 1e-4 * size &&
                   std::fabs(x.turned - y.turned) <= 1e-4 * std::fabs(x.turned);
        };
        return a.status != SteadyStatus::steady ||
               std::equal(a.bodies.begin(), a.bodies.end(), b.bodies.begin(), moves_alike);
    };
    const double period = known.period > 0 ? known.period : 2 * std::numbers::pi;
    std::vector<SteadyQuestion> questions(other_starts, question);
    for (int s = 0; s < other_starts; ++s) {
        SteadyQuestion& other = questions[static_cast<std::size_t>(s)];
        other.periods = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const auto spot = start_around(s, 2.5 * size, i);
            double& theta = other.drive.theta0[i];
            theta = spot.real();
            if (const auto& walls = question.system->joints[i].walls) {
                theta = std::clamp(theta, walls->lower, walls->upper);
            }
            other.drive.velocity0[i] = spot.imag() * 2 * std::numbers::pi / period;
        }
        const auto crosses = [&](const model::Joint& joint) {
            if (!joint.walls || joint.of.size() == 1) return false;
            return joint.walls->crossed_by(joint.sum(other.drive.theta0)).has_value();
        };
        if (std::any_of(question.system->joints.begin(), question.system->joints.end(), crosses)) {
            other.drive.theta0 = question.drive.theta0;
        }
    }
    return others_from(questions, known, alike, monitor);
}

}  // namespace

std::vector<OtherMotion> other_motions(const SteadyQuestion& question, const SteadyMotion& known,
                                       const motion::Monitor& monitor) {
    return question.is_plain() ? others_of_one(question, known, monitor) : others_of_all(question, known, monitor);
}

}  // namespace dinal::analysis
