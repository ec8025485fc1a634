// The options of sys:modes{...}.
#pragma once

#include "api/drive_options.hpp"
#include "lua/options.hpp"

namespace dinal::api {

inline constexpr text::Option own_modes_options[] = {
    {.name = "M",
     .unit = "torque",
     .otherwise = "0",
     .meaning = "constant torques, or functions of the motion; of several bodies by body or link",
     .object = "excitation"},
    {.name = "belt",
     .unit = "rad per time unit",
     .otherwise = "0",
     .meaning = "constant velocities of surfaces, on which contacts slide; of several by body or link",
     .object = "excitation"},
    {.name = "theta0",
     .unit = "rad",
     .otherwise = "0",
     .meaning = "angles from which the rest is searched, and at which contacts hold that have no belt"},
};
inline constexpr auto modes_options = text::joined(own_modes_options, states_option);
inline constexpr text::Call modes_call{"sys:modes", "sys:modes{ belt = 0.2 }", modes_options, true};

int modes_of_system(lua_State* L);

}  // namespace dinal::api
