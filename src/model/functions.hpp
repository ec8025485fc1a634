// Visits every user function inside a value of the model, and every option of a body or link.
#pragma once

#include <memory>
#include <utility>

#include "model/laws/coulomb.hpp"
#include "model/laws/user_law.hpp"
#include "model/springs.hpp"
#include "model/system.hpp"

namespace dinal::model {

/// The user's law in this friction, also within a sum; nullptr if there is none.
inline const laws::UserLaw* user_law(const Friction& law) {
    const auto* sum = law.as<laws::Sum<true>>();
    return (sum != nullptr ? sum->main : law).as<laws::UserLaw>();
}

// Returns the value with each user function and excitation replaced by `other` of it.

Friction with_functions(const Friction& law, auto&& other) {
    if (const auto* sum = law.as<laws::Sum<true>>()) {
        laws::Sum<true> changed = *sum;
        changed.main = with_functions(sum->main, other);
        return Friction(changed).under(law.normal());
    }
    const auto* own = law.as<laws::UserLaw>();
    if (own == nullptr) return law;
    laws::UserLaw changed = *own;
    changed.function = other(own->function);
    return Friction(changed).under(law.normal());
}

Spring with_functions(const Spring& spring, auto&& other) {
    const auto* own = spring.as<springs::UserSpring>();
    return own == nullptr ? spring : Spring(springs::UserSpring{other(own->function)});
}

Excitation with_functions(const Excitation& excitation, auto&& other) {
    return other(excitation);
}

SystemHandle with_functions(const SystemHandle& rig, auto&& other) {
    System changed = *rig;
    for (Body& body : changed.bodies) {
        if (body.moved) body.moved->motion = other(body.moved->motion);
    }
    for (Joint& joint : changed.joints) {
        ContactFriction& rubs = joint.friction;
        rubs.law = with_functions(rubs.law, other);
        for (Friction& law : rubs.listed) law = with_functions(law, other);
        joint.spring = with_functions(joint.spring, other);
        if (rubs.function != nullptr) rubs.function = other(rubs.function);
        for (auto* value :
             {rubs.sliding.data(), &rubs.sliding[1], rubs.holding.data(), &rubs.holding[1], &rubs.normal}) {
            if (*value) *value = other(**value);
        }
    }
    return std::make_shared<const System>(std::move(changed));
}

/// Writes a body or link as the options that construct it: calls give(name, value) for each option of the joint in the
/// order in which options are written. Before them come the bodies of a link: give.body(name) if it is between two,
/// otherwise give(name, weight). give.unless_0(name, number) is called for numbers that are 0 by default.
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
