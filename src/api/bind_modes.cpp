// sys:modes{...}: eigenvalues at an equilibrium or in steady sliding.
#include <fmt/format.h>

#include <numbers>

#include "api/bind_modes.hpp"
#include "api/bodies.hpp"
#include "lua/user_function.hpp"
#include "lua/values.hpp"
#include "motion/engine/modes.hpp"

namespace dinal::api {

namespace {

void push_shape(lua_State* L, const model::System& system, const motion::engine::EigenMode& mode, bool quadrature) {
    lua_newtable(L);
    for (std::size_t i = 0; i < mode.shape.size(); ++i) {
        const double part = quadrature ? mode.shape[i].imag() : mode.shape[i].real();
        lua::set_number(L, system.named ? system.bodies[i].name.c_str() : "theta", part + 0.0);
    }
}

}  // namespace

int modes_of_system(lua_State* L) {
    const SystemHandle handle = lua::self<SystemHandle>(L, 1, modes_call.example);
    const model::System& system = *handle;
    const lua::Options options(L, 2, modes_call);
    const model::Drive drive = asked_drive(L, options, system);
    const auto check = [&](const model::Excitation& of, const char* name) {
        if (of.components().empty() || of.has_feedback() || of.constant_from() <= 0) return;
        options.fail(name,
                     fmt::format("{} must be constant, or depend on the motion alone: modes are those of a rest or of "
                                 "an even sliding",
                                 name));
    };
    for (const model::Excitation& load : drive.loads) check(load, "M");
    for (const model::Excitation& belt : drive.belts) check(belt, "belt");
    lua::CallState call(L);
    name_functions(call, system, drive);
    const auto modes = motion::engine::modes_beside(system, drive);
    call.check();
    if (!modes) options.fail(modes.error());
    lua_newtable(L);
    for (std::size_t k = 0; k < modes->size(); ++k) {
        const auto& mode = (*modes)[k];
        const double size = std::abs(mode.value);
        lua_newtable(L);
        lua::set_number(L, "re", mode.value.real() + 0.0);
        lua::set_number(L, "im", mode.value.imag());
        lua::set_number(L, "frequency", mode.value.imag() / (2 * std::numbers::pi));
        lua::set_number(L, "zeta", size > 0 ? -mode.value.real() / size + 0.0 : 0);
        push_shape(L, system, mode, false);
        lua_setfield(L, -2, "shape");
        push_shape(L, system, mode, true);
        lua_setfield(L, -2, "quadrature");
        lua_rawseti(L, -2, static_cast<lua_Integer>(k) + 1);
    }
    return 1;
}

}  // namespace dinal::api
