// Reads the options for the drive and the start of a run into a model::Drive.
#include <fmt/format.h>

#include <cmath>

#include "api/bind_excitation.hpp"
#include "api/bodies.hpp"
#include "api/drive_options.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "model/controller.hpp"

namespace dinal::api {

namespace engine = motion::engine;

namespace {

/// The option, or the part of it for this body or link.
std::string part_of_option(const model::System& system, const char* option, std::size_t joint) {
    return system.named ? fmt::format("{}.{}", option, system.joints[joint].name) : std::string(option);
}

/// The quantities that relays can observe: theta.load, velocity.load and the states.
std::vector<std::string> names_for_relays(const model::System& system, const model::Drive& drive) {
    std::vector<std::string> known;
    if (!system.named) known = {"theta", "velocity"};
    for (const char* kind : {"theta.", "velocity."}) {
        for (const model::Body& each : system.bodies) {
            if (system.named) known.push_back(kind + each.name);
        }
    }
    for (const model::OwnState& state : drive.states) known.push_back(state.name);
    return known;
}

void check_rigid_start(const lua::Options& options, const model::System& system, const model::Joint& joint,
                       const std::vector<double>& velocities) {
    std::string given;
    for (const auto& [body, by] : joint.of) {
        given += fmt::format("{}{} = {:.6g}", given.empty() ? "" : ", ", system.bodies[body].name, velocities[body]);
    }
    const double speed = joint.sum(velocities);
    constexpr double rounded = 1e-14;
    if (std::fabs(speed) <= rounded * joint.size(velocities)) return;
    options.fail("velocity0",
                 "velocity0: the rigid link {} keeps {} as it is, but {} changes it by {:.6g} "
                 "per time unit",
                 joint.name, system.angle_in_words(joint), given, speed);
}

void check_one_way(const lua::Options& options, const model::System& system, const model::Joint& joint,
                   const std::vector<double>& velocities) {
    const double slip = joint.sum(velocities);
    constexpr double rounded = 1e-14;
    if (!(slip < -rounded * joint.size(velocities))) return;
    options.fail("velocity0", "velocity0: the freewheel{} turns forward only, but begins with {:.6g}",
                 system.named ? " " + joint.name : "", slip);
}

}  // namespace

model::Drive asked_drive(lua_State* L, const lua::Options& options, const model::System& system) {
    model::Drive drive = model::Drive::at_rest(system.bodies.size(), system.joints.size());
    const auto named = [&](const char* option, std::size_t joint) {
        return fmt::format("{}: {}", options.call(), part_of_option(system, option, joint));
    };
    for_each_named(L, options, "M", system, Names::both,
                   [&](std::size_t i) { drive.loads[i] = to_excitation(L, -1, named("M", i), "M"); });
    for_each_named(L, options, "belt", system, Names::both, [&](std::size_t j) {
        drive.belts[j] = to_excitation(L, -1, named("belt", j), "belt");
        if (drive.belts[j].has_feedback() || model::has_memory(drive.belts[j])) {
            options.fail("belt", "belt must be a number, an excitation or a function of t alone");
        }
    });
    drive.base = read_motion(L, options, "base");
    drive.states = read_states(L, options);
    drive.events = read_events(L, options);
    for (std::size_t i = 0; i < system.joints.size(); ++i)
        check_relays(options, drive.loads[i], names_for_relays(system, drive), part_of_option(system, "M", i));
    for (const auto& [option, values] :
         {std::pair("theta0", &drive.theta0), std::pair("velocity0", &drive.velocity0)}) {
        for_each_named(L, options, option, system, Names::bodies, [&, name = option, to = values](std::size_t i) {
            if (lua_type(L, -1) != LUA_TNUMBER || !std::isfinite(lua_tonumber(L, -1))) {
                options.fail(name, "{} must be a finite number, got {}", part_of_option(system, name, i),
                             lua::describe(L, -1));
            }
            const auto& moved = system.bodies[i].moved;
            if (moved && (moved->by_angle || to == &drive.velocity0)) {
                options.fail(name, "{}: this body is moved by its {}", part_of_option(system, name, i),
                             moved->by_angle ? "theta" : "velocity");
            }
            (*to)[i] = lua_tonumber(L, -1);
        });
    }
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        const model::Joint& joint = system.joints[j];
        // A body with prescribed motion moves linked bodies from the start, and so does a belt on a freewheel.
        const bool free = std::none_of(joint.of.begin(), joint.of.end(), [&](const model::Weight& weight) {
            return system.bodies[weight.body].moved.has_value();
        });
        if (joint.rigid && free) check_rigid_start(options, system, joint, drive.velocity0);
        const bool one_way = joint.friction.law.is_one_way() && drive.belts[j].components().empty();
        if (one_way && free) check_one_way(options, system, joint, drive.velocity0);
        if (!joint.walls) continue;
        const double angle = joint.sum(drive.theta0);
        if (auto wrong = joint.walls->crossed_by(angle, joint.size(drive.theta0))) {
            if (system.is_link(j)) {
                wrong->sentence = fmt::format("theta0: the angle {} of the link {} is beyond its walls from {} to {}",
                                              angle, joint.name, joint.walls->lower, joint.walls->upper);
            } else if (system.named) {
                wrong->sentence = fmt::format("theta0.{}{}", joint.name, wrong->sentence.substr(sizeof "theta0" - 1));
            }
            options.fail(*wrong);
        }
    }
    return drive;
}

void name_functions(lua::CallState& call, const model::System& system, const model::Drive& drive) {
    if (system.named) call.name_bodies(body_names(system));
    std::vector<std::string> states;
    for (const model::OwnState& state : drive.states) states.push_back(state.name);
    if (!states.empty()) call.name_states(states);
}

}  // namespace dinal::api
