// rig:steady{ ... }, and what its answer is from one of the bodies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/steady_facts.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/steady_answer.hpp"
#include "lua/vector.hpp"
#include "model/controller.hpp"

namespace dinal::api {

namespace {

/// The whole motion, or of one body without a name that of this body.
SteadyHandle made(std::shared_ptr<const analysis::RigQuestion> question, analysis::SteadyMotion motion);

/// The motion as seen from the body or link of this joint.
SteadyHandle seen_from(const std::shared_ptr<RigSteady>& rig, std::size_t joint) {
    const analysis::SteadyMotion& whole = rig->motion;
    analysis::SteadyQuestion question = question_of_joint(rig->question, joint);
    const RunHandle run = rig->run != nullptr ? part_of(rig->run, joint) : nullptr;
    std::shared_ptr<const motion::Trajectory> seen;
    if (run) seen = {run, &run->trajectory};
    analysis::SteadyMotion facts = analysis::seen_from(*rig->question, whole, joint, question, std::move(seen));
    auto part = std::make_shared<Steady>(Steady{std::move(question), std::move(facts)});
    part->rig = rig;
    part->of_body = true;
    part->others.emplace();
    part->part = run;
    return part;
}

SteadyHandle made(std::shared_ptr<const analysis::RigQuestion> question, analysis::SteadyMotion motion) {
    auto rig = std::make_shared<RigSteady>(RigSteady{question, std::move(motion)});
    if (const auto& period = rig->motion.of_bodies) {
        auto run = std::make_shared<BodiesRun>();
        run->system = question->system, run->drive = period->drive, run->run = period->run;
        constexpr double rows = 400;
        run->dt = rig->motion.period / rows;
        run->t_end = run->run.t_stop;
        rig->run = std::move(run);
    }
    if (!question->system->named) return seen_from(rig, 0);
    auto whole =
        std::make_shared<Steady>(Steady{{.system = model::Oscillator::make(parameters_of(*question->system, 0)).value(),
                                         .excitation = {},
                                         .drive = question->repeats},
                                        rig->motion});
    whole->rig = std::move(rig);
    return whole;
}

}  // namespace

analysis::SteadyQuestion question_of_joint(const std::shared_ptr<const analysis::RigQuestion>& whole,
                                           std::size_t joint) {
    const model::Assembly& system = *whole->system;
    analysis::SteadyQuestion question{.system = model::Oscillator::make(parameters_of(system, joint)).value(),
                                      .excitation = {},
                                      .drive = whole->repeats,
                                      .periods = whole->periods};
    question.whole = whole, question.joint = joint;
    if (!system.is_link(joint)) {
        const model::Excitation& load = whole->drive.loads[joint];
        if (!load.has_feedback() && !model::has_memory(load)) question.excitation = load;
    }
    return question;
}

double settles_or_fail(const lua::Options& options, const analysis::RigQuestion& question) {
    const auto settles = analysis::settles_after(question);
    if (settles) return *settles;
    options.fail("M",
                 "the controllers of M and what else drives the bodies have no common period of at most 1000 instants "
                 "or periods; run it for long and see run.load:cycle()");
}

int steady_of_rig(lua_State* L) {
    analysis::RigQuestion question{.system = lua::self<AssemblyHandle>(L, 1, rig_steady_call.example), .drive = {}};
    const lua::Options options(L, 2, rig_steady_call);
    SteadyOptions asked;
    options.fill(asked);
    question.drive = asked_drive(L, options, *question.system);
    question.periods = asked.periods.value_or(0);
    question.repeats = drive_or_fail(L, options, question, asked_period(options));
    question.settles = settles_or_fail(options, question);
    analysis::SteadyMotion found;
    asking_bodies(L, question,
                  [&](const motion::Monitor& monitor) { found = analysis::steady_motion(question, monitor); });
    check_motion(options, found);
    lua::push<SteadyHandle>(L, made(std::make_shared<const analysis::RigQuestion>(question), std::move(found)));
    return 1;
}

void run_of_rig(lua_State* L, const Steady& s) {
    if (s.rig->run == nullptr) {
        lua_pushnil(L);
    } else if (s.part != nullptr) {
        push_run(L, s.part);
    } else {
        push_bodies_run(L, s.rig->run);
    }
}

const std::vector<SteadyHandle>& others_of_rig(lua_State* L, RigSteady& rig) {
    if (rig.others) return *rig.others;
    std::vector<analysis::Other<analysis::RigQuestion>> found;
    asking_bodies(L, *rig.question, [&](const motion::Monitor& monitor) {
        found = analysis::other_motions(*rig.question, rig.motion, monitor);
    });
    rig.others.emplace();
    for (auto& other : found)
        rig.others->push_back(
            made(std::make_shared<const analysis::RigQuestion>(std::move(other.question)), std::move(other.motion)));
    return *rig.others;
}

std::string story_of_rig(lua_State* L, const Steady& s) {
    return analysis::told(*s.rig->question, s.rig->motion, others_of_rig(L, *s.rig).size());
}

int body_of_steady(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const SteadyHandle s = lua::self<SteadyHandle>(L, 1, "s.load");
    if (s->rig == nullptr || s->of_body) return 0;
    const std::size_t joint =
        joint_named(L, lua_tostring(L, 2), *s->rig->question->system, "this steady motion", steady_class);
    lua::push<SteadyHandle>(L, seen_from(s->rig, joint));
    return 1;
}

}  // namespace dinal::api
