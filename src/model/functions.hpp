// Visits every user function inside a value of the model.
#pragma once

#include <memory>
#include <utility>

#include "model/laws/user_law.hpp"
#include "model/springs/user_spring.hpp"
#include "model/system.hpp"

namespace dinal::model {

// Returns the value with each user function and excitation replaced by `other` of it.

Friction with_functions(const Friction& law, auto&& other) {
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

}  // namespace dinal::model
