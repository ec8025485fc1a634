// The general system: several bodies that turn about one axis, and the joints between them. One mass on the ground is
// the smallest one.
//
//     I_i theta_i'' = M_i - I_i a - sum over its joints of joint torques
//
// A joint is a place where torque acts: a body against the ground, or a link. Its angle is a weighted sum of body
// angles; a torque T on it acts on each body times its weight. A joint has the elements of a one-body system:
// stiffness, damping, a spring, dry friction, walls.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/drive.hpp"
#include "model/excitation.hpp"
#include "model/friction.hpp"
#include "model/laws/bristle.hpp"
#include "model/oscillator.hpp"
#include "model/spring.hpp"
#include "model/units.hpp"
#include "model/walls.hpp"
#include "text/words.hpp"

namespace dinal::model {

/// Dry friction with variable torques.
struct ContactFriction {
    Friction law = {};  ///< used unless the members below replace it
    /// Replaces the law's sliding torque: a function of (speed, t, theta, velocity, states), where the speed is passed
    /// as the first state.
    std::shared_ptr<UserFunction> function = {};
    std::vector<laws::Jenkins> sliders = {};  ///< Jenkins elements in parallel with the law
    std::vector<Friction> listed = {};        ///< the user's list of laws, from which law and sliders were made
    /// Replace the law's numbers, backward and forward.
    std::array<std::optional<Excitation>, 2> sliding = {}, holding = {};
    /// Multiplies all torques; negative values count as 0.
    std::optional<Excitation> normal = {};

    /// The law if it has an internal state, so that it never sticks or slips exactly; otherwise nullptr.
    const BendingLaw* bending() const { return law.bending(); }
    /// Returns whether there is only the law, without internal state.
    bool is_constant() const {
        return bending() == nullptr && function == nullptr && !normal && !sliding[0] && !sliding[1] && !holding[0] &&
               !holding[1];
    }
    /// Returns whether no torque can make the contact stick.
    bool none() const { return is_constant() && law.none(); }
    /// Returns whether an Oscillator can have this friction.
    bool is_plain() const { return is_constant() && is_of_numbers(); }
    /// Returns whether the torques are given by Rd and Re: no freewheel, no sliders behind springs.
    bool is_of_numbers() const { return sliders.empty() && !law.is_one_way(); }
};

/// The prescribed motion of a body: its angle or its velocity.
struct Moved {
    bool by_angle = true;
    Excitation motion;
    bool without_inertia = false;
};

struct Body {
    std::string name;
    double inertia = 1;  ///< may be 0 if its motion is prescribed
    std::optional<Moved> moved = {};
};

struct Weight {
    std::size_t body = 0;
    double by = 1;
};

struct Joint {
    std::string name;                  ///< name of the link, or of the body on the ground
    std::vector<Weight> of{Weight{}};  ///< a link between two bodies: {a, 1}, {b, -1}
    double stiffness = 0, damping = 0;
    Spring spring = {};
    ContactFriction friction = {};
    std::optional<Walls> walls = {};  ///< rigid walls
    std::optional<Walls> stops = {};  ///< elastic walls
    bool rigid = false;               ///< whether it holds its angle with any torque needed

    std::size_t first() const { return of.front().body; }
    /// Returns the weighted sum of body values, such as angles.
    template <class Values>
    double sum(const Values& of_bodies) const {
        double total = 0;
        for (const auto& [body, by] : of) total += by * of_bodies[body];
        return total;
    }
    /// Returns the sum of the magnitudes of its terms, to which the rounding of sum() is relative.
    template <class Values>
    double size(const Values& of_bodies) const {
        double total = 0;
        for (const auto& [body, by] : of) total += std::fabs(by * of_bodies[body]);
        return total;
    }
    bool is_on(std::size_t body) const { return text::contains(of, body, &Weight::body); }
    const Walls* any_walls() const { return walls ? &*walls : stops ? &*stops : nullptr; }
    /// Returns whether an Oscillator can represent this joint.
    bool is_plain() const { return friction.is_plain() && !stops; }
    /// Returns whether it links two bodies without a gear.
    bool is_difference() const { return of.size() == 2 && of[0].by == 1 && of[1].by == -1; }
    /// Returns whether weighted sums can be rounded (a weight other than 1 or -1).
    bool is_weighted() const {
        return std::ranges::any_of(of, [](const Weight& weight) { return std::fabs(weight.by) != 1; });
    }
    /// Returns the angular acceleration caused by a torque of 1 on the joint alone.
    double lightness(const std::vector<Body>& bodies) const {
        double total = 0;
        for (const auto& [body, by] : of) total += by * by / bodies[body].inertia;
        return total;
    }
};

struct System {
    std::vector<Body> bodies;
    /// First each body's joint with the ground, in their order, then the links.
    std::vector<Joint> joints;
    /// Whether user functions receive all angles and velocities by the bodies' names, as states before the run's own.
    /// Otherwise there is one body, and they receive its theta and velocity.
    bool named = true;
    Units units = {};

    /// Returns whether it is one unnamed body that an Oscillator represents completely.
    bool is_plain() const { return !named && joints.front().is_plain(); }
    /// Returns whether it is one body, with a name or without, that an Oscillator represents completely.
    bool is_alone() const { return joints.size() == 1 && joints.front().is_plain() && !bodies.front().moved; }
    bool is_link(std::size_t joint) const { return joint >= bodies.size(); }
    std::optional<std::size_t> joint_named(std::string_view name) const {
        for (std::size_t j = 0; j < joints.size(); ++j) {
            if (joints[j].name == name) return j;
        }
        return {};
    }
    bool has_freewheels() const {
        return std::ranges::any_of(joints, [](const Joint& joint) { return joint.friction.law.is_one_way(); });
    }
    bool has_moved() const {
        return std::ranges::any_of(bodies, [](const Body& body) { return body.moved.has_value(); });
    }
    bool is_linked(std::size_t body) const {
        return std::any_of(joints.begin() + static_cast<std::ptrdiff_t>(bodies.size()), joints.end(),
                           [body](const Joint& joint) { return joint.is_on(body); });
    }
    /// "motor - 10 load"
    std::string angle_in_words(const Joint& joint) const;
    /// The period of each body on the stiffness around it, with the others at rest; infinite without stiffness.
    std::vector<double> natural_periods() const {
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
    double shortest_natural_period() const {
        const std::vector<double> periods = natural_periods();
        return *std::ranges::min_element(periods);
    }
};

/// The system of one unnamed body on the ground.
System as_system(const Oscillator& body);

/// A body alone, as if all others were at rest, or a link as the relative motion of its two bodies, otherwise free.
/// Fails if the numbers are out of range.
text::Expected<Oscillator> oscillator_at(const System& system, std::size_t joint);

// Shared, because runs keep it.
using SystemHandle = std::shared_ptr<const System>;

}  // namespace dinal::model
