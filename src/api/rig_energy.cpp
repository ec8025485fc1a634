// run:energy() and run:explain() of several bodies.
#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "analysis/rig_story.hpp"
#include "api/bodies.hpp"
#include "api/classes.hpp"
#include "lua/interrupt.hpp"
#include "model/controller.hpp"

namespace dinal::api {
namespace {

namespace engine = motion::engine;

struct RigEnergy {
    BodiesRunHandle run;
};
using RigEnergyHandle = std::shared_ptr<const RigEnergy>;

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Of all: the names are those of one body.
void set_total(lua_State* L, const engine::Works& works) {
    lua_createtable(L, 0, 12);
    for (const auto& [name, values] :
         {std::pair("input", &works.input), std::pair("base", &works.base), std::pair("kinetic", &works.kinetic),
          std::pair("spring", &works.spring), std::pair("viscous", &works.viscous), std::pair("dry", &works.dry),
          std::pair("belt", &works.belt), std::pair("impacts", &works.impacts)}) {
        lua::set_number(L, name, sum_of(*values));
    }
    lua::set_number(L, "acts", works.acts);
    lua::set_number(L, "error", analysis::error_of(works));
    lua::set_number(L, "flow", works.flow);
    lua::set_number(L, "closure", works.flow > 0 ? std::fabs(analysis::error_of(works)) / works.flow : 0);
}

const RigEnergy& rig_energy_self(lua_State* L) {
    return *lua::self<RigEnergyHandle>(L, 1, "energy.total");
}

int total_of_rig(lua_State* L) {
    set_total(L, *rig_energy_self(L).run->works);
    return 1;
}

/// energy.load, energy.clutch
int part_of_energy(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const BodiesRun& run = *rig_energy_self(L).run;
    const engine::Works& works = *run.works;
    const std::size_t joint = joint_named(L, 2, *run.system, "this energy", rig_energy_class.members);
    lua_createtable(L, 0, 8);
    if (!run.system->is_link(joint)) {
        lua::set_number(L, "input", works.input[joint]);
        lua::set_number(L, "base", works.base[joint]);
        lua::set_number(L, "kinetic", works.kinetic[joint]);
    }
    lua::set_number(L, "spring", works.spring[joint]);
    lua::set_number(L, "viscous", works.viscous[joint]);
    lua::set_number(L, "dry", works.dry[joint]);
    lua::set_number(L, "belt", works.belt[joint]);
    lua::set_number(L, "impacts", works.impacts[joint]);
    return 1;
}

int rig_energy_text(lua_State* L) {
    const BodiesRun& run = *rig_energy_self(L).run;
    const engine::Works& works = *run.works;
    const auto shown = [&](double x) { return std::fabs(x) <= 1e-15 * works.flow ? 0.0 : x; };
    std::string text = fmt::format("energy, t {:.9g} … {:.9g}: input = kinetic + spring + viscous + dry\n",
                                   run.run.t_start, run.run.t_stop);
    std::size_t width = 5;
    for (const model::Joint& joint : run.system->joints) width = std::max(width, joint.name.size());
    const auto line = [&](const std::string& name, double input, double kinetic, double spring, double viscous,
                          double dry) {
        text += fmt::format("  {:<{}}{:>13.6g}{:>13.6g}{:>13.6g}{:>13.6g}{:>13.6g}\n", name, width, shown(input),
                            shown(kinetic), shown(spring), shown(viscous), shown(dry));
    };
    text += fmt::format("  {:<{}}{:>13}{:>13}{:>13}{:>13}{:>13}\n", "", width, "input", "kinetic", "spring", "viscous",
                        "dry");
    for (std::size_t j = 0; j < run.system->joints.size(); ++j) {
        const bool link = run.system->is_link(j);
        line(run.system->joints[j].name, link ? 0 : works.input[j], link ? 0 : works.kinetic[j], works.spring[j],
             works.viscous[j], works.dry[j]);
    }
    line("all", sum_of(works.input), sum_of(works.kinetic), sum_of(works.spring), sum_of(works.viscous),
         sum_of(works.dry));
    for (const auto& [name, value] : {std::pair("belt", sum_of(works.belt)), std::pair("base", sum_of(works.base)),
                                      std::pair("acts", works.acts)}) {
        if (value != 0) text += fmt::format("  {} {:.6g} added by belt, base and acts\n", name, shown(value));
    }
    if (const double lost = sum_of(works.impacts); lost != 0) {
        text += fmt::format("  impacts {:.6g} were lost\n", shown(lost));
    }
    const double error = analysis::error_of(works);
    text += fmt::format("  error {:.2g}, {:.1g} of {:.6g} that flowed", error,
                        works.flow > 0 ? std::fabs(error) / works.flow : 0, works.flow);
    return lua::push_text(L, text);
}

#define DINAL_RIG_ENERGY                                                   \
    "rig = system{ bodies = { motor = { I = 1 }, load = { I = 3 } },\n"    \
    "    links = { clutch = { \"motor\", \"load\", Rd = 2 } } }\n"         \
    "run = rig:simulate{ velocity0 = { motor = 3 }, t_end = 4, dt = 1 }\n" \
    "energy = run:energy()\n"

constexpr lua::Member rig_energy_members[] = {
    {lua::a_field<total_of_rig>,
     {"energy.total -> table",
      "The balance of the whole run, torque times rad: input + belt + base + acts = kinetic + spring + viscous + "
      "dry + impacts + error; flow, and closure = |error|/flow.",
      DINAL_RIG_ENERGY "print(energy.total.kinetic, energy.total.closure < 1e-12)  --> -3.375\ttrue"}},
    {lua::a_metamethod<rig_energy_text>("__tostring"),
     {"tostring(energy) -> string", "The balance as a small table.",
      DINAL_RIG_ENERGY "print((tostring(energy):match(\"clutch.*0%s+([%d.]+)\\n\")))  --> 3.375"}},
};

}  // namespace

const lua::Class rig_energy_class = {
    "energy of several bodies",
    {"rig_run:energy() -> energy",
     "The energy of a run of several bodies: energy.total, and the share of each body or link: energy.clutch.dry.",
     DINAL_RIG_ENERGY "print(energy.clutch.dry)  --> 3.375"},
    rig_energy_members,
    part_of_energy};

#undef DINAL_RIG_ENERGY

/// By running it again, now with a look at all torques between the events.
const engine::Works& works_of(lua_State* L, const BodiesRunHandle& run) {
    if (run->works) return *run->works;
    if (!(run->run.t_stop > run->run.t_start)) {
        lua::raise(L, "run:energy(): there is no motion to integrate over: the run ended where it started");
    }
    const motion::Window window{run->run.t_start, run->run.t_stop};
    lua::CallState call(L);
    name_functions(call, *run->system, run->drive);
    call.set_span(window.end - window.start);
    const motion::Monitor monitor = [](double) { return !lua::interrupt_requested(); };
    const motion::Grid rows = motion::Grid::none().within(window).value();
    engine::AssemblyRun again = engine::run({.system = *run->system,
                                             .drive = run->drive,
                                             .window = window,
                                             .rows = rows,
                                             .monitor = monitor,
                                             .limits = {},
                                             .works = true});
    if (lua::interrupt_requested()) lua::raise_interrupted(L);
    if (call.failed()) call.raise_error();
    double off = 0, size = 0;
    for (std::size_t k = 0; k < again.carry->y.size(); ++k) {
        off = std::max(off, std::fabs(again.carry->y[k] - run->run.carry->y[k]));
        size = std::max(size, std::fabs(run->run.carry->y[k]));
    }
    constexpr double same = 1e-6;
    if (!(off <= same * size)) {
        lua::raise(
            L,
            "run:energy(): repeating the run for its energy gave another motion: a controller keeps a memory from "
            "one run to the next");
    }
    run->works = std::make_shared<const engine::Works>(std::move(again.works));
    return *run->works;
}

int energy_of_bodies(lua_State* L, const BodiesRunHandle& run) {
    works_of(L, run);
    lua::push<RigEnergyHandle>(L, std::make_shared<const RigEnergy>(RigEnergy{run}));
    return 1;
}

std::string story_of_bodies(lua_State* L, const BodiesRunHandle& run) {
    std::vector<RunHandle> kept;
    std::vector<const motion::Trajectory*> parts;
    for (std::size_t j = 0; j < run->system->joints.size(); ++j) {
        kept.push_back(part_of(run, j));
        parts.push_back(&kept.back()->trajectory);
    }
    const bool moved = run->run.t_stop > run->run.t_start;
    return analysis::explain(*run->system, run->drive, run->run, parts, moved ? &works_of(L, run) : nullptr);
}

void register_rig_energy(lua_State* L) {
    lua::add_class<RigEnergyHandle>(L, rig_energy_class);
}

}  // namespace dinal::api
