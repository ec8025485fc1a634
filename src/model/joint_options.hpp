// Writes a body or link as the options that construct it.
#pragma once

#include "model/laws/coulomb.hpp"
#include "model/system.hpp"

namespace dinal::model {

/// Calls give(name, value) for each option of the joint in the order in which options are written. Before them come the
/// bodies of a link: give.body(name) if it is between two, otherwise give(name, weight). give.unless_0(name, number) is
/// called for numbers that are 0 by default.
template <class Give>
void give_options(const System& system, std::size_t j, Give& give) {
    const Joint& joint = system.joints[j];
    const ContactFriction& friction = joint.friction;
    const auto given = [&give](const char* name, const auto& value) {
        if (value) give(name, *value);
    };
    if (system.is_link(j)) {
        const bool two = joint.of.size() == 2 && joint.of[0].by == 1;
        for (const auto& [body, by] : joint.of) {
            const std::string& name = system.bodies[body].name;
            two ? give.body(name) : give(name.c_str(), by);
        }
        if (two && !joint.is_difference()) give("ratio", -joint.of[1].by);
        if (joint.rigid) return give("rigid", true);
    } else {
        const Body& body = system.bodies[j];
        if (!body.moved || !body.moved->without_inertia) give("I", body.inertia);
        if (body.moved) give(body.moved->by_angle ? "theta" : "velocity", body.moved->motion);
    }
    system.named ? give.unless_0("k", joint.stiffness) : give("k", joint.stiffness);
    give.unless_0("C", joint.damping);
    if (!joint.spring.none()) give("spring", joint.spring);
    if (const Walls* walls = joint.any_walls()) give("walls", *walls);
    given("friction", friction.function);
    given("Rd", friction.sliding[1]);
    given("Re", friction.holding[1]);
    const Friction law = friction.law.under(1);
    if (!friction.listed.empty()) {
        give("friction", friction.listed);
    } else if (!friction.sliders.empty()) {
        give("friction", Friction(friction.sliders.front()));
    } else if (const auto* coulomb = law.as<laws::Coulomb>()) {
        law.none() ? give.unless_0("Rd", coulomb->kinetic) : give("Rd", coulomb->kinetic);
        give.unless_0("Re", coulomb->breakaway);
    } else if (!law.none()) {
        give("friction", law);
    }
    if (friction.law.normal() != 1) give("normal", friction.law.normal());
    given("normal", friction.normal);
}

}  // namespace dinal::model
