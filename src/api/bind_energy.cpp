// What run:energy() returns: the energy balance of a run in total, for each half cycle, and as columns beside its rows.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/energy.hpp"
#include "analysis/rig_story.hpp"
#include "api/bodies.hpp"
#include "api/cards.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/run.hpp"
#include "lua/interrupt.hpp"
#include "lua/memory_limit.hpp"
#include "lua/user_function.hpp"
#include "lua/values.hpp"
#include "lua/vector.hpp"
#include "text/characters.hpp"

namespace dinal::api {

namespace {

namespace engine = motion::engine;

struct RunEnergy {
    RunHandle run = {};
    analysis::Energy energy = {};
    BodiesRunHandle rig = {};      ///< of several bodies together, instead
    Eigen::MatrixXd columns = {};  ///< at the rows; made when first asked for
};
// Shared, because a column that Lua takes out is a view that keeps it alive.
using EnergyHandle = std::shared_ptr<RunEnergy>;

bool is_part(const RunEnergy& energy) {
    return energy.energy.whose != analysis::Whose::all;
}

constexpr auto error_column = static_cast<Eigen::Index>(analysis::EnergyColumn::error);

analysis::Whose whose_of(const Run& run) {
    return !run.whole || !run.whole->system->named ? analysis::Whose::all
           : run.whole->system->is_link(run.joint) ? analysis::Whose::link
                                                   : analysis::Whose::body;
}

/// Of several bodies the sum: what the others do on one of them cancels.
void make_columns(lua_State* L, RunEnergy& energy) {
    if (energy.columns.size() > 0) return;
    lua::CallState call(L);  // a law of friction may be a user's function
    const std::size_t parts = energy.rig ? energy.rig->system->joints.size() : 1;
    for (std::size_t j = 0; j < parts; ++j) {
        const RunHandle run = energy.rig ? part_of(energy.rig, j) : energy.run;
        const Eigen::MatrixXd own = analysis::energy_columns(run->trajectory, whose_of(*run));
        call.check();
        energy.columns = j == 0 ? own : energy.columns + own;
    }
    if (is_part(energy)) energy.columns.col(error_column) *= -1;  // then it is the work of the others
    lua::note_external_memory(L, static_cast<std::size_t>(energy.columns.size()) * sizeof(double));
}

lua::Vector energy_column(lua_State* L, const EnergyHandle& handle, Eigen::Index which) {
    make_columns(L, *handle);
    return view_of(handle, handle->columns.col(which));
}

template <analysis::EnergyColumn which>
lua::Vector column_of_energy(lua_State* L, const EnergyHandle& handle) {
    return energy_column(L, handle, static_cast<Eigen::Index>(which));
}

/// What does not add up of a whole run, and the work of the others of one of several; nil of the other kind.
template <bool of_part>
std::optional<lua::Vector> rest_of_energy(lua_State* L, const EnergyHandle& handle) {
    if (is_part(*handle) != of_part) return {};
    return energy_column(L, handle, error_column);
}

lua::Vector times(const RunEnergy& energy) {
    if (energy.rig) return table_column(energy.rig, 0);
    return view_of(energy.run, energy.run->trajectory.column(motion::Column::t));
}

using lua::NamedNumbers;

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Of all: the names are those of one body.
NamedNumbers total_of_rig(const RunEnergy& energy) {
    const engine::Works& works = *energy.rig->works;
    const double error = analysis::error_of(works);
    return {{"input", sum_of(works.input)},
            {"kinetic", sum_of(works.kinetic)},
            {"spring", sum_of(works.spring)},
            {"viscous", sum_of(works.viscous)},
            {"dry", sum_of(works.dry)},
            {"error", error},
            {"belt", sum_of(works.belt)},
            {"base", sum_of(works.base)},
            {"acts", works.acts},
            {"impacts", sum_of(works.impacts)},
            {"flow", works.flow},
            {"closure", works.flow > 0 ? std::fabs(error) / works.flow : 0}};
}

void add_balance(NamedNumbers& numbers, const analysis::Balance& balance, bool part) {
    const motion::Work& work = balance.work;
    numbers.insert(numbers.end(), {{"input", work.input},
                                   {"kinetic", balance.change.kinetic},
                                   {"spring", balance.change.spring},
                                   {"viscous", work.viscous},
                                   {"dry", work.dry},
                                   {part ? "others" : "error", part ? -balance.error() : balance.error()},
                                   {"belt", work.belt},
                                   {"base", work.base},
                                   {"acts", work.acts},
                                   {"impacts", work.impacts}});
}

NamedNumbers total(const RunEnergy& own) {
    if (own.rig) return total_of_rig(own);
    NamedNumbers numbers;
    add_balance(numbers, own.energy.total, is_part(own));
    if (!is_part(own)) {
        numbers.insert(numbers.end(), {{"flow", own.energy.flow}, {"closure", own.energy.closure()}});
    }
    return numbers;
}

template <auto member>
std::optional<NamedNumbers> stored(const RunEnergy& own) {
    if (own.rig) return {};
    const auto& energy = own.energy.*member;
    return NamedNumbers{{"kinetic", energy.kinetic}, {"spring", energy.spring}};
}

std::optional<std::vector<NamedNumbers>> half_cycles(const RunEnergy& own) {
    if (own.rig) return {};
    std::vector<NamedNumbers> list;
    for (const auto& half : own.energy.half_cycles) {
        list.push_back({{"t_start", half.t_start},
                        {"t_end", half.t_end},
                        {"theta_start", half.theta_start},
                        {"theta_end", half.theta_end}});
        add_balance(list.back(), half.balance, is_part(own));
    }
    return list;
}

/// energy.load, energy.clutch
int part_of_energy(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const auto& energy = lua::self<EnergyHandle>(L, 1, "energy.load");
    if (energy->rig == nullptr) return 0;
    const BodiesRun& run = *energy->rig;
    const engine::Works& works = *run.works;
    const std::size_t joint = joint_named(L, 2, *run.system, "this energy", energy_class);
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

std::string text_of_rig(const RunEnergy& energy) {
    const BodiesRun& run = *energy.rig;
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

std::string text_of_energy(const RunEnergy& energy) {
    return energy.rig ? text_of_rig(energy) : analysis::text(energy.energy, units_of(*energy.run));
}

#define DINAL_ENERGY                                                             \
    "run = system{ I = 1, k = 1, Rd = 0.12 }:simulate{ theta0 = 1, t_end = 20, " \
    "dt = 5 }\nenergy = run:energy()\n"

constexpr lua::Member energy_members[] = {
    {lua::a_value<EnergyHandle, total>,
     {"energy.total -> table",
      "The balance of the whole run, torque times rad: input (work of M) = kinetic + spring (changes of stored energy) "
      "+ viscous + dry (dissipated by the two frictions) + error. flow is the work of M, spring and inertia in all half "
      "cycles together, closure is |error|/flow. belt, base and acts are the work of a belt, a base and the acts of "
      "events, added to the input; impacts is the loss at walls. For a body or link among several, others is the work "
      "of the others on it and replaces error.",
      DINAL_ENERGY
      "print(string.format(\"%.6f %.6f\", energy.total.dry, energy.total.spring))  --> 0.499200 -0.499200\n"
      "print(energy.total.closure < 1e-12)  --> true"}},
    {lua::a_kept_value<EnergyHandle, half_cycles>,
     {"energy.half_cycles -> table",
      "The balance of each motion from one zero of the velocity to the next: { t_start, t_end, theta_start, "
      "theta_end, input, kinetic, spring, viscous, dry, error }. The ends of the run may cut off the first and the "
      "last. Times of sticking have no entry.",
      DINAL_ENERGY "for _, half in ipairs(energy.half_cycles) do\n"
                   "    print(string.format(\"%.2f %.2f %.4f\", half.theta_start, half.theta_end, half.dry))\n"
                   "end\n"
                   "--> 1.00 -0.76 0.2112\n"
                   "--> -0.76 0.52 0.1536\n"
                   "--> 0.52 -0.28 0.0960\n"
                   "--> -0.28 0.04 0.0384"}},
    {lua::a_value<EnergyHandle, stored<&analysis::Energy::start>>,
     {"energy.start -> table", "The energy stored at the start: { kinetic, spring }, torque times rad.",
      DINAL_ENERGY "print(energy.start.spring)  --> 0.5"}},
    {lua::a_value<EnergyHandle, stored<&analysis::Energy::finish>>,
     {"energy.finish -> table", "The energy stored at the end: { kinetic, spring }, torque times rad.",
      DINAL_ENERGY "print(energy.finish.kinetic)  --> 0.0"}},
    {lua::a_value<EnergyHandle, times>,
     {"energy.t -> vector", "The times of the rows, run.t.", DINAL_ENERGY "print(energy.t[2])  --> 5.0"}},
    {lua::a_value<EnergyHandle, column_of_energy<analysis::EnergyColumn::input>>,
     {"energy.input -> vector", "The work of M since the start, at each row.",
      DINAL_ENERGY "print(energy.input:max())  --> 0.0"}},
    {lua::a_value<EnergyHandle, column_of_energy<analysis::EnergyColumn::kinetic>>,
     {"energy.kinetic -> vector", "The kinetic energy I velocity^2/2 at each row.",
      DINAL_ENERGY "print(energy.kinetic[1])  --> 0.0"}},
    {lua::a_value<EnergyHandle, column_of_energy<analysis::EnergyColumn::spring>>,
     {"energy.spring -> vector", "The energy k theta^2/2 of the spring at each row, plus that of a second spring.",
      DINAL_ENERGY "print(energy.spring[1])  --> 0.5"}},
    {lua::a_value<EnergyHandle, column_of_energy<analysis::EnergyColumn::viscous>>,
     {"energy.viscous -> vector", "The loss by viscous damping since the start, at each row.",
      DINAL_ENERGY "print(energy.viscous:max())  --> 0.0"}},
    {lua::a_value<EnergyHandle, column_of_energy<analysis::EnergyColumn::dry>>,
     {"energy.dry -> vector", "The loss by dry friction since the start, at each row.",
      DINAL_ENERGY "print(string.format(\"%.6f\", energy.dry[#run]))  --> 0.499200"}},
    {lua::a_value<EnergyHandle, rest_of_energy<false>>,
     {"energy.error -> vector",
      "What does not add up at each row: input less the changes of kinetic and spring, viscous and dry.",
      DINAL_ENERGY "print(energy.error:abs():max() < 1e-12)  --> true"}},
    {lua::a_value<EnergyHandle, rest_of_energy<true>>,
     {"energy.others -> vector or nil",
      "Of a body or link among several, in place of error: the work that its links, or its bodies, have done on it since the "
      "start, at each row. nil of a whole run.",
      "rig = system{ bodies = { a = { I = 1 }, b = { I = 1 } }, links = { rod = { \"a\", \"b\", C = 1 } } }\n"
      "run = rig:simulate{ velocity0 = { a = 1 }, t_end = 50 }\n"
      "print(string.format(\"%.6f\", run.rod:energy().others[#run]))  --> 0.250000"}},
    {lua::a_value<EnergyHandle, column_of_energy<analysis::EnergyColumn::belt>>,
     {"energy.belt -> vector", "The work of the belt on the mass since the start, at each row.",
      DINAL_ENERGY "print(energy.belt:max())  --> 0.0"}},
    {lua::a_value<EnergyHandle, column_of_energy<analysis::EnergyColumn::base>>,
     {"energy.base -> vector", "The work of the base on the mass since the start, at each row.",
      DINAL_ENERGY "print(energy.base:max())  --> 0.0"}},
    {lua::a_value<EnergyHandle, column_of_energy<analysis::EnergyColumn::acts>>,
     {"energy.acts -> vector", "The energy added by acts of events since the start, at each row.",
      DINAL_ENERGY "print(energy.acts:max())  --> 0.0"}},
    {lua::a_value<EnergyHandle, column_of_energy<analysis::EnergyColumn::impacts>>,
     {"energy.impacts -> vector", "The loss by impacts at walls since the start, at each row.",
      "run = system{ I = 2, k = 0, walls = { upper = 1, restitution = 0.5 } }:simulate{ velocity0 = 2, t_end = 1, "
      "dt = 1 }\n"
      "print(run:energy().impacts[2])  --> 3.0"}},
    {lua::a_text<EnergyHandle, text_of_energy>,
     {"tostring(energy) -> string", "The balance of the whole run as a small table.",
      DINAL_ENERGY "print(tostring(energy):match(\"[^\\n]*\"))\n"
                   "--> energy, t 0 … 20: input = kinetic + spring + viscous + dry"}},
};

}  // namespace

const lua::Class energy_class = {
    "energy",
    {"run:energy() -> energy",
     "The energy balance of a run: total, half_cycles, and columns as long as run.t. It cannot be changed. For a run of "
     "several bodies they are sums, half_cycles, start and finish are nil, and for each body and link there is a table "
     "of its input, base, kinetic, spring, viscous, dry, belt and impacts: energy.clutch.dry. run.clutch:energy() has "
     "the columns and half cycles of one.",
     DINAL_ENERGY "print(#energy.half_cycles)  --> 4\n"
                  "rig = system{ bodies = { motor = { I = 1 }, load = { I = 3 } },\n"
                  "    links = { clutch = { \"motor\", \"load\", Rd = 2 } } }\n"
                  "print(rig:simulate{ velocity0 = { motor = 3 }, t_end = 4 }:energy().clutch.dry)  --> 3.375"},
    energy_members,
    lua::guarded<part_of_energy>,
    energy_card};

#undef DINAL_ENERGY

std::string energy_card(lua_State* L, int index, const terminal::Display& screen) {
    const RunEnergy& energy = **lua::test<EnergyHandle>(L, index);
    if (energy.rig) return text_of_rig(energy);
    constexpr std::size_t name_and_number = 23;
    std::string card;
    const std::string whole = terminal::spelled(text_of_energy(energy), screen);
    for (std::string_view rest = whole; !rest.empty();) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        const bool fits = text::columns(line) < screen.width || !line.starts_with(' ');
        card.append(card.empty() ? "" : "\n").append(fits ? line : line.substr(0, name_and_number));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    }
    return text::wrapped(card, screen.width - 1);
}

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

lua::Pushed energy_of_run(lua_State* L, const RunHandle& run) {
    if (run->whole) works_of(L, run->whole);  // with the torques between the rows
    lua::CallState call(L);
    auto energy = analysis::energy_of(run->trajectory, whose_of(*run));
    call.check();
    lua::push<EnergyHandle>(L, std::make_shared<RunEnergy>(RunEnergy{
                                   .run = run, .energy = lua::value_or_raise(L, "run:energy()", std::move(energy))}));
    return {};
}

lua::Pushed energy_of_bodies(lua_State* L, const BodiesRunHandle& run) {
    works_of(L, run);
    lua::push<EnergyHandle>(L, std::make_shared<RunEnergy>(RunEnergy{.rig = run}));
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

void register_energy(lua_State* L) {
    lua::add_class<EnergyHandle>(L, energy_class);
}

}  // namespace dinal::api
