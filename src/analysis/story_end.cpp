// What became of a run: rest, steady motion, growth; and how the run ended.
#include "analysis/phase_lag.hpp"
#include "analysis/story.hpp"
#include "model/forcing.hpp"
#include "model/sticking.hpp"

namespace dinal::analysis {

void Story::tell_end() {
    const bool over = still_ || (stretches_.back().stuck && constant_from_ <= run_.t_stop);
    const bool failed = !model::is_whole(run_.outcome);
    if (half_cycles_ > 0 && !over) {
        if (const auto motion = recurrence(events_)) {
            tell_recurrence(*motion);
        } else if (!decay_told_) {
            tell_trend();
        }
    }
    if (failed) {
        tell_outcome();
    } else if (const Stretch& last = stretches_.back(); !last.stuck) {
        say("At the end, t = {}, theta = {} and velocity = {:.5g}.", at(run_.t_stop), place(last), last.end.velocity);
    }
    end_paragraph();
}

/// Stuck at the end: why it stays, if that is known.
void Story::tell_stillness() {
    still_ = run_.outcome == model::Outcome::at_rest;
    if (!still_) return;
    if (on_base_ || on_belt_) {
        say("It stays at rest.");
        return;
    }
    if (constant_from_ <= run_.t_stop) {
        say("M is constant{}, so it stays at rest.", free() ? "" : fmt::format(" from t = {} on", at(constant_from_)));
    } else if (std::isfinite(excitation_.most()) && held_at_most()) {
        say("|M| never exceeds {:.5g}, which is too little to move it: it stays at rest.", excitation_.most());
    } else {
        say("A whole period of M did not move it, so it stays at rest.");
    }
}

bool Story::held_at_most() const {
    return model::held_against(model::Lowered(system_), excitation_.most(), run_.state_at_stop.theta);
}

void Story::tell_recurrence(const Recurrence& motion) {
    tell_period(motion);
    if (motion.drift != 0) {
        say("It advances by {:.5g} in each period: stick-slip.", motion.drift);
    } else {
        say("The amplitude is {:.5g} about theta = {}.", motion.amplitude,
            text::number_text(motion.centre, 1e7 * motion.amplitude));
    }
    // A motion that repeats itself under an M of unknown period tells that period.
    const double known = model::period_from(excitation_, motion.since), period = known > 0 ? known : motion.period;
    if (std::fabs(motion.period / period - 1) <= 1e-3 && motion.drift == 0 && constant_from_ > motion.since) {
        if (const auto lag = phase_lag(run_, excitation_, period, motion.until)) {
            say("The fundamental of theta {} that of M by {:.3f} rad.", *lag < 0 ? "leads" : "lags behind",
                std::fabs(*lag));
        }
    }
    if (motion.stops == 0) {
        if (!system_.friction().none()) say("It does not stop.");
    } else {
        say("It stops {} in each period and is stuck for {} of the time.",
            motion.stops == 1   ? "once"
            : motion.stops == 2 ? "twice"
                                : fmt::format("{} times", motion.stops),
            text::percent(motion.stuck));
    }
    end_paragraph();
}

void Story::tell_period(const Recurrence& motion) {
    const double period = model::period_from(excitation_, motion.since);
    const double ratio = period > 0 ? motion.period / period : 0, whole = std::round(ratio);
    std::string of =
        fmt::format("{:.5g} {}", motion.period / T0_, system_.has_spring() ? "T0" : system_.units().times());
    if (whole >= 1 && std::fabs(ratio - whole) <= 1e-3 * ratio) {
        of = whole == 1 ? "the period of M" : fmt::format("{} periods of M", whole);
    }
    if (!motion.steady) {
        say("The motion is settling: it nearly repeats itself every {} ({}), and the last two periods differ by {} "
            "of the amplitude.",
            at(motion.period), of, text::percent(motion.change));
        return;
    }
    const bool always = motion.since == events_.front().t;
    say("{} steady: it repeats itself every {} ({}).",
        always ? "The motion is" : fmt::format("From t = {} on the motion is", at(motion.since)), at(motion.period),
        of);
    if (period == 0 && excitation_.has_feedback()) say("This is a limit cycle if M depends on the motion alone.");
}

void Story::tell_trend() {
    const double period = model::period_from(excitation_, stretches_.back().from);
    const Swings last = swings(swings_, period);
    if (last.trend == Trend::unknown) {
        if (!free() && run_.events.size() > 1) say("The run is too short to tell whether the motion becomes steady.");
        end_paragraph();
        return;
    }
    const auto& [a, b, c] = last.amplitudes;
    // The period of a base is not known here, so a beat may look like growth.
    const bool grows = last.trend == Trend::growing && !on_base_, shrinks = last.trend == Trend::shrinking;
    say("The motion {}: amplitudes of {:.5g}, {:.5g} and {:.5g} in the last three {}",
        grows     ? "grows"
        : shrinks ? "decays"
                  : "is not periodic so far",
        a, b, c, period > 0 ? "periods of M" : fmt::format("spans of {}", at(last.span)));
    tell_step(last);
    add(".");
    end_paragraph();
}

/// By how much the amplitude changes each time, when that has a rule.
void Story::tell_step(const Swings& last) {
    if (last.trend == Trend::irregular) return;
    const auto& [a, b, c] = last.amplitudes;
    constexpr double rule = 1e-3;
    const char* more = c > b ? "more" : "less";
    if (std::fabs((c - b) - (b - a)) <= rule * std::fabs(c - b)) {
        add(", {:.5g} {} each time", std::fabs(c - b), more);
    } else if (std::fabs(c / b - b / a) <= rule * std::fabs(c / b - 1)) {
        add(", {:.5g} times as much each time", c / b);
    }
}

void Story::tell_outcome() {
    if (run_.outcome == model::Outcome::interrupted) {
        say("The run was interrupted at t = {}: the text covers the time until then.", at(run_.t_stop));
    } else {
        say("The run stopped early, at t = {}: {}.", at(run_.t_stop), motion::outcome_text(run_));
    }
}

}  // namespace dinal::analysis
