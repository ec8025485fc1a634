#include "source/describe.hpp"

#include <fmt/format.h>

#include <cmath>

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

std::string lua_text(const motion::Integrator& integrator) {
    if (const auto* method = std::get_if<motion::Spectral>(&integrator)) {
        std::string options;
        if (method->tolerance != motion::Spectral{}.tolerance)
            options = fmt::format("tolerance = {}", method->tolerance);
        if (std::isfinite(method->max_panel)) {
            options += fmt::format("{}max_panel = {}", options.empty() ? "" : ", ", method->max_panel);
        }
        return options.empty() ? "integrator.spectral{}" : fmt::format("integrator.spectral{{ {} }}", options);
    }
    if (const auto* method = std::get_if<motion::Rk4>(&integrator)) {
        return fmt::format("integrator.rk4{{ h = {} }}", method->h);
    }
    const auto& method = std::get<motion::Dinal1989>(integrator);
    return fmt::format("integrator.dinal1989{{ h = {}{}{} }}", method.h,
                       method.stop == motion::Dinal1989::Stop::text ? ", stop = \"text\"" : "",
                       method.slip ? ", slip = true" : "");
}

}  // namespace dinal::source
