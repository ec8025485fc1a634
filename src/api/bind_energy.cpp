// The energy balance returned by run:energy(): in total, for each half cycle, and as columns for the rows.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/energy.hpp"
#include "analysis/explain.hpp"
#include "api/bodies.hpp"
#include "api/cards.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/lua_run.hpp"
#include "lua/memory_limit.hpp"
#include "lua/values.hpp"
#include "lua/vector.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::api {

namespace {

struct RunEnergy {
    RunHandle run = {};
    analysis::Energy energy = {};
    std::vector<analysis::Energy> parts = {};  ///< the energies of which it is the sum
    Eigen::MatrixXd columns = {};              ///< at the rows; computed on first use
};
// Shared, because a column in Lua is a view of these values and keeps them alive.
using EnergyHandle = std::shared_ptr<RunEnergy>;

bool is_part(const RunEnergy& energy) {
    return energy.energy.whose != analysis::Whose::all;
}

constexpr auto error_column = static_cast<Eigen::Index>(analysis::EnergyColumn::error);

analysis::Whose whose_of(const LuaRun& run) {
    return !run.joint || run.system().joints.size() == 1 ? analysis::Whose::all
           : run.of_body()                               ? analysis::Whose::body
                                                         : analysis::Whose::link;
}

/// Computes the columns; for several bodies the sum, in which the work between them cancels.
void make_columns(lua_State* L, RunEnergy& energy) {
    if (energy.columns.size() > 0) return;
    RunCall call(L, *energy.run);  // a friction law may be a user's function
    for (const RunHandle& part : parts_of(energy.run)) {
        const Eigen::MatrixXd own = analysis::energy_columns(part->result, whose_of(*part));
        call.check();
        energy.columns = energy.columns.size() == 0 ? own : energy.columns + own;
    }
    if (is_part(energy)) energy.columns.col(error_column) *= -1;  // the negative error is the work of the other bodies
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

/// The closure error of a whole run, or the work of the other bodies on a part; nil for the other kind.
template <bool of_part>
std::optional<lua::Vector> rest_of_energy(lua_State* L, const EnergyHandle& handle) {
    if (is_part(*handle) != of_part) return {};
    return energy_column(L, handle, error_column);
}

lua::Vector times(const RunEnergy& energy) {
    return view_of(energy.run, energy.run->result.column(motion::Column::t));
}

using lua::NamedNumbers;

void add_balance(NamedNumbers& numbers, const analysis::EnergyBalance& balance, bool part) {
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
    NamedNumbers numbers;
    add_balance(numbers, own.energy.total, is_part(own));
    if (!is_part(own)) {
        numbers.insert(numbers.end(), {{"flow", own.energy.flow}, {"closure", own.energy.closure()}});
    }
    return numbers;
}

template <auto member>
NamedNumbers stored(const RunEnergy& own) {
    const auto& energy = own.energy.*member;
    return {{"kinetic", energy.kinetic}, {"spring", energy.spring}};
}

std::optional<std::vector<NamedNumbers>> half_cycles(const RunEnergy& own) {
    if (own.parts.size() > 1) return {};
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

/// energy.load, energy.clutch: pushes the energy of a body or link. Their names come before those of the columns, as a
/// link may well be called belt or spring.
int part_of_energy(lua_State* L) {
    const auto* energy = lua::test<EnergyHandle>(L, 1);
    if (energy == nullptr || lua_type(L, 2) != LUA_TSTRING || !(*energy)->run->of_all()) return 0;
    const auto named = (*energy)->run->system().joint_named(lua_tostring(L, 2));
    if (!named) return 0;
    NamedNumbers numbers;
    add_balance(numbers, (*energy)->parts[*named].total, true);
    lua::push_value(L, numbers);
    return 1;
}

/// Raises the error for a name that is neither a column nor a body or link.
int no_part_of_energy(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const LuaRun& run = *lua::self<EnergyHandle>(L, 1, "energy.load")->run;
    if (run.of_all()) joint_named(L, lua_tostring(L, 2), run.system(), "this energy", energy_class);
    return 0;
}

std::string text_of_rig(const RunEnergy& energy) {
    const auto& joints = energy.run->system().joints;
    const analysis::Energy& all = energy.energy;
    const auto shown = [&](double x) { return std::fabs(x) <= 1e-15 * all.flow ? 0.0 : x; };
    std::string text =
        fmt::format("energy, t {:.9g} … {:.9g}: input = kinetic + spring + viscous + dry\n", all.t_start, all.t_end);
    std::size_t width = 5;
    for (const model::Joint& joint : joints) width = std::max(width, joint.name.size());
    text += fmt::format("  {:<{}}{:>13}{:>13}{:>13}{:>13}{:>13}\n", "", width, "input", "kinetic", "spring", "viscous",
                        "dry");
    const auto line = [&](const std::string& name, const analysis::EnergyBalance& own) {
        text += fmt::format("  {:<{}}{:>13.6g}{:>13.6g}{:>13.6g}{:>13.6g}{:>13.6g}\n", name, width,
                            shown(own.work.input), shown(own.change.kinetic), shown(own.change.spring),
                            shown(own.work.viscous), shown(own.work.dry));
    };
    for (std::size_t j = 0; j < joints.size(); ++j) line(joints[j].name, energy.parts[j].total);
    line("all", all.total);
    const motion::Work& work = all.total.work;
    for (const auto& [name, value] :
         {std::pair("belt", work.belt), std::pair("base", work.base), std::pair("acts", work.acts)}) {
        if (value != 0) text += fmt::format("  {} {:.6g} was added\n", name, shown(value));
    }
    if (work.impacts != 0) text += fmt::format("  impacts {:.6g} were lost\n", shown(work.impacts));
    text += fmt::format("  error {:.2g}, {:.1g} of {:.6g} that flowed", all.total.error(), all.closure(), all.flow);
    return text;
}

std::string text_of_energy(const RunEnergy& energy) {
    return energy.parts.size() > 1 ? text_of_rig(energy) : analysis::text(energy.energy, units_of(*energy.run));
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
     "several bodies they are sums, half_cycles is nil, and each body and link has its own balance, as in "
     "energy.clutch.dry, before a column of that name. run.clutch:energy() has the columns and half cycles of one.",
     DINAL_ENERGY "print(#energy.half_cycles)  --> 4\n"
                  "rig = system{ bodies = { motor = { I = 1 }, load = { I = 3 } },\n"
                  "    links = { clutch = { \"motor\", \"load\", Rd = 2 } } }\n"
                  "print(rig:simulate{ velocity0 = { motor = 3 }, t_end = 4 }:energy().clutch.dry)  --> 3.375"},
    energy_members,
    lua::add_class<EnergyHandle>,
    lua::guarded<no_part_of_energy>,
    energy_card,
    lua::guarded<part_of_energy>};

#undef DINAL_ENERGY

std::string energy_card(lua_State* L, int index, const terminal::Display& screen) {
    const RunEnergy& energy = **lua::test<EnergyHandle>(L, index);
    if (energy.parts.size() > 1) return text_of_rig(energy);
    constexpr std::size_t name_and_number = 23;
    std::string card;
    const std::string whole = terminal::spelled(text_of_energy(energy), screen);
    for (const std::string_view line : text::split(whole, '\n')) {
        const bool fits = text::columns(line) < screen.width || !line.starts_with(' ');
        card.append(card.empty() ? "" : "\n").append(fits ? line : line.substr(0, name_and_number));
    }
    return text::wrapped(card, screen.width - 1);
}

namespace {

/// The energies of the parts of a run; fails with the first error.
text::Expected<std::vector<analysis::Energy>> energies_of(lua_State* L, const std::vector<RunHandle>& parts) {
    RunCall call(L, *parts.front());  // a friction law may be a user's function
    std::vector<analysis::Energy> energies;
    for (const RunHandle& part : parts) {
        auto energy = analysis::energy_of(part->result, whose_of(*part));
        call.check();
        if (!energy) return energy.error();
        energies.push_back(std::move(energy).value());
    }
    return energies;
}

}  // namespace

lua::Pushed energy_of_run(lua_State* L, const RunHandle& run) {
    auto parts = lua::value_or_raise(L, "run:energy()", energies_of(L, parts_of(run)));
    auto energy = std::make_shared<RunEnergy>(
        RunEnergy{.run = run, .energy = run->joint ? parts.front() : analysis::sum_of(parts), .parts = {}});
    energy->parts = std::move(parts);
    lua::push<EnergyHandle>(L, std::move(energy));
    return {};
}

std::string story_of_simulated(lua_State* L, const RunHandle& run) {
    const std::vector<RunHandle> parts = parts_of(run);
    std::vector<const motion::Run*> seen(run->system().joints.size(), &run->result);
    if (run->of_all()) std::ranges::transform(parts, seen.begin(), [](const RunHandle& part) { return &part->result; });
    model::Drive drive = run->origin->drive;
    if (run->terms) drive.loads = {*run->terms};
    std::vector<analysis::Energy> energies;
    if (!run->system().is_plain()) {
        if (auto known = energies_of(L, parts)) energies = std::move(known).value();
    }
    return analysis::explain({.system = run->system(),
                              .drive = drive,
                              .parts = std::move(seen),
                              .method = run->origin->integrator,
                              .joint = run->joint},
                             energies);
}

}  // namespace dinal::api
