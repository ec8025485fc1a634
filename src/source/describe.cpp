#include "source/describe.hpp"

#include <fmt/format.h>

#include "model/laws/coulomb.hpp"
#include "model/laws/user_law.hpp"
#include "model/springs/user_spring.hpp"

namespace dinal::source {

std::string lua_text(lua_State* L, const model::Friction& law, ValueText* whole) {
    if (const auto* coulomb = law.as<model::laws::Coulomb>()) {
        return fmt::format("friction.coulomb{{ Rd = {}, Re = {} }}", coulomb->kinetic, coulomb->breakaway);
    }
    if (const auto* own = law.as<model::laws::UserLaw>()) {
        const std::string options = own->breakaway ? fmt::format(", {{ Re = {} }}", *own->breakaway) : "";
        return fmt::format("friction.law({}{})", function_text(L, *own->function, whole), options);
    }
    const std::string text = law.lua_text();
    return text.empty() ? "--[[ a law of friction written in C++ ]] nil" : text;
}

std::string lua_text(lua_State* L, const model::Spring& spring, ValueText* whole) {
    if (const auto* own = spring.as<model::springs::UserSpring>()) {
        return function_text(L, *own->function, whole);
    }
    const std::string text = spring.lua_text();
    return text.empty() ? "spring.polynomial{}" : text;
}

std::string lua_text(lua_State* L, const model::Oscillator& system, ValueText* whole) {
    std::string text = fmt::format("system{{ I = {}, k = {}", system.inertia(), system.stiffness());
    if (system.damping() != 0) {
        text += fmt::format(", C = {}", system.damping());
    }
    if (!system.spring().none()) {
        text += ", spring = " + lua_text(L, system.spring(), whole);
    }
    if (system.walls()) {
        text += ", walls = " + system.walls()->lua_text();
    }
    const model::Friction& law = system.friction();
    if (!law.none()) {
        text += law.as<model::laws::Coulomb>() != nullptr
                    ? fmt::format(", Rd = {}, Re = {}", system.kinetic_friction(), system.breakaway())
                    : ", friction = " + lua_text(L, law, whole);
    }
    if (!system.units().usual()) {
        text += ", units = " + system.units().lua_text();
    }
    return text + " }";
}

std::string lua_text(motion::MethodView method) {
    return method.lua_text(text::Defaults::left_out);
}

}  // namespace dinal::source
