// rig:steady{ ... }, and what its answer is from one of the bodies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/steady_facts.hpp"
#include "api/classes.hpp"
#include "api/steady_answer.hpp"
#include "model/controller.hpp"

namespace dinal::api {
namespace {

/// Calls the work, which may evaluate functions of the bodies, and raises their errors.
template <class Work>
void asking_bodies(lua_State* L, const analysis::RigQuestion& question, Work work) {
    lua::CallState call(L);
    name_functions(call, *question.system, question.drive);
    work([](double) { return !lua::interrupt_requested(); });
    if (lua::interrupt_requested()) lua::raise_interrupted(L);
    if (call.failed()) call.raise_error();
}

/// As of one mass on the ground: what sentences and columns want to know of it.
model::Oscillator oscillator_of(const model::Assembly& system, std::size_t joint) {
    model::OscillatorParameters parameters;
    parameters.inertia = system.bodies[static_cast<std::size_t>(system.joints[joint].first)].inertia;
    parameters.stiffness = system.joints[joint].stiffness, parameters.damping = system.joints[joint].damping;
    parameters.units = system.units;
    return model::Oscillator::make(parameters).value();
}

analysis::Drive repeats_or_fail(lua_State* L, const lua::Options& options, const analysis::RigQuestion& question,
                                const std::optional<double>& period) {
    std::optional<analysis::Drive> drive;
    asking_bodies(L, question, [&](const motion::Monitor&) { drive = analysis::drive_of(question); });
    if (!drive && !period) {
        options.fail(
            {.sentence = "the period of the excitation is not known; give it with period = ...", .option = "period"});
    }
    if (period) drive = analysis::Drive{drive ? drive->start : 0, *period};
    if (drive->period > 0) {
        std::optional<text::Error> wrong;
        asking_bodies(L, question, [&](const motion::Monitor&) { wrong = analysis::not_periodic(question, *drive); });
        if (wrong) options.fail(*wrong);
    }
    return *drive;
}

/// The whole motion, or of one body without a name that of this body.
SteadyHandle made(const analysis::RigQuestion& question, analysis::RigMotion motion);

/// The motion as seen from the body or link of this joint.
SteadyHandle seen_from(const std::shared_ptr<RigSteady>& rig, std::size_t joint) {
    const model::Assembly& system = *rig->question.system;
    const analysis::RigMotion& whole = rig->motion;
    analysis::SteadyQuestion question{.system = oscillator_of(system, joint),
                                      .excitation = {},
                                      .drive = rig->question.repeats,
                                      .periods = rig->question.periods};
    if (!system.is_link(joint)) {
        const model::Excitation& load = rig->question.drive.loads[joint];
        if (!load.has_feedback() && !model::has_memory(load)) question.excitation = load;
    }
    auto part = std::make_shared<Steady>(Steady{std::move(question), whole.facts});
    part->rig = rig;
    part->of_body = true;
    part->others.emplace();
    analysis::SteadyMotion& facts = part->motion;
    if (rig->run != nullptr) {
        const RunHandle run = part_of(rig->run, joint);
        tell_of_run(part->question, run->trajectory, facts);
        facts.settled = std::shared_ptr<const motion::Trajectory>(run, &run->trajectory);
        part->part = run;
        double size = 0;
        for (std::size_t i = 0; i < whole.low.size(); ++i) size = std::max(size, whole.high[i] - whole.low[i]);
        // The difference of two angles that are held together is their rounding.
        if (system.is_link(joint) && facts.high - facts.low <= 1e-13 * size) {
            facts.status = analysis::SteadyStatus::adheres;
            facts.amplitude = 0, facts.stuck = 1;
        }
        facts.rest = {facts.low, facts.low};
    } else if (is_found(*part)) {
        const model::Joint& own = system.joints[joint];
        const double second = own.second < 0 ? 0 : whole.rest[static_cast<std::size_t>(own.second)];
        facts.low = facts.high = whole.rest[static_cast<std::size_t>(own.first)] - second;
        facts.rest = {facts.low, facts.low};
        facts.start = {facts.low, 0};
    }
    // Of a body that goes round the angle never comes back.
    const auto turned = [&](int body) { return body < 0 ? 0 : whole.turned[static_cast<std::size_t>(body)]; };
    if (is_found(*part) && std::fabs(turned(system.joints[joint].first) - turned(system.joints[joint].second)) >
                               1e-6 * std::fabs(turned(system.joints[joint].first))) {
        facts.amplitude = facts.low = facts.high = std::numeric_limits<double>::quiet_NaN();
    }
    return part;
}

SteadyHandle made(const analysis::RigQuestion& question, analysis::RigMotion motion) {
    auto rig = std::make_shared<RigSteady>(RigSteady{question, std::move(motion)});
    if (rig->motion.run.history != nullptr) {
        auto run = std::make_shared<BodiesRun>();
        run->system = question.system, run->drive = rig->motion.drive, run->run = rig->motion.run;
        constexpr double rows = 400;
        run->dt = rig->motion.facts.period / rows;
        rig->run = std::move(run);
    }
    if (!question.system->named) return seen_from(rig, 0);
    auto whole = std::make_shared<Steady>(
        Steady{{.system = oscillator_of(*question.system, 0), .excitation = {}, .drive = question.repeats},
               rig->motion.facts});
    whole->rig = std::move(rig);
    return whole;
}

}  // namespace

int steady_of_rig(lua_State* L) {
    analysis::RigQuestion question{.system = lua::self<AssemblyHandle>(L, 1, rig_steady_call.example), .drive = {}};
    const lua::Options options(L, 2, rig_steady_call);
    SteadyOptions asked;
    options.fill(asked);
    asked.period = period_or_fail(options, asked.period, asked.frequency, asked.omega);
    question.drive = asked_drive(L, options, *question.system);
    question.periods = asked.periods.value_or(0);
    question.repeats = repeats_or_fail(L, options, question, asked.period);
    const auto settles = [](const model::Excitation& load) {
        return model::has_memory<model::SampledController>(load) || model::has_memory<model::DelayedController>(load);
    };
    if (std::any_of(question.drive.loads.begin(), question.drive.loads.end(), settles)) {
        const auto common = analysis::common_period(question);
        if (!common) {
            options.fail("M",
                         "the controllers of M and what else drives the bodies have no common period of at most 1000 "
                         "instants or periods; run it for long and see run.load:cycle()");
        }
        question.settles = *common;
    }
    analysis::RigMotion found;
    asking_bodies(L, question,
                  [&](const motion::Monitor& monitor) { found = analysis::steady_motion(question, monitor); });
    const model::Outcome outcome = found.facts.outcome;
    if (outcome == model::Outcome::unresolved || outcome == model::Outcome::chattering ||
        outcome == model::Outcome::excitation_not_finite) {
        options.fail({fmt::format("the motion could not be followed: {}", model::sentence(outcome))});
    }
    check_function(options, found.facts);
    lua::push<SteadyHandle>(L, made(question, std::move(found)));
    return 1;
}

int run_of_rig(lua_State* L, const Steady& s) {
    if (s.rig->run == nullptr) {
        lua_pushnil(L);
    } else if (s.part != nullptr) {
        push_run(L, s.part);
    } else {
        push_bodies_run(L, s.rig->run);
    }
    return 1;
}

const std::vector<SteadyHandle>& others_of_rig(lua_State* L, RigSteady& rig) {
    if (rig.others) return *rig.others;
    std::vector<analysis::RigMotion> found;
    asking_bodies(L, rig.question, [&](const motion::Monitor& monitor) {
        found = analysis::other_motions(rig.question, rig.motion, monitor);
    });
    rig.others.emplace();
    for (analysis::RigMotion& other : found) rig.others->push_back(made(rig.question, std::move(other)));
    return *rig.others;
}

std::string story_of_rig(lua_State* L, const Steady& s) {
    return analysis::told(s.rig->question, s.rig->motion, others_of_rig(L, *s.rig).size());
}

int body_of_steady(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const SteadyHandle s = lua::self<SteadyHandle>(L, 1, "s.load");
    if (s->rig == nullptr || s->of_body) return 0;
    const std::size_t joint = joint_named(L, 2, *s->rig->question.system, "this steady motion", steady_class.members);
    lua::push<SteadyHandle>(L, seen_from(s->rig, joint));
    return 1;
}

}  // namespace dinal::api
