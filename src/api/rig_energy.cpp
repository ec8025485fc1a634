// run:energy() and run:explain() of several bodies.
#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "analysis/energy.hpp"
#include "analysis/rig_story.hpp"
#include "api/bodies.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "lua/interrupt.hpp"
#include "lua/memory_limit.hpp"
#include "lua/vector.hpp"
#include "model/controller.hpp"

namespace dinal::api {
namespace {

namespace engine = motion::engine;

struct RigEnergy {
    BodiesRunHandle run;
    Eigen::MatrixXd columns = {};  ///< at the rows; made when first asked for
};
using RigEnergyHandle = std::shared_ptr<RigEnergy>;

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

using lua::NamedNumbers;

/// Of all: the names are those of one body.
NamedNumbers total_of_rig(const RigEnergy& energy) {
    const engine::Works& works = *energy.run->works;
    const double error = analysis::error_of(works);
    return {{"input", sum_of(works.input)},
            {"base", sum_of(works.base)},
            {"kinetic", sum_of(works.kinetic)},
            {"spring", sum_of(works.spring)},
            {"viscous", sum_of(works.viscous)},
            {"dry", sum_of(works.dry)},
            {"belt", sum_of(works.belt)},
            {"impacts", sum_of(works.impacts)},
            {"acts", works.acts},
            {"error", error},
            {"flow", works.flow},
            {"closure", works.flow > 0 ? std::fabs(error) / works.flow : 0}};
}

/// The sum over all bodies and links, at the rows.
template <analysis::EnergyColumn which>
lua::Vector column_of_rig(lua_State* L, const RigEnergyHandle& energy) {
    const BodiesRunHandle& run = energy->run;
    if (energy->columns.size() == 0) {
        Eigen::MatrixXd sum = energy_columns_of_run(L, part_of(run, 0));
        for (std::size_t j = 1; j < run->system->joints.size(); ++j) sum += energy_columns_of_run(L, part_of(run, j));
        sum.col(static_cast<Eigen::Index>(analysis::EnergyColumn::error)) *= -1;  // was the work of the others
        energy->columns = std::move(sum);
        lua::note_external_memory(L, static_cast<std::size_t>(energy->columns.size()) * sizeof(double));
    }
    return view_of(energy, energy->columns.col(static_cast<Eigen::Index>(which)));
}

/// energy.load, energy.clutch
int part_of_energy(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const BodiesRun& run = *lua::self<RigEnergyHandle>(L, 1, "energy.load")->run;
    const engine::Works& works = *run.works;
    const std::size_t joint = joint_named(L, 2, *run.system, "this energy", rig_energy_class);
    NamedNumbers numbers{{"spring", works.spring[joint]},
                         {"viscous", works.viscous[joint]},
                         {"dry", works.dry[joint]},
                         {"belt", works.belt[joint]},
                         {"impacts", works.impacts[joint]}};
    if (!run.system->is_link(joint)) {
        numbers.insert(numbers.end(),
                       {{"input", works.input[joint]}, {"base", works.base[joint]}, {"kinetic", works.kinetic[joint]}});
    }
    lua::push_value(L, numbers);
    return 1;
}

std::string rig_energy_text(const RigEnergy& energy) {
    const BodiesRun& run = *energy.run;
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
    return text;
}

#define DINAL_RIG_ENERGY                                                   \
    "rig = system{ bodies = { motor = { I = 1 }, load = { I = 3 } },\n"    \
    "    links = { clutch = { \"motor\", \"load\", Rd = 2 } } }\n"         \
    "run = rig:simulate{ velocity0 = { motor = 3 }, t_end = 4, dt = 1 }\n" \
    "energy = run:energy()\n"

#define DINAL_RIG_COLUMN(name, meaning, which, last)                                                 \
    {                                                                                                \
        lua::a_value<RigEnergyHandle, column_of_rig<analysis::EnergyColumn::which>>, {               \
            "energy." name " -> vector", meaning ", of all bodies and links together, at each row.", \
                DINAL_RIG_ENERGY "print(string.format(\"%.6g\", energy." name "[5]))  --> " last     \
        }                                                                                            \
    }

constexpr lua::Member rig_energy_members[] = {
    {lua::a_value<RigEnergyHandle, total_of_rig>,
     {"energy.total -> table",
      "The balance of the whole run, torque times rad: input + belt + base + acts = kinetic + spring + viscous + "
      "dry + impacts + error; flow, and closure = |error|/flow.",
      DINAL_RIG_ENERGY "print(energy.total.kinetic, energy.total.closure < 1e-12)  --> -3.375\ttrue"}},
    {lua::a_value<RigEnergyHandle, [](const RigEnergy& energy) { return table_column(energy.run, 0); }>,
     {"energy.t -> vector", "The times of the rows.", DINAL_RIG_ENERGY "print(energy.t[2])  --> 1.0"}},
    DINAL_RIG_COLUMN("input", "The work that M has done", input, "0"),
    DINAL_RIG_COLUMN("kinetic", "The kinetic energy", kinetic, "1.125"),
    DINAL_RIG_COLUMN("spring", "What springs have stored", spring, "0"),
    DINAL_RIG_COLUMN("viscous", "What viscous damping has taken", viscous, "0"),
    DINAL_RIG_COLUMN("dry", "What dry friction has taken", dry, "3.375"),
    DINAL_RIG_COLUMN("belt", "The work of belts", belt, "0"),
    DINAL_RIG_COLUMN("base", "The work of a shaking base", base, "0"),
    DINAL_RIG_COLUMN("acts", "What acts of events have brought", acts, "0"),
    DINAL_RIG_COLUMN("impacts", "What impacts have taken", impacts, "0"),
    {lua::a_value<RigEnergyHandle, column_of_rig<analysis::EnergyColumn::error>>,
     {"energy.error -> vector", "What does not add up, at each row.",
      DINAL_RIG_ENERGY "print(energy.error:abs():max() < 1e-12)  --> true"}},
    {lua::a_text<RigEnergyHandle, rig_energy_text>,
     {"tostring(energy) -> string", "The balance as a small table.",
      DINAL_RIG_ENERGY "print((tostring(energy):match(\"clutch.*0%s+([%d.]+)\\n\")))  --> 3.375"}},
};

}  // namespace

const lua::Class rig_energy_class = {
    "energy of several bodies",
    {"rig_run:energy() -> energy",
     "The energy of a run of several bodies: energy.total, columns as long as run.t, and for a body or link what it has of "
     "input, base, kinetic, spring, viscous, dry, belt and impacts: energy.clutch.dry. The columns and half cycles of one of "
     "them are in run.clutch:energy().",
     DINAL_RIG_ENERGY "print(energy.clutch.dry)  --> 3.375"},
    rig_energy_members,
    part_of_energy};

#undef DINAL_RIG_COLUMN
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
    call.check();
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
    run->legs = again.history;
    run->works = std::make_shared<const engine::Works>(std::move(again.works));
    return *run->works;
}

lua::Pushed energy_of_bodies(lua_State* L, const BodiesRunHandle& run) {
    works_of(L, run);
    lua::push<RigEnergyHandle>(L, std::make_shared<RigEnergy>(RigEnergy{run}));
    return {};
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
