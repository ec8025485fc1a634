// rig:steady{ ... }, and what its answer is from one of the bodies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/steady_facts.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/steady_answer.hpp"
#include "lua/vector.hpp"
#include "model/controller.hpp"

namespace dinal::api {

namespace {

/// The whole motion, or of one body without a name that of this body.
SteadyHandle made(const analysis::RigQuestion& question, analysis::SteadyMotion motion);

/// The motion as seen from the body or link of this joint.
SteadyHandle seen_from(const std::shared_ptr<RigSteady>& rig, std::size_t joint) {
    const model::Assembly& system = *rig->question.system;
    const analysis::SteadyMotion& whole = rig->motion;
    analysis::SteadyQuestion question{.system = model::Oscillator::make(parameters_of(system, joint)).value(),
                                      .excitation = {},
                                      .drive = rig->question.repeats,
                                      .periods = rig->question.periods};
    if (!system.is_link(joint)) {
        const model::Excitation& load = rig->question.drive.loads[joint];
        if (!load.has_feedback() && !model::has_memory(load)) question.excitation = load;
    }
    const RunHandle run = rig->run != nullptr ? part_of(rig->run, joint) : nullptr;
    std::shared_ptr<const motion::Trajectory> seen;
    if (run) seen = {run, &run->trajectory};
    analysis::SteadyMotion facts = analysis::seen_from(rig->question, whole, joint, question, std::move(seen));
    auto part = std::make_shared<Steady>(Steady{std::move(question), std::move(facts)});
    part->rig = rig;
    part->of_body = true;
    part->others.emplace();
    part->part = run;
    return part;
}

SteadyHandle made(const analysis::RigQuestion& question, analysis::SteadyMotion motion) {
    auto rig = std::make_shared<RigSteady>(RigSteady{question, std::move(motion)});
    if (const auto& period = rig->motion.of_bodies) {
        auto run = std::make_shared<BodiesRun>();
        run->system = question.system, run->drive = period->drive, run->run = period->run;
        constexpr double rows = 400;
        run->dt = rig->motion.period / rows;
        run->t_end = run->run.t_stop;
        rig->run = std::move(run);
    }
    if (!question.system->named) return seen_from(rig, 0);
    auto whole =
        std::make_shared<Steady>(Steady{{.system = model::Oscillator::make(parameters_of(*question.system, 0)).value(),
                                         .excitation = {},
                                         .drive = question.repeats},
                                        rig->motion});
    whole->rig = std::move(rig);
    return whole;
}

}  // namespace

int steady_of_rig(lua_State* L) {
    analysis::RigQuestion question{.system = lua::self<AssemblyHandle>(L, 1, rig_steady_call.example), .drive = {}};
    const lua::Options options(L, 2, rig_steady_call);
    SteadyOptions asked;
    options.fill(asked);
    question.drive = asked_drive(L, options, *question.system);
    question.periods = asked.periods.value_or(0);
    question.repeats = drive_or_fail(L, options, question, asked_period(options));
    const auto settles = analysis::settles_after(question);
    if (!settles) {
        options.fail(
            "M",
            "the controllers of M and what else drives the bodies have no common period of at most 1000 instants "
            "or periods; run it for long and see run.load:cycle()");
    }
    question.settles = *settles;
    analysis::SteadyMotion found;
    asking_bodies(L, question,
                  [&](const motion::Monitor& monitor) { found = analysis::steady_motion(question, monitor); });
    check_motion(options, found);
    lua::push<SteadyHandle>(L, made(question, std::move(found)));
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
    asking_bodies(L, rig.question, [&](const motion::Monitor& monitor) {
        found = analysis::other_motions(rig.question, rig.motion, monitor);
    });
    rig.others.emplace();
    for (auto& other : found) rig.others->push_back(made(other.question, std::move(other.motion)));
    return *rig.others;
}

std::string story_of_rig(lua_State* L, const Steady& s) {
    return analysis::told(s.rig->question, s.rig->motion, others_of_rig(L, *s.rig).size());
}

int body_of_steady(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const SteadyHandle s = lua::self<SteadyHandle>(L, 1, "s.load");
    if (s->rig == nullptr || s->of_body) return 0;
    const std::size_t joint =
        joint_named(L, lua_tostring(L, 2), *s->rig->question.system, "this steady motion", steady_class);
    lua::push<SteadyHandle>(L, seen_from(s->rig, joint));
    return 1;
}

// rig:response{ over, at }: the steady motion of several bodies over a list of values.

namespace {

/// Options theta0 and velocity0 at `options`, from a motion that was found nearby, where the user gives neither.
void start_near(lua_State* L, int options, const motion::engine::Drive& near, const model::Assembly& system) {
    for (const char* name : {"theta0", "velocity0"}) {
        const bool given = lua_getfield(L, options, name) != LUA_TNIL;
        lua_pop(L, 1);
        if (given) return;
    }
    for (const auto& [name, values] : {std::pair("theta0", &near.theta0), std::pair("velocity0", &near.velocity0)}) {
        lua_createtable(L, 0, static_cast<int>(values->size()));
        for (std::size_t i = 0; i < values->size(); ++i) {
            lua::set_number(L, system.bodies[i].name.c_str(), (*values)[i]);
        }
        lua_setfield(L, options, name);
    }
}

/// What at(point) says, as options of rig:steady, with the system where that is another one: system, options.
void push_point(lua_State* L, const lua::Options& options, const PointGrid& grid, std::size_t point) {
    lua_pushvalue(L, 1);
    options.push("at");
    lua_newtable(L);
    grid.set_fields(L, point);
    lua_call(L, 1, 1);
    if (!lua_istable(L, -1)) {
        options.fail("at", fmt::format("at returned {} for {}; it must return a table of options of rig:steady, "
                                       "such as {{ belt = {{ load = p.speed }} }}",
                                       lua::describe(L, -1), grid.text(point)));
    }
    lua::push_copy(L, -1);  // the user's table stays as it is
    lua_remove(L, -2);
    if (lua_getfield(L, -1, "system") != LUA_TNIL) {
        if (lua::test<AssemblyHandle>(L, -1) == nullptr) {
            options.fail(
                "at", fmt::format("at must return a system of several bodies as system, got {}", lua::describe(L, -1)));
        }
        lua_replace(L, -3);
        lua_pushnil(L);
        lua_setfield(L, -2, "system");
    } else {
        lua_pop(L, 1);
    }
}

}  // namespace

int response_of_rig(lua_State* L) {
    const AssemblyHandle first = lua::self<AssemblyHandle>(L, 1, rig_response_call.example);
    const lua::Options options(L, 2, rig_response_call);
    push_function(L, options, "at");
    const PointGrid grid(varied_in(L, options));
    if (!first->named) options.fail("over", "a response is of several bodies, or of one with constant Rd and Re");
    constexpr std::array<const char*, 5> kinds{"amplitude", "peak", "lag", "stops", "stuck"};
    std::vector<std::vector<double>> numbers(kinds.size() * first->joints.size());
    std::vector<double> stable;
    std::vector<std::string> status;
    SteadyHandle near;
    std::vector<std::size_t> points(grid.size());
    std::iota(points.begin(), points.end(), std::size_t{0});
    for (const std::size_t point : points) {
        if (point % grid.parameters().back().size() == 0) near = nullptr;
        push_point(L, options, grid, point);
        const int asked = lua_gettop(L);
        if (near) start_near(L, asked, near->rig->run->drive, *first);
        lua_pushcfunction(L, lua::guarded<steady_of_rig>);
        lua_insert(L, -3);
        lua_call(L, 2, 1);
        const int found = lua_gettop(L);
        const SteadyHandle s = *lua::test<SteadyHandle>(L, found);
        const model::Assembly& system = *s->rig->question.system;
        near = s->motion.status == analysis::SteadyStatus::steady && s->rig->run != nullptr ? s : nullptr;
        for (std::size_t j = 0; j < first->joints.size(); ++j) {
            if (system.joints.size() != first->joints.size() || system.joints[j].name != first->joints[j].name) {
                options.fail("at", "at must return systems with the same bodies and links");
            }
            lua_getfield(L, found, first->joints[j].name.c_str());
            for (std::size_t k = 0; k < kinds.size(); ++k) {
                lua_getfield(L, -1, kinds[k]);
                const bool grows = s->motion.status == analysis::SteadyStatus::grows && k < 2;
                const double none =
                    grows ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
                numbers[j * kinds.size() + k].push_back(lua_isnil(L, -1) ? none : lua_tonumber(L, -1));
                lua_pop(L, 1);
            }
            lua_pop(L, 1);
        }
        stable.push_back(is_found(*s) && s->motion.stable ? 1 : 0);
        status.emplace_back(analysis::name(s->motion.status));
        lua_settop(L, 2);
    }
    Data data;
    const ColumnUnits in(first->units);
    data.columns = grid.columns(points);
    for (const DataColumn& parameter : grid.parameters()) data.parameters.push_back(parameter.name);
    if (data.parameters.size() == 1) data.parameters.clear();
    for (std::size_t j = 0; j < first->joints.size(); ++j) {
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            data.columns.push_back(column_of(fmt::format("{}.{}", first->joints[j].name, kinds[k]),
                                             std::move(numbers[j * kinds.size() + k]),
                                             k < 2    ? in.theta
                                             : k == 2 ? "rad"
                                                      : ""));
        }
    }
    data.columns.push_back(column_of("stable", std::move(stable)));
    data.columns.push_back(column_of("status", std::move(status)));
    return push_data(L, std::move(data));
}

}  // namespace dinal::api
