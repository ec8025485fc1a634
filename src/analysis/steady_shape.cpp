// The integrals of a steady motion over its period, and its description in sentences.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include "analysis/recurrence.hpp"
#include "analysis/returns.hpp"
#include "analysis/single_sine.hpp"
#include "analysis/steady.hpp"
#include "model/controller.hpp"
#include "model/lowered.hpp"
#include "motion/integrators.hpp"
#include "text/words.hpp"

namespace dinal::analysis {
namespace {

constexpr double least_harmonic = 1e-9;  // smaller harmonics, relative to the whole, have a phase of mere rounding

// The mean and the fundamental of a steady motion from its friction: as k theta + C theta' + I theta'' is M minus
// friction, both follow from the integrals of M and of friction, which is constant during a slide and M - k theta
// during a stick. The motion between events is not needed.

struct Fundamental {
    double mean = 0;            ///< mean of theta
    std::complex<double> wave;  ///< (2/T) times the integral of theta e^(-i omega t), with t from the drive's start
};

/// Returns whether the system is linear except for Coulomb friction, so that by_friction() applies.
bool is_linear_but_for_friction(const SteadyQuestion& question) {
    const model::Lowered system(question.body);
    return question.body.has_linear_spring() && system.stiffness() > 0 && !system.has_remainder() &&
           !question.body.walls() && !question.load().has_feedback();
}

/// Mean and fundamental of theta from a run of one period, or of half a period if symmetric. `M_wave` is the
/// fundamental of M. Requires is_linear_but_for_friction(). Empty if friction nearly cancels M.
std::optional<Fundamental> by_friction(const SteadyQuestion& question, const SteadyMotion& motion,
                                       const motion::Run& run, std::complex<double> M_wave) {
    const model::Lowered system(question.body);
    const Repetition& repeats = question.repeats;
    const double omega = 2 * std::numbers::pi / repeats.period, length = run.t_stop - run.t_start;
    const auto wave = [&](double t) { return std::polar(1.0, -omega * (t - repeats.start)); };
    double sum = 0;
    std::complex<double> sum_wave;
    for (const Stretch& s : stretches(run)) {
        if (!(s.lasts() > 0)) continue;
        const std::complex<double> between =
            (wave(s.to) - wave(s.from)) * std::complex<double>(0, 1 / omega);  // integral of e^(-i omega t)
        if (s.stuck) {
            const double held = -system.stiffness() * s.begin.theta;
            const double piece = std::min(repeats.period / 64, s.lasts() / 12);
            sum += held * s.lasts();
            sum_wave += held * between;
            sum += integral(question.load(), s.from, s.to, piece, [&](double t) { return question.load().value(t); });
            sum_wave += integral(question.load(), s.from, s.to, piece,
                                 [&](double t) { return question.load().value(t) * wave(t); });
        } else {
            const double braking =
                system.braking(s.end.theta > s.begin.theta ? model::Motion::forward : model::Motion::backward);
            sum += braking * s.lasts();
            sum_wave += braking * between;
        }
    }
    const std::complex<double> left = M_wave - sum_wave * (2 / length);
    constexpr double least_left = 0.02;  // fraction of M: an error of 1e-14 of M stays below 1e-12 of theta
    if (!(std::abs(left) > least_left * std::abs(M_wave))) return {};
    Fundamental found;
    found.wave =
        left / std::complex<double>(system.stiffness() - system.inertia() * omega * omega, system.damping() * omega);
    if (!motion.symmetric) {
        const double mean_M = integral(question.load(), run.t_start, run.t_stop, repeats.period / 64,
                                       [&](double t) { return question.load().value(t); }) /
                              length;
        found.mean = (mean_M - sum / length) / system.stiffness();
    }
    return found;
}

/// Sums over time: theta, and theta e^(-i omega t).
struct Moments {
    double theta = 0;
    std::complex<double> wave = {};

    friend Moments operator+(const Moments& a, const Moments& b) { return {a.theta + b.theta, a.wave + b.wave}; }
    friend Moments operator-(const Moments& a, const Moments& b) { return {a.theta - b.theta, a.wave - b.wave}; }
    friend double size_of(const Moments& moments) { return std::max(std::fabs(moments.theta), std::abs(moments.wave)); }
    friend Moments operator*(double factor, const Moments& a) { return {factor * a.theta, factor * a.wave}; }
    Moments& operator+=(const Moments& other) { return *this = *this + other; }
};

/// Returns whether M's fundamental exceeds the rounding of M.
bool is_more_than_rounding(const SteadyQuestion& question, const std::complex<double>& wave) {
    const double most = question.load().most();
    if (std::isfinite(most)) return std::abs(wave) > least_harmonic * 2 * most;
    const TorqueRange M = extremes(question.load(), question.repeats);
    return std::abs(wave) > least_harmonic * (M.high - M.low);
}

/// The angle reduced to (-pi, pi].
double in_one_turn(double angle) {
    constexpr double whole = 2 * std::numbers::pi;
    const double turn = angle - whole * std::ceil(angle / whole - 0.5);
    return turn == 0 ? 0 : turn;
}

/// A run from the beginning of M's period.
motion::Run run_from(const SteadyQuestion& question, const model::State& start, double length, bool dense,
                     const motion::Monitor& monitor) {
    motion::Limits limits;
    limits.dense = dense;  // a stored series is faster to evaluate than a closed form
    const model::Drive drive{question.drive.M(), start};
    const double begin = question.repeats.start;
    auto run = motion::simulate(
        question.body, drive, {begin, begin + length}, motion::Grid::none(),
        dense ? motion::Integrator(motion::Spectral{}) : motion::integrator_for(question.body, drive), monitor, limits);
    if (run) return std::move(run).value();
    motion::Run none;
    none.outcome = model::Outcome::state_not_finite;
    return none;
}

/// Computes mean and fundamental from the motion itself.
std::optional<Fundamental> by_motion(const SteadyQuestion& question, const Repetition& repeats,
                                     const SteadyMotion& motion, const motion::Run& run) {
    if (!model::is_whole(run.outcome)) return {};
    const double length = run.t_stop - run.t_start;
    const double omega = 2 * std::numbers::pi / repeats.period;
    const double middle = motion.symmetric ? 0 : (motion.low + motion.high) / 2;
    const double own = question.body.stiffness() > 0 ? question.body.natural_period() : repeats.period;
    const model::Excitation breaking = question.load() + question.drive.belt() + question.drive.base;
    const std::vector<double> ends = run.course == nullptr ? std::vector<double>() : run.course->piece_ends();
    Moments sum;
    for (const Stretch& s : stretches(run)) {
        if (!(s.lasts() > 0)) continue;
        const auto moments_at = [&](double t) {
            double off = s.begin.theta - middle;
            if (!s.stuck || run.on_belt) {
                const auto state = run.at(std::clamp(t, s.from, s.to));
                off = state ? state->theta - middle : 0;
            }
            return Moments{off, off * std::polar(1.0, -omega * (t - repeats.start))};
        };
        const double longest = std::min({own, repeats.period, s.lasts()}) / 12;
        auto end = std::ranges::upper_bound(ends, s.from);
        for (double from = s.from; from < s.to;) {
            const double to = end == ends.end() ? s.to : std::min(*end++, s.to);
            sum = sum + integral(breaking, from, to, longest, moments_at);
            from = to;
        }
    }
    return Fundamental{motion.symmetric ? 0 : middle + sum.theta / length, sum.wave * (2 / length)};
}

}  // namespace

SteadyShape shape_of(const SteadyQuestion& question, const SteadyMotion& motion, const motion::Monitor& monitor) {
    SteadyShape shape;
    shape.mean = motion.start.theta;
    if (motion.status != SteadyStatus::steady || motion.period == 0) return shape;
    const Repetition repeats =
        question.is_timeless() ? Repetition{question.repeats.start, motion.period} : question.repeats;
    // Half a period of a symmetric motion is enough.
    const double length = motion.symmetric && !motion.by_returns.run ? motion.period / 2 : motion.period;
    const bool feedback = question.load().has_feedback() || question.is_timeless();
    const std::complex<double> M_wave = feedback ? 0 : harmonic_of(question.load(), repeats, 1);
    const bool drives = !feedback && is_more_than_rounding(question, M_wave);
    std::optional<Fundamental> found;
    if (const auto slides = drives && !motion.by_returns.run ? ShortSlides::closed(question) : std::nullopt) {
        found = Fundamental{0, slides->fundamental()};
    } else if (drives && !motion.by_returns.run && is_linear_but_for_friction(question)) {
        const motion::Run run = run_from(question, motion.start, length, false, monitor);
        if (!model::is_whole(run.outcome)) return shape;
        found = by_friction(question, motion, run, M_wave);
    }
    if (!found) {
        found = by_motion(
            question, repeats, motion,
            motion.by_returns.run ? *motion.by_returns.run : run_from(question, motion.start, length, true, monitor));
    }
    if (!found) return shape;
    shape.mean = found->mean;
    shape.fundamental = std::abs(found->wave);
    if (!drives) return shape;
    if (shape.fundamental > least_harmonic * motion.amplitude) {
        shape.lag = in_one_turn(std::arg(M_wave) - std::arg(found->wave));
    }
    // The fundamental |M| cos(omega t + arg) is greatest at omega t = -arg.
    const double omega = 2 * std::numbers::pi / repeats.period;
    shape.peak_lag = in_one_turn(omega * (motion.t_high - repeats.start) + std::arg(M_wave));
    return shape;
}

namespace {

class SteadyStory : text::Prose {
public:
    /// The names of several bodies; empty for one. `remembers`: whether a controller samples or waits.
    SteadyStory(const SteadyMotion& motion, bool timeless, bool remembers, const std::vector<std::string>& names)
        : motion_(motion), timeless_(timeless), remembers_(remembers), names_(names) {}

    void tell(const SteadyShape& shape, bool sampled, double period) {
        switch (motion_.status) {
            case SteadyStatus::steady:
                if (motion_.period == 0) {
                    several() ? describe_rotations()
                              : say("It moves at the constant velocity {:.6g}.", motion_.start.velocity);
                    break;
                }
                describe_period();
                several() ? describe_bodies() : describe_extremes(shape);
                describe_memory();
                describe_stability();
                break;
            case SteadyStatus::adheres:
                if (several()) {
                    say("Nothing moves: over a period M never exceeds what friction can hold.");
                    break;
                }
                if (motion_.rest.first == motion_.rest.second) {
                    say("The mass stays at rest at theta = {}: M does not move it.", number(motion_.rest.first));
                    break;
                }
                say("The mass adheres: over a period M never exceeds what friction can hold, so it stays where it "
                    "is, anywhere from theta = {} to {}.",
                    number(motion_.rest.first), number(motion_.rest.second));
                break;
            case SteadyStatus::rest:
                if (!motion_.stable) {
                    say("There is a rest{}, but it is unstable: a small disturbance grows.",
                        several() ? "" : " at theta = " + number(motion_.low));
                    break;
                }
                if (several()) {
                    say("The motion dies out: all bodies come to rest.");
                    break;
                }
                say("The motion dies out: the mass comes to rest at theta = {}.", number(motion_.low));
                if (motion_.rest.first < motion_.rest.second) {
                    say("Friction can hold it anywhere from theta = {} to {}.", number(motion_.rest.first),
                        number(motion_.rest.second));
                }
                break;
            case SteadyStatus::grows:
                if (timeless_ || several() || std::isinf(motion_.growth)) {
                    say("There is no steady motion: the amplitude grows without bound.");
                    break;
                }
                say("There is no steady motion: M supplies more energy than is dissipated, and the amplitude grows "
                    "by {} in each period of M ({:.5g}).",
                    number(motion_.growth), period);
                break;
            case SteadyStatus::none:
                describe_none(sampled);
                break;
        }
    }

    void describe_others(const std::vector<OtherMotion>& others) {
        constexpr std::size_t most = 3;
        for (std::size_t i = 0; i < std::min(most, others.size()); ++i) describe_other(others[i].motion);
        if (others.size() > most) say("There are {} more (s.others).", others.size() - most);
        if (others.empty()) describe_unique();
    }
    void count_others(std::size_t others) {
        if (others > 0) {
            say("From other starts {} {} seen.", text::counted(others, "other motion"), others == 1 ? "was" : "were");
        }
        if (others == 0) describe_unique();
    }

    std::string take_text() { return std::move(sentences_); }

private:
    bool several() const { return !names_.empty(); }
    std::string number(double x) const {
        return text::number_text(x, std::max({std::fabs(motion_.low), std::fabs(motion_.high), std::fabs(x)}));
    }
    void describe_period() {
        if (timeless_) {
            say("The motion is a limit cycle of period {:.6g}.", motion_.period);
        } else {
            say("The motion repeats itself every {:.6g}, {} of M.", motion_.period,
                motion_.periods == 1 ? "the period" : fmt::format("{} periods", motion_.periods));
        }
    }
    void describe_extremes(const SteadyShape& shape) {
        if (const auto& run = motion_.by_returns.run; std::isnan(motion_.amplitude) && run) {
            say("It advances by {:.6g} in each period.", run->state_at_stop.theta - run->initial.theta);
        } else {
            say("Its amplitude is {}, from theta = {} to {}.", number(motion_.amplitude), number(motion_.low),
                number(motion_.high));
        }
        if (shape.lag) {
            say("Its fundamental lags {:.5g} rad behind that of M.", *shape.lag);
        }
        if (motion_.stops == 0) {
            say("It never stops.");
        } else {
            say("It stops {} a period and is stuck for {} of it.",
                motion_.stops == 1 ? "once" : fmt::format("{} times", motion_.stops), text::percent(motion_.stuck));
        }
        if (motion_.symmetric) say("The motion is symmetric: theta(t + T/2) = -theta(t).");
    }
    void describe_rotations() {
        if (std::ranges::all_of(motion_.bodies, [](const BodyMotion& body) { return body.turned != 0; })) {
            say("All bodies rotate at constant speed.");
            return;
        }
        for (std::size_t i = 0; i < names_.size(); ++i) {
            const double velocity = motion_.bodies[i].turned;
            if (velocity != 0) say("{} moves at the constant velocity {:.6g}.", names_[i], velocity);
            if (velocity == 0) say("{} is at rest.", names_[i]);
        }
    }
    void describe_bodies() {
        for (std::size_t i = 0; i < names_.size(); ++i) {
            const BodyMotion& body = motion_.bodies[i];
            const double size = std::max(std::fabs(body.low), std::fabs(body.high));
            if (body.turned != 0) {
                say("{} turns by {:.5g} in each period.", names_[i], body.turned);
            } else if (!names_[i].empty() && body.high > body.low) {
                say("{} swings between {} and {}.", names_[i], text::number_text(body.low, size),
                    text::number_text(body.high, size));
            }
        }
    }
    void describe_memory() {
        if (!remembers_) return;
        say("A run {}led to it; it has no multipliers, because the memory of M is part of the state.",
            timeless_ ? "" : fmt::format("of {} periods of M ", motion_.maps));
    }
    void describe_stability() {
        if (!motion_.differentiable) {
            if (!remembers_) say("It has no multipliers: the motion is not smooth here.");
            return;
        }
        double largest = 0;
        for (const std::complex<double>& value : motion_.multipliers) largest = std::max(largest, std::abs(value));
        constexpr double next_to_nothing = 1e-10;  // the accuracy of multipliers from differences of runs
        if (!motion_.stable) {
            say("It is unstable: a disturbance grows by a factor of {:.6g} in a period, so no run stays on it.",
                largest);
        } else if (largest > 1 - 1e-6) {
            say("It is marginally stable: a disturbance neither grows nor decays.");
        } else if (largest < next_to_nothing) {
            say("It is stable: a disturbance is gone after one period.");
        } else {
            say("It is stable: {} of a disturbance remains after a period.", text::percent(largest));
        }
    }
    void describe_none(bool sampled) {
        if (timeless_) {
            say("No limit cycle was found: the motion is irregular, or it settles very slowly.");
        } else {
            say("No motion of up to 32 periods of M was found within {} periods: {}.", motion_.maps,
                motion_.change
                    ? fmt::format("the motion nearly repeats itself, but changes by {:.2g} of its amplitude each time",
                                  *motion_.change)
                    : "the motion is irregular, or it settles very slowly");
        }
        if (!sampled) return;
        if (timeless_) {
            say("A sampled controller has a cycle only if a whole number of sampling intervals is a period of "
                "the motion.");
        } else {
            say("A controller that samples may have no period in common with M: choose an every that divides "
                "the period.");
        }
    }
    void describe_other(const SteadyMotion& other) {
        if (other.stands()) {
            const std::string place = several() ? "" : " at theta = " + number(other.low);
            other.stable
                ? say("From another start {} to rest{}.", several() ? "all bodies come" : "the mass comes", place)
                : say("There is also a rest{}, which is unstable.", place);
        } else if (other.status == SteadyStatus::grows) {
            say("From another start the motion grows.");
        } else if (timeless_) {
            say("Another start leads to another motion: amplitude {}, period {:.6g}.", number(other.amplitude),
                other.period);
        } else {
            say("Another start leads to another motion: amplitude {}, {} of M long.", number(other.amplitude),
                text::counted(static_cast<std::size_t>(other.periods), "period"));
        }
    }
    void describe_unique() {
        if (motion_.status != SteadyStatus::steady) return;
        if (!motion_.unique.has_value()) {
            say("{} other starts led to no other motion, which is no proof.", other_starts);
        } else if (*motion_.unique) {
            say("No other steady motion exists.");
        } else {
            say("It is one of a family of periodic motions.");
        }
    }

    const SteadyMotion& motion_;
    bool timeless_, remembers_;
    const std::vector<std::string>& names_;
};

/// Returns whether a controller of the question samples or waits, so that the state is more than angles, velocities and
/// states.
bool remembers(const SteadyQuestion& question) {
    return settles_after(question).value_or(0) >= 0;
}

}  // namespace

std::string description_of(const SteadyQuestion& question, const SteadyMotion& motion, const SteadyShape& shape,
                           const std::vector<OtherMotion>& others) {
    const std::vector<std::string> nobody;
    SteadyStory story(motion, question.is_timeless(), remembers(question), nobody);
    story.tell(shape, model::has_memory<model::SampledController>(question.drive.M()), question.repeats.period);
    if (motion.is_found()) story.describe_others(others);
    return story.take_text();
}

std::string description_of(const SteadyQuestion& question, const SteadyMotion& motion, std::size_t others) {
    std::vector<std::string> names;
    for (const model::Body& body : question.system->bodies) names.push_back(body.name);
    const auto& loads = question.drive.loads;
    const bool sampled = std::ranges::any_of(loads, model::has_memory<model::SampledController>);
    SteadyStory story(motion, question.repeats.period == 0, remembers(question), names);
    story.tell({}, sampled, question.repeats.period);
    if (motion.is_found()) story.count_others(others);
    return story.take_text();
}

}  // namespace dinal::analysis
