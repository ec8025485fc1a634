// The option `units` of pictures of a run: what theta and t are measured in.
#pragma once

#include "lua/options.hpp"
#include "plots/run_figure.hpp"
#include "text/option.hpp"

namespace dinal::api {

inline constexpr text::Option unit_options[] = {
    {.name = "theta",
     .otherwise = "\"rad\"",
     .meaning = "of the angle, or of the way",
     .filled = text::fills<&plots::Units::theta>},
    {.name = "t", .meaning = "of the time, else it has none", .filled = text::fills<&plots::Units::t>},
};
inline constexpr text::Option units_option[] = {
    {.name = "units",
     .meaning = "what theta and t are measured in, for the axes: { theta = \"m\", t = \"s\" }",
     .wanted = "a table such as { theta = \"m\", t = \"s\" }"},
};

/// What it says; rad, and no unit of time, when it is absent.
inline plots::Units asked_units(lua_State* L, const lua::Options& options) {
    if (!options.has("units")) {
        return {};
    }
    options.push("units");
    if (lua_type(L, -1) != LUA_TTABLE) {
        options.wrong("units", options.row("units").wanted);
    }
    const text::Call own{"units", "units = { theta = \"m\", t = \"s\" }", unit_options};
    auto units = lua::read<plots::Units>(L, lua_gettop(L), own);
    lua_pop(L, 1);
    return units;
}

}  // namespace dinal::api
