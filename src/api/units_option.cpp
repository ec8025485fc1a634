#include "api/units_option.hpp"

#include <array>
#include <utility>

namespace dinal::api {

std::optional<model::Units> asked_units(lua_State* L, const lua::Options& options) {
    if (!options.has("units")) {
        return std::nullopt;
    }
    options.push("units");
    if (lua_type(L, -1) != LUA_TTABLE) {
        options.wrong("units", options.row("units").wanted);
    }
    auto units = lua::read<model::Units>(L, lua_gettop(L), model::units_call);
    lua_pop(L, 1);
    if (const auto wrong = units.complaint()) {
        options.fail(*wrong);
    }
    return units;
}

const model::Units& units_of(const Run& run) {
    return run.origin ? run.origin->system.units() : run.units;
}

int push_units(lua_State* L, const model::Units& units) {
    lua_createtable(L, 0, 3);
    for (const auto& [name, unit] : std::array<std::pair<const char*, const std::string*>, 3>{
             {{"theta", &units.theta}, {"t", &units.t}, {"M", &units.M}}}) {
        if (!unit->empty()) {
            lua::push_text(L, *unit);
            lua_setfield(L, -2, name);
        }
    }
    return 1;
}

}  // namespace dinal::api
