#include "source/describe.hpp"

#include <fmt/format.h>

namespace dinal::source {

std::string lua_text(const model::Oscillator& system) {
    std::string text = fmt::format("system{{ I = {}, k = {}", system.inertia(), system.stiffness());
    if (system.damping() != 0) {
        text += fmt::format(", C = {}", system.damping());
    }
    if (!system.friction().none()) {
        text += fmt::format(", Rd = {}, Re = {}", system.kinetic_friction(), system.breakaway());
    }
    return text + " }";
}

std::string lua_text(motion::MethodView method) {
    return method.lua_text(text::Defaults::left_out);
}

}  // namespace dinal::source
