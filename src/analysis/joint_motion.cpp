// A steady motion as seen from one joint.
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/returns.hpp"
#include "analysis/steady_facts.hpp"
#include "motion/simulate.hpp"
#include "motion/spectral/spectral.hpp"
#include "motion/stillness.hpp"

namespace dinal::analysis {

SteadyQuestion for_returns(const SteadyQuestion& question) {
    SteadyQuestion asked = question;
    if (!question.is_plain()) return asked;
    const model::Oscillator& body = question.body;
    if (body.has_spring()) asked.longest = motion::spectral::longest_panel * body.natural_period();
    asked.settles = settles_after(asked).value_or(question.repeats.period);
    return asked;
}

std::shared_ptr<const SteadyQuestion> begun_at(const SteadyQuestion& question, const model::Drive& drive,
                                               double start) {
    auto asked = std::make_shared<SteadyQuestion>(question);
    asked->drive = drive;
    asked->repeats.start = start;
    return asked;
}

void tell_of_run(const SteadyQuestion& question, const motion::Run& run, SteadyMotion& motion) {
    motion.start = run.initial;
    motion.low = motion.high = run.initial.theta;
    motion.t_high = run.t_start;
    const auto see = [&motion](double t, double theta) {
        if (theta > motion.high) motion.high = theta, motion.t_high = t;
        motion.low = std::min(motion.low, theta);
    };
    for (const model::Event& event : run.events) {
        see(event.t, event.theta);
        if (event.kind != model::EventKind::user) continue;
        if (const auto thrown = run.at(event.t)) see(event.t, thrown->theta);
    }
    if (run.on_belt) {
        for (const model::Event& turn : motion::turns_on_belt(run)) see(turn.t, turn.theta);
    }
    see(run.t_stop, run.state_at_stop.theta);
    const double length = run.t_stop - run.t_start;
    double stuck = 0;
    motion.stops = 0;
    for (const Stretch& s : stretches(run)) {
        if (!s.stuck) continue;
        motion.stops += s.begun_by ? 1U : 0U;
        stuck += s.lasts();
    }
    const bool moves = motion.high > motion.low;
    motion.status = moves ? SteadyStatus::steady : SteadyStatus::adheres;
    motion.amplitude = (motion.high - motion.low) / 2 + 0.0;
    motion.stuck = moves || time_open(run) > 0 ? std::min(1.0, stuck / length) : 1;
    if (!moves) motion.rest = rest_of(question, motion.start.theta);
}

SteadyMotion seen_from(const SteadyQuestion& question, const SteadyMotion& whole,
                       std::shared_ptr<const motion::Run> run) {
    const model::System& system = *question.system;
    const std::size_t joint = question.joint.value_or(0);
    const model::Joint& seen = system.joints[joint];
    const bool alone = system.is_alone();
    const auto of = [&](auto number) {
        double sum = 0;
        for (const auto& [body, by] : seen.of) sum += by * number(whole.bodies[body]);
        return sum;
    };
    SteadyMotion facts = whole;
    if (run) {
        tell_of_run(question, *run, facts);
        double size = 0;
        for (const BodyMotion& body : whole.bodies) size = std::max(size, body.high - body.low);
        // The difference of two angles held together is only rounding.
        if (system.is_link(joint) && facts.high - facts.low <= 1e-13 * size) {
            facts.status = SteadyStatus::adheres;
            facts.amplitude = 0;
            if (time_open(*run) == 0) facts.stuck = 1;
        }
        if (!alone) facts.rest = {facts.low, facts.low};
        if (whole.by_returns.drive)
            facts.by_returns.question = begun_at(question, *whole.by_returns.drive, run->t_start);
        facts.by_returns.run = std::move(run);
    } else if (whole.is_found()) {
        facts.amplitude = 0;
        facts.low = facts.high = of([](const BodyMotion& body) { return body.begin; });
        facts.start = {facts.low, of([](const BodyMotion& body) { return body.turned; })};
        facts.rest = alone && facts.start.velocity == 0 && facts.stuck == 1 ? rest_of(question, facts.low)
                                                                            : std::pair(facts.low, facts.low);
        if (alone) facts.unique = facts.rest.first < facts.rest.second ? std::optional(false) : std::nullopt;
        if (whole.by_returns.drive)
            facts.by_returns.question = begun_at(question, *whole.by_returns.drive, question.repeats.start);
    }
    // The angle of a rotating body is not periodic.
    const double turned = facts.is_found() ? of([](const BodyMotion& body) { return body.turned; }) : 0;
    if (facts.is_found() && std::fabs(turned) > 1e-6 * std::fabs(whole.bodies[seen.first()].turned)) {
        facts.amplitude = facts.low = facts.high = facts.start.theta = std::numeric_limits<double>::quiet_NaN();
    }
    return facts;
}

SteadyMotion seen_from(const SteadyQuestion& question, const SteadyMotion& motion) {
    std::shared_ptr<const motion::Run> run;
    if (const auto& period = motion.by_returns.of_bodies) {
        run = std::make_shared<const motion::Run>(
            motion::part_of(*question.system, period->drive, period->run, question.joint.value_or(0)));
    }
    return seen_from(question, motion, std::move(run));
}

}  // namespace dinal::analysis
