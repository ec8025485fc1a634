// Objects of our classes, carried: what is native is shared, a user's functions in them are carried, too.
#include <fmt/format.h>

#include "lua/user_function.hpp"
#include "lua/vector.hpp"
#include "model/controller.hpp"
#include "model/laws/user_law.hpp"
#include "model/springs/user_spring.hpp"
#include "motion/integrators.hpp"
#include "source/carry.hpp"

namespace dinal::source {

bool Carrier::object(int index) {
    if (const auto* vector = lua::test<lua::Vector>(from_, index)) {
        lua::push(to_, *vector);
    } else if (const auto* integrator = lua::test<motion::Integrator>(from_, index)) {
        lua::push(to_, *integrator);
    } else if (const auto* law = lua::test<model::Friction>(from_, index)) {
        model::Friction copy;
        if (!friction(*law, copy)) return false;
        lua::push(to_, copy);
    } else if (const auto* spring = lua::test<model::Spring>(from_, index)) {
        model::Spring copy;
        if (!own_spring(*spring, copy)) return false;
        lua::push(to_, copy);
    } else if (const auto* system = lua::test<model::Oscillator>(from_, index)) {
        model::Friction copy;
        model::OscillatorParameters parameters = system->parameters();
        if (!friction(system->friction(), copy) || !own_spring(system->spring(), parameters.spring)) return false;
        if (parameters.friction) parameters.friction = copy;
        lua::push(to_, model::Oscillator::make(parameters).value());
    } else if (const auto* rig = lua::test<model::AssemblyHandle>(from_, index)) {
        model::Assembly copy = **rig;
        for (model::Joint& own : copy.joints) {
            if (!joint(own)) return false;
        }
        lua::push<model::AssemblyHandle>(to_, std::make_shared<const model::Assembly>(std::move(copy)));
    } else if (const auto* own = lua::test<model::Excitation>(from_, index)) {
        if (!excitation(*own)) return false;
    } else if (!other_objects_(from_, index, to_)) {
        const lua::Documented found = lua::documented(from_, index);
        const bool run = found.owner != nullptr && std::string_view(found.owner->name) == "run";
        return fail(index, run ? "; extract what you need before, for example local theta = run.theta" : "");
    }
    remember(lua_topointer(from_, index));
    return true;
}

/// With the functions of the other state in the place of those of this one.
bool Carrier::joint(model::Joint& own) {
    const auto varying = [&](std::optional<model::Excitation>& value) {
        if (!value) return true;
        if (!excitation(*value)) return false;
        value = *lua::test<model::Excitation>(to_, -1);
        lua_pop(to_, 1);
        return true;
    };
    model::ContactFriction& rubs = own.friction;
    model::Friction law;
    if (!friction(rubs.law, law) || !own_spring(model::Spring(own.spring), own.spring)) return false;
    rubs.law = law;
    if (rubs.function != nullptr) {
        rubs.function = user_function(*rubs.function, "its friction");
        if (rubs.function == nullptr) return false;
    }
    return varying(rubs.sliding[0]) && varying(rubs.sliding[1]) && varying(rubs.holding[0]) &&
           varying(rubs.holding[1]) && varying(rubs.normal);
}

/// nullptr when it fails.
std::shared_ptr<model::terms::UserFunction> Carrier::user_function(const model::terms::UserFunction& function,
                                                                   const char* what) {
    const auto* own = dynamic_cast<const lua::LuaFunction*>(&function);
    if (own == nullptr) return controller(function);
    way_.push_back(fmt::format(" > {}", what));
    own->push(from_);
    const bool good = value(-1);
    lua_pop(from_, 1);
    if (!good) return nullptr;
    way_.pop_back();
    auto copy = std::make_shared<lua::LuaFunction>(to_, lua_gettop(to_), own->role());
    lua_pop(to_, 1);
    if (!own->push_start(from_)) return copy;
    way_.emplace_back(" > start");
    const bool starts = value(-1);
    lua_pop(from_, 1);
    if (!starts) return nullptr;
    way_.pop_back();
    copy->remember_from(to_, -1);
    lua_pop(to_, 1);
    return copy;
}

std::shared_ptr<model::terms::UserFunction> Carrier::controller(const model::terms::UserFunction& function) {
    const auto& own = dynamic_cast<const model::Controller&>(function);
    std::shared_ptr<model::terms::UserFunction> carried;
    if (own.function != nullptr && (carried = user_function(*own.function, "its function")) == nullptr) return nullptr;
    if (const auto* relay = dynamic_cast<const model::RelayController*>(&own)) return model::copied(*relay, carried);
    if (const auto* delayed = dynamic_cast<const model::DelayedController*>(&own)) {
        auto copy = std::make_shared<model::DelayedController>();
        copy->function = carried, copy->by = delayed->by;
        return copy;
    }
    const auto& sampled = dynamic_cast<const model::SampledController&>(own);
    auto copy = std::make_shared<model::SampledController>();
    copy->function = carried, copy->carried = true;
    copy->every = sampled.every, copy->delay = sampled.delay, copy->at = sampled.at;
    return copy;
}

/// Pushes the copy.
bool Carrier::excitation(const model::Excitation& own) {
    if (!own.has_script()) {
        lua::push(to_, own);
        return true;
    }
    model::Excitation sum;
    for (const model::Component& component : own.components()) {
        model::Term term = component.term;
        if (auto* script = std::get_if<model::Scripted>(&term)) {
            script->function = user_function(*script->function, "its function");
            if (script->function == nullptr) return false;
        }
        // As it was made once, so it is right.
        const model::Excitation one = model::Excitation::make(std::move(term)).value();
        sum = sum + one.scaled(component.gain).windowed(component.from, component.to);
    }
    lua::push(to_, std::move(sum));
    return true;
}

bool Carrier::own_spring(const model::Spring& own, model::Spring& copy) {
    copy = own;
    if (const auto* written = own.as<model::springs::UserSpring>()) {
        const auto carried = user_function(*written->function, "its function");
        if (carried == nullptr) return false;
        copy = model::springs::UserSpring{carried};
    }
    return true;
}

bool Carrier::friction(const model::Friction& own, model::Friction& copy) {
    copy = own;
    if (const auto* law = own.as<model::laws::UserLaw>()) {
        model::laws::UserLaw carried = *law;
        carried.function = user_function(*law->function, "its function");
        if (carried.function == nullptr) return false;
        copy = carried;
    }
    return true;
}

}  // namespace dinal::source
