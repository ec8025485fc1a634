// Dry friction as a value: the braking torque while sliding and the torque limit while sticking.
//
// A law is a struct in model/laws that satisfies FrictionLaw; a Friction holds any of them and is cheap to copy.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <typeinfo>

#include "text/expected.hpp"
#include "text/not_copied.hpp"

namespace dinal::model {

/// The direction of motion. `stuck` is exact: velocity 0, theta constant.
enum class Motion : int { backward = -1, stuck = 0, forward = 1 };

constexpr double sign_of(Motion motion) {
    return static_cast<double>(static_cast<int>(motion));
}

/// The index of a direction in pairs of numbers: backward 0, forward 1.
constexpr std::size_t side_of(Motion way) {
    return way == Motion::forward ? 1 : 0;
}

inline Motion motion_of(double velocity) {
    return velocity > 0 ? Motion::forward : velocity < 0 ? Motion::backward : Motion::stuck;
}

/// `way` is forward or backward. Torques are magnitudes: friction opposes the motion, whatever its law.
template <class Law>
concept FrictionLaw = requires(const Law& law, Motion way, double speed) {
    /// The braking torque at this speed; at speed 0, where it is the limit from above, at most holding(way). Must be
    /// smooth for small negative speeds: trial steps overshoot zero.
    { law.sliding(way, speed) } -> std::same_as<double>;
    /// The largest pull this way that sticking can hold.
    { law.holding(way) } -> std::same_as<double>;
    { Law::depends_on_speed } -> std::convertible_to<bool>;
    /// An error if the numbers of the law are invalid.
    { law.complaint() } -> std::same_as<std::optional<text::Error>>;
};

/// A range of speeds between two corners of a law, on which it is smooth.
struct SpeedRange {
    double from = 0, to = std::numeric_limits<double>::infinity();
    /// Whether the formula is torque + slope (speed - from). Otherwise it is sliding(), which continues smoothly beyond
    /// both ends.
    bool straight = false;
    double torque = 0, slope = 0;

    double at(double speed) const { return torque + slope * (speed - from); }
};

/// A law with an internal state z, such as the deflection of bristles, derives from this. It never sticks or slips
/// exactly: sliding() is its torque in steady sliding, holding() the greatest torque. z begins at 0.
struct BendingLaw {
    /// z' at slip velocity v; it may have a corner at v = 0.
    virtual double bend_rate(double v, double z) const = 0;
    virtual double torque(double v, double z) const = 0;

protected:
    BendingLaw() = default;
    BendingLaw(const BendingLaw&) = default;
    BendingLaw& operator=(const BendingLaw&) = default;
    ~BendingLaw() = default;
};

// A law may also have
//     std::string lua_text() const;   the Lua expression that constructs the law
// and, for both directions alike, what lets an integrator predict its corners instead of searching for them:
//     std::size_t ranges() const;                    their number, from speed 0 on and without gaps
//     model::SpeedRange range(std::size_t i) const;
//     double slope(double speed) const;              on ranges that are not straight: its derivative,
//     double scale(double speed) const;              the change of speed from here over which a polynomial of
//                                                    degree 16 follows it to about twelve digits

/// An error if a sliding torque Rd and a holding torque Re are invalid. `of` precedes their names: "forward.".
std::optional<text::Error> wrong_torques(std::string_view of, double Rd, double Re);

class Friction {
public:
    /// No friction.
    Friction() = default;
    template <FrictionLaw Law>
    Friction(const Law& law)  // NOLINT(google-explicit-constructor): a law is a friction
        : law_(std::make_shared<const Held<Law>>(law)) {}

    /// The same law with its torques multiplied by a constant normal load; a negative load counts as 0.
    Friction under(double normal) const {
        Friction loaded = *this;
        loaded.normal_ = std::max(0.0, normal);
        return loaded;
    }
    double normal() const { return normal_; }

    double sliding(Motion way, double speed) const { return law_ ? normal_ * law_->sliding(way, speed) : 0; }
    double holding(Motion way) const { return law_ && normal_ > 0 ? normal_ * law_->holding(way) : 0; }
    /// Returns whether the law never lets the contact slip backward.
    bool is_one_way() const { return std::isinf(holding(Motion::backward)); }
    bool depends_on_speed() const { return law_ && normal_ > 0 && law_->depends_on_speed(); }
    /// Rd; the greater one if they depend on the direction; the torque at speed 0 for a law without Rd.
    double kinetic() const;
    /// The number of smooth ranges; 0 if the law does not declare them.
    std::size_t ranges() const { return law_ ? law_->ranges() : 0; }
    SpeedRange range(std::size_t i) const {
        SpeedRange range = law_->range(i);
        range.torque *= normal_, range.slope *= normal_;
        return range;
    }
    /// The range that contains this speed; at a corner, the upper one.
    std::size_t range_of(double speed) const {
        std::size_t low = 0, high = ranges();
        while (high - low > 1) {
            const std::size_t middle = low + (high - low) / 2;
            (range(middle).from <= speed ? low : high) = middle;
        }
        return low;
    }
    double slope(double speed) const { return normal_ * law_->slope(speed); }
    double scale(double speed) const { return law_->scale(speed); }
    [[nodiscard]] std::optional<text::Error> complaint() const {
        return law_ ? law_->complaint() : std::optional<text::Error>();
    }
    /// The Lua expression that makes the law again, without its normal load; empty if there is none.
    std::string lua_text() const { return law_ ? law_->lua_text() : ""; }
    /// Returns whether nothing brakes or holds, so that velocity zero is not special.
    bool none() const { return !depends_on_speed() && greatest_holding() == 0; }
    /// The greater sliding torque of both directions, at speed 0.
    double greatest_sliding() const { return std::max(sliding(Motion::forward, 0), sliding(Motion::backward, 0)); }
    double greatest_holding() const { return std::max(holding(Motion::forward), holding(Motion::backward)); }
    /// The law without its normal load if it has an internal state, otherwise nullptr.
    const BendingLaw* bending() const { return law_ ? law_->bending() : nullptr; }
    /// The law without its normal load if it is a `Law`, otherwise nullptr.
    template <FrictionLaw Law>
    const Law* as() const {
        const Any* law = law_.get();
        return law != nullptr && typeid(*law) == typeid(Held<Law>) ? &static_cast<const Held<Law>*>(law)->law : nullptr;
    }

private:
    struct Any : text::NotCopied {
        virtual ~Any() = default;
        virtual double sliding(Motion way, double speed) const = 0;
        virtual double holding(Motion way) const = 0;
        virtual bool depends_on_speed() const = 0;
        [[nodiscard]] virtual std::optional<text::Error> complaint() const = 0;
        virtual const BendingLaw* bending() const = 0;
        virtual std::string lua_text() const = 0;
        virtual std::size_t ranges() const = 0;
        virtual SpeedRange range(std::size_t i) const = 0;
        virtual double slope(double speed) const = 0;
        virtual double scale(double speed) const = 0;
    };
    template <class Law>
    struct Held final : Any {
        explicit Held(const Law& given) : law(given) {}
        double sliding(Motion way, double speed) const override { return law.sliding(way, speed); }
        double holding(Motion way) const override { return law.holding(way); }
        bool depends_on_speed() const override { return Law::depends_on_speed; }
        [[nodiscard]] std::optional<text::Error> complaint() const override { return law.complaint(); }
        const BendingLaw* bending() const override {
            if constexpr (std::derived_from<Law, BendingLaw>) {
                return &law;
            } else {
                return nullptr;
            }
        }
        std::string lua_text() const override {
            if constexpr (requires { law.lua_text(); }) {
                return law.lua_text();
            } else {
                return "";
            }
        }
        std::size_t ranges() const override {
            if constexpr (requires { law.ranges(); }) {
                return law.ranges();
            } else {
                return 0;
            }
        }
        SpeedRange range(std::size_t i) const override {
            if constexpr (requires { law.range(i); }) {
                return law.range(i);
            } else {
                return {};
            }
        }
        double slope(double speed) const override {
            if constexpr (requires { law.slope(speed); }) {
                return law.slope(speed);
            } else {
                return 0;
            }
        }
        double scale(double speed) const override {
            if constexpr (requires { law.scale(speed); }) {
                return law.scale(speed);
            } else {
                return std::numeric_limits<double>::infinity();
            }
        }
        Law law;
    };
    std::shared_ptr<const Any> law_;  // shared by copies of a system; never changed
    double normal_ = 1;
};

}  // namespace dinal::model
