// Several bodies that turn about one axis, and what acts between them: the general system, of which one mass on the
// ground is the smallest.
//
//     I_i theta_i'' = M_i - I_i a - sum over its joints of the torques that they take
//
// A joint is a place where torque acts: a body against the ground, or a link. Its angle is a weighted sum of the angles
// of its bodies, and a torque T on that angle acts on each of them times its weight. A joint has what a system of one
// body has: stiffness, damping, a spring, dry friction, walls.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "model/drive.hpp"
#include "model/excitation.hpp"
#include "model/friction.hpp"
#include "model/laws/bristle.hpp"
#include "model/laws/jenkins.hpp"
#include "model/oscillator.hpp"
#include "model/spring.hpp"
#include "model/units.hpp"
#include "model/walls.hpp"

namespace dinal::model {

/// Dry friction whose torques may depend on anything.
struct ContactFriction {
    Friction law = {};  ///< where the rest is empty
    /// Instead of the law's torque while sliding: of (speed, t, theta, velocity, states). The speed is the first of the
    /// states that it is given.
    std::shared_ptr<UserFunction> function = {};
    std::vector<laws::Jenkins> sliders = {};  ///< beside the law
    std::vector<Friction> listed = {};        ///< the laws of a list, of which law and sliders were made
    /// Instead of the law's numbers, backward and forward.
    std::array<std::optional<Excitation>, 2> sliding = {}, holding = {};
    /// What multiplies both torques, and counts as 0 where it is negative.
    std::optional<Excitation> normal = {};

    /// Bristles, which have a state of their own, and neither stick nor slip.
    [[nodiscard]] const laws::Bristle* bristle() const { return law.as<laws::Bristle>(); }
    /// Nothing but the law, and that without a state.
    [[nodiscard]] bool is_constant() const {
        return bristle() == nullptr && function == nullptr && !normal && !sliding[0] && !sliding[1] && !holding[0] &&
               !holding[1];
    }
    /// The law, or another torque, can make the contact stick.
    [[nodiscard]] bool none() const { return is_constant() && law.none(); }
    /// Returns whether friction is what an Oscillator can have.
    [[nodiscard]] bool is_plain() const { return is_constant() && is_of_numbers(); }
    /// Its torques have an Rd and an Re: it is no freewheel, and there are no sliders behind springs.
    [[nodiscard]] bool is_of_numbers() const { return sliders.empty() && !law.is_one_way(); }
};

/// The given motion of a body: its angle, or its velocity.
struct Moved {
    bool by_angle = true;
    Excitation motion;
    bool without_inertia = false;
};

struct Body {
    std::string name;
    double inertia = 1;  ///< may be 0 where it is moved
    std::optional<Moved> moved = {};
};

struct Weight {
    std::size_t body = 0;
    double by = 1;
};

struct Joint {
    std::string name;                  ///< of the link, or of the body whose joint with the ground it is
    std::vector<Weight> of{Weight{}};  ///< a link between two bodies: {a, 1}, {b, -1}
    double stiffness = 0, damping = 0;
    Spring spring = {};
    ContactFriction friction = {};
    std::optional<Walls> walls = {};  ///< rigid ones
    std::optional<Walls> stops = {};  ///< elastic ones
    bool rigid = false;               ///< holds its angle, whatever that takes

    [[nodiscard]] std::size_t first() const { return of.front().body; }
    /// Returns the weighted sum of what its bodies have, such as their angles.
    template <class Values>
    [[nodiscard]] double sum(const Values& of_bodies) const {
        double total = 0;
        for (const auto& [body, by] : of) total += by * of_bodies[body];
        return total;
    }
    [[nodiscard]] bool is_on(std::size_t body) const {
        return std::any_of(of.begin(), of.end(), [body](const Weight& weight) { return weight.body == body; });
    }
    [[nodiscard]] const Walls* any_walls() const { return walls ? &*walls : stops ? &*stops : nullptr; }
    /// Returns whether it is what an Oscillator can be.
    [[nodiscard]] bool is_plain() const { return friction.is_plain() && !stops; }
    /// Returns whether it links two bodies without a gear.
    [[nodiscard]] bool is_difference() const { return of.size() == 2 && of[0].by == 1 && of[1].by == -1; }
    /// Returns whether sums of what its bodies have are rounded where they are 0.
    [[nodiscard]] bool is_weighted() const {
        return std::any_of(of.begin(), of.end(), [](const Weight& weight) { return std::fabs(weight.by) != 1; });
    }
    /// Returns the acceleration of its angle for a torque of 1 on it while nothing else acts.
    [[nodiscard]] double lightness(const std::vector<Body>& bodies) const {
        double total = 0;
        for (const auto& [body, by] : of) total += by * by / bodies[body].inertia;
        return total;
    }
};

struct System {
    std::vector<Body> bodies;
    /// Each body's with the ground, in their order, and then the links.
    std::vector<Joint> joints;
    /// Functions are given theta and velocity by the names of the bodies: as states, all angles, all velocities, and
    /// then the states of the run. Else there is one body, and they are given its state.
    bool named = true;
    Units units = {};

    /// One body without a name, of which an Oscillator says all.
    [[nodiscard]] bool is_plain() const { return !named && joints.front().is_plain(); }
    [[nodiscard]] bool is_link(std::size_t joint) const { return joint >= bodies.size(); }
    [[nodiscard]] bool has_moved() const {
        return std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.moved.has_value(); });
    }
    [[nodiscard]] bool is_linked(std::size_t body) const {
        return std::any_of(joints.begin() + static_cast<std::ptrdiff_t>(bodies.size()), joints.end(),
                           [body](const Joint& joint) { return joint.is_on(body); });
    }
    /// "motor - 10 load"
    [[nodiscard]] std::string angle_in_words(const Joint& joint) const;
    /// Of each body on the stiffness around it, the others being at rest; infinite where there is none.
    [[nodiscard]] std::vector<double> natural_periods() const {
        std::vector<double> stiffness(bodies.size(), 0), periods;
        for (const Joint& joint : joints) {
            for (const auto& [body, by] : joint.of) stiffness[body] += by * by * joint.stiffness;
        }
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            periods.push_back(bodies[i].moved ? never
                                              : 2 * std::numbers::pi / std::sqrt(stiffness[i] / bodies[i].inertia));
        }
        return periods;
    }
    [[nodiscard]] double shortest_natural_period() const {
        const std::vector<double> periods = natural_periods();
        return *std::min_element(periods.begin(), periods.end());
    }
};

/// This body on the ground, without a name.
System as_system(const Oscillator& body);

/// A body or link by itself. Of a link, whose bodies turn against each other, that is what both are when they are free.
/// Fails where its numbers are beyond what a system may have.
text::Expected<Oscillator> oscillator_at(const System& system, std::size_t joint);

// Shared, because its runs keep it.
using SystemHandle = std::shared_ptr<const System>;

}  // namespace dinal::model
