#include "model/system.hpp"

#include <fmt/format.h>

namespace dinal::model {

std::string System::angle_in_words(const Joint& joint) const {
    std::string sum;
    for (const auto& [body, by] : joint.of) {
        sum += by < 0 ? (sum.empty() ? "-" : " - ") : (sum.empty() ? "" : " + ");
        if (std::fabs(by) != 1) sum += fmt::format("{:.6g} ", std::fabs(by));
        sum += bodies[body].name;
    }
    return sum;
}

System as_system(const Oscillator& body) {
    Joint ground;
    ground.stiffness = body.stiffness(), ground.damping = body.damping();
    ground.spring = body.spring(), ground.friction.law = body.friction(), ground.walls = body.walls();
    return {.bodies = {{"", body.inertia()}}, .joints = {ground}, .named = false, .units = body.units()};
}

text::Expected<Oscillator> oscillator_at(const System& system, std::size_t joint) {
    const Joint& own = system.joints[joint];
    OscillatorParameters parameters;
    constexpr double none = 1e-100;  // inertia of a body with prescribed motion
    double lightness = 0;            // such a body resists a link as if it were infinitely heavy
    for (const auto& [body, by] : own.of) {
        if (!system.bodies[body].moved) lightness += by * by / system.bodies[body].inertia;
    }
    parameters.inertia = !system.is_link(joint) ? system.bodies[joint].inertia : lightness > 0 ? 1 / lightness : 0;
    if (parameters.inertia == 0) parameters.inertia = none;
    parameters.stiffness = own.stiffness, parameters.damping = own.damping, parameters.units = system.units;
    parameters.spring = own.spring, parameters.walls = own.walls;
    if (!own.friction.law.under(1).none() && !own.friction.law.is_one_way()) parameters.friction = own.friction.law;
    parameters.normal = own.friction.law.normal();
    return Oscillator::make(parameters);
}

}  // namespace dinal::model
