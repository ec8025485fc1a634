// OPEN FIRST: the equation, its symbols, and the way from a user's parameters to a valid Oscillator.
//
//     I theta'' + C theta' + Rd sgn(theta') + k theta = M(t)    while moving, or at theta' = 0 when |M - k theta| > Re
//     theta' = 0                                                while theta' = 0 and |M - k theta| <= Re
//
// A nonlinear spring (model/spring.hpp) adds its torque to k theta; walls (model/walls.hpp) reflect the mass.
// theta in rad, time and torque in any consistent units. docs/theory.md has the derivations.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "model/friction.hpp"
#include "model/spring.hpp"
#include "model/units.hpp"
#include "model/walls.hpp"
#include "text/expected.hpp"
#include "text/option.hpp"

namespace dinal::model {

/// The parameters of a system as given by a user.
struct OscillatorParameters {
    double inertia = 0;                     ///< I, moment of inertia
    double stiffness = 0;                   ///< k, torque per rad
    double damping = 0;                     ///< C, torque per rad/time
    double kinetic_friction = 0;            ///< Rd, torque of dry friction while moving
    std::optional<double> breakaway = {};   ///< Re, torque that sticking can hold; by default Rd
    std::optional<Friction> friction = {};  ///< a law that replaces Coulomb's; Rd and Re are then ignored
    double normal = 1;                      ///< constant load that multiplies the friction torques
    Spring spring = {};                     ///< a nonlinear spring in addition to k theta
    std::optional<Walls> walls = {};        ///< end stops
    Units units = {};                       ///< words only: no number depends on them
};

inline constexpr text::Option mechanical_options[] = {
    {"I", "torque time^2 per rad", text::needed, text::positive, "moment of inertia",
     text::fills<&OscillatorParameters::inertia>},
    {"k", "torque per rad", text::needed, text::not_negative, "stiffness of the spring; 0 is a block that slides",
     text::fills<&OscillatorParameters::stiffness>},
    {"C", "torque time per rad", text::its_own, text::not_negative, "viscous damping",
     text::fills<&OscillatorParameters::damping>},
    {"Rd", "torque", text::its_own, text::not_negative, "dry friction while sliding",
     text::fills<&OscillatorParameters::kinetic_friction>},
    {"Re", "torque", "Rd", text::not_negative, "breakaway torque, at least Rd",
     text::fills<&OscillatorParameters::breakaway>},
    {.name = "friction",
     .meaning = "another law of friction, instead of Rd and Re",
     .object = "friction",
     .wanted = "a law such as friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 }"},
    {.name = "spring",
     .unit = "torque",
     .meaning = "a restoring torque in addition to k theta: a Lua function of theta, or spring.polynomial{ "
                "[3] = 0.5 }",
     .object = "spring",
     .wanted = "a function of theta, or a spring such as spring.polynomial{ [3] = 0.5 }"},
    {.name = "walls",
     .unit = "rad",
     .meaning =
         "end stops: { lower = -1, upper = 1, restitution = 0.7 }, either wall or both; restitution 0 ... 1, 1 unless "
         "given; elastic ones have stiffness and damping instead",
     .wanted = "a table such as { lower = -0.8, upper = 0.8, restitution = 0.7 }",
     .fields = {&walls_call}},
};
inline constexpr auto oscillator_options = text::joined(mechanical_options, units_option);

/// Position and speed of the mass: rad, rad per time unit.
struct State {
    double theta = 0;
    double velocity = 0;
};

/// The type of free motion without dry friction.
enum class Regime { undamped, underdamped, critical, overdamped };
std::string_view name(Regime regime);

/// A valid system: immutable, cheap to copy, safe to share between threads.
class Oscillator {
public:
    /// Fails with a sentence that names the parameter, its value and its range.
    static text::Expected<Oscillator> make(const OscillatorParameters& parameters);

    double inertia() const { return inertia_; }
    double stiffness() const { return stiffness_; }
    double damping() const { return damping_; }
    const Friction& friction() const { return friction_; }
    /// The nonlinear spring in addition to k theta.
    const Spring& spring() const { return spring_; }
    /// The end stops, if any.
    const std::optional<Walls>& walls() const { return walls_; }
    /// Words for output only.
    const Units& units() const;
    /// Returns whether k is the only spring, so that quantities derived from k are valid.
    bool has_linear_spring() const { return has_spring() && spring_.none(); }
    /// Rd under the normal load, as all friction torques here.
    double kinetic_friction() const { return friction_.kinetic(); }
    /// Re; the greater one if it depends on the direction.
    double breakaway() const { return friction_.greatest_holding(); }

    /// Returns whether k > 0. Without k there is no natural frequency, period, damping ratio or preferred place of
    /// rest.
    bool has_spring() const { return stiffness_ > 0; }
    /// w0 = sqrt(k / I), rad per time unit; 0 without a spring.
    double natural_frequency() const;
    /// T0 = 2 pi / w0; infinite without a spring.
    double natural_period() const;
    /// zeta = C / (2 I w0) = C / (2 sqrt(I k)): viscous, never dry; without a spring infinite, or 0 without damping.
    double damping_ratio() const;
    /// w1 = w0 sqrt(1 - zeta^2); none unless the system swings (zeta < 1).
    std::optional<double> damped_frequency() const;
    /// Compares C^2 with 4 I k, so that an exactly critical system is recognised.
    Regime regime() const;
    /// Re / k: without excitation the mass can stay anywhere with |theta| <= this. Infinite without a spring.
    double dead_zone() const { return has_spring() ? breakaway() / stiffness_ : unlimited; }
    /// The lowest and the highest theta at which the mass can stay without excitation.
    std::pair<double, double> resting_places() const {
        if (!has_spring()) return {-unlimited, unlimited};
        return {-friction_.holding(Motion::forward) / stiffness_, friction_.holding(Motion::backward) / stiffness_};
    }
    /// gamma = Rd / |Mc| for the characteristic torque Mc.
    double friction_ratio(double characteristic_torque) const;
    /// Mc of a free motion: k sqrt(theta0^2 + (velocity0 / w0)^2) (report, section 5).
    double characteristic_torque(const State& initial) const;

    /// The parameters that construct this system, the friction law included.
    OscillatorParameters parameters() const;

private:
    Oscillator() = default;
    static constexpr double unlimited = std::numeric_limits<double>::infinity();

    double inertia_ = 1;
    double stiffness_ = 1;
    double damping_ = 0;
    Friction friction_;
    Spring spring_;
    std::optional<Walls> walls_;
    std::shared_ptr<const Units> units_;  // null: the usual ones
};

}  // namespace dinal::model
