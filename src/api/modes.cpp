#include "api/modes.hpp"

#include <cmath>
#include <numbers>

#include "analysis/rest_modes.hpp"
#include "analysis/returns.hpp"
#include "api/bodies.hpp"
#include "api/steady_answer.hpp"
#include "lua/values.hpp"

namespace dinal::api {

int modes_of_system(lua_State* L) {
    const AssemblyHandle system = lua::self<AssemblyHandle>(L, 1, modes_call.example);
    const lua::Options options(L, 2, modes_call);
    auto question = analysis::SteadyQuestion::of(system, asked_drive(L, options, *system));
    std::optional<text::Expected<std::vector<analysis::RestMode>>> found;
    bool timeless = false;
    asking(L, question, [&](const motion::Monitor& monitor) {
        const auto repeats = analysis::repetition_of(question);
        timeless = repeats && repeats->period == 0;
        if (!timeless) return;
        question.repeats = *repeats;
        found = analysis::modes_beside_rest(question, monitor);
    });
    if (!timeless) options.fail("M", "M, belt and base must not depend on the time: modes are those of a rest");
    const auto modes = options.value_or_fail(std::move(*found));
    lua_createtable(L, static_cast<int>(modes.size()), 0);
    for (std::size_t i = 0; i < modes.size(); ++i) {
        const std::complex<double> value = modes[i].value;
        lua_newtable(L);
        lua::set_number(L, "re", value.real());
        lua::set_number(L, "im", value.imag());
        lua::set_number(L, "frequency", value.imag() / (2 * std::numbers::pi));
        if (value != 0.0) lua::set_number(L, "zeta", -value.real() / std::abs(value));
        lua_newtable(L);
        for (std::size_t b = 0; b < modes[i].angles.size(); ++b) {
            lua_newtable(L);
            lua::set_number(L, "re", modes[i].angles[b].real());
            lua::set_number(L, "im", modes[i].angles[b].imag());
            system->named ? lua_setfield(L, -2, system->bodies[b].name.c_str()) : lua_rawseti(L, -2, 1);
        }
        lua_setfield(L, -2, "shape");
        lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
    }
    return 1;
}

}  // namespace dinal::api
