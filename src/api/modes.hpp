// sys:modes{ ... }: eigenvalues beside a rest or an even sliding.
#pragma once

#include "api/drive_options.hpp"
#include "lua/bind.hpp"
#include "text/option.hpp"

namespace dinal::api {

inline constexpr auto modes_options = text::joined(drive_options, more_drive_options);
inline constexpr text::Call modes_call{"sys:modes", "sys:modes{ belt = 0.6 }", modes_options, true};
int modes_of_system(lua_State* L);

inline constexpr lua::Doc modes_doc{
    "sys:modes{ OPTIONS } -> table",
    "The modes of small disturbances of a rest, or of an even sliding or turning, that is found from theta0 and velocity0; "
    "it need not be stable. A list of { re, im, frequency, zeta, shape }, the slowest first: each goes with exp(re t) and "
    "turns with im (rad per time unit, 0 or more); frequency is im/(2 pi), in cycles per time unit; zeta is -re/|re + i im|, "
    "negative where the mode grows. shape has for each body { re, im } of its angle, the greatest one 1. Contacts that hold "
    "are fixed; those that slide have the slope of their law as a damping, negative where friction falls with the speed. "
    "A body that turns freely has a mode of 0 for its angle and one for its velocity. M, belt and base may not depend on "
    "the time.",
    "rig = system{ bodies = { a = { I = 1, k = 3 }, b = { I = 1, k = 3 } }, links = { rod = { \"a\", \"b\", k = 3 } } }\n"
    "for i, m in ipairs(rig:modes()) do\n"
    "    print(string.format(\"%.6f %.4f %.1f\", m.im, m.zeta, m.shape.b.re))\n"
    "end\n"
    "--> 1.732051 0.0000 1.0\n"
    "--> 3.000000 0.0000 -1.0\n"
    "squeal = system{ I = 1, k = 1, C = 0.1, friction = friction.stribeck{ Rd = 0.5, Re = 1, speed = 0.3 } }\n"
    "print(string.format(\"%.5f\", squeal:modes{ belt = 0.6 }[1].re))  --> 0.01105",
    {&modes_call}};

}  // namespace dinal::api
