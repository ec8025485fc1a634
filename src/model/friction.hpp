// Dry friction as a value: the torque that brakes a sliding mass, and the torque that a standing one can be held by.
//
// A law is a struct of model/laws (FrictionLaw says what it must answer); a Friction is any of them, cheap to copy.
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

namespace dinal::model {

/// Which way the mass moves. `stuck` is exact: velocity 0, theta constant.
enum class Motion : int { backward = -1, stuck = 0, forward = 1 };

constexpr double sign_of(Motion motion) {
    return static_cast<double>(static_cast<int>(motion));
}

inline Motion motion_of(double velocity) {
    return velocity > 0 ? Motion::forward : velocity < 0 ? Motion::backward : Motion::stuck;
}

/// `way` is forward or backward. Torques are magnitudes: friction is against the motion, whatever its law.
template <class Law>
concept FrictionLaw = requires(const Law& law, Motion way, double speed) {
    /// Against a motion this way at this speed; no more than holding(way) at speed 0, where it is the limit from above.
    /// An integrator looks a little beyond the end of a motion: below speed 0 it wants the smooth continuation.
    { law.sliding(way, speed) } -> std::same_as<double>;
    /// The most that sticking can hold against a pull this way.
    { law.holding(way) } -> std::same_as<double>;
    { Law::depends_on_speed } -> std::convertible_to<bool>;
    /// What is wrong with its numbers, for the person who gave them.
    { law.complaint() } -> std::same_as<std::optional<text::Error>>;
};

/// Speeds between two corners of a law, on which it is one smooth formula.
struct SpeedRange {
    double from = 0, to = std::numeric_limits<double>::infinity();
    /// The formula is torque + slope (speed - from). Else it is sliding(), which goes on smoothly beyond both ends.
    bool straight = false;
    double torque = 0, slope = 0;

    [[nodiscard]] double at(double speed) const { return torque + slope * (speed - from); }
};

// A law may also have
//     std::string lua_text() const;   the Lua expression that makes it again
// and, the same both ways, what lets an integrator pass all its corners at sight instead of looking for them:
//     std::size_t ranges() const;                 how many there are, from speed 0 on and without gaps
//     model::SpeedRange range(std::size_t i) const;
//     double slope(double speed) const;              on ranges that are not straight: its derivative,
//     double scale(double speed) const;              and over which change of speed from here a polynomial of degree 16
//                                                    follows it to twelve digits, about

/// For a law's complaint(): what is wrong with a sliding torque Rd and a holding torque Re. `of` stands before their
/// names: "forward.".
std::optional<text::Error> wrong_torques(std::string_view of, double Rd, double Re);

class Friction {
public:
    /// None.
    Friction() = default;
    template <FrictionLaw Law>
    Friction(const Law& law)  // NOLINT(google-explicit-constructor): a law is a friction
        : law_(std::make_shared<const Held<Law>>(law)) {}

    /// The same law under this constant normal load, which multiplies its torques; a negative one counts as 0.
    [[nodiscard]] Friction under(double normal) const {
        Friction loaded = *this;
        loaded.normal_ = std::max(0.0, normal);
        return loaded;
    }
    [[nodiscard]] double normal() const { return normal_; }

    [[nodiscard]] double sliding(Motion way, double speed) const {
        return law_ ? normal_ * law_->sliding(way, speed) : 0;
    }
    [[nodiscard]] double holding(Motion way) const { return law_ && normal_ > 0 ? normal_ * law_->holding(way) : 0; }
    /// Returns whether it never lets the contact slip backward.
    [[nodiscard]] bool is_one_way() const { return std::isinf(holding(Motion::backward)); }
    [[nodiscard]] bool depends_on_speed() const { return law_ && normal_ > 0 && law_->depends_on_speed(); }
    /// Rd; the greater one of a law with other numbers each way, at speed 0 where a law has no Rd of its own.
    [[nodiscard]] double kinetic() const;
    /// 0: it does not name its corners.
    [[nodiscard]] std::size_t ranges() const { return law_ ? law_->ranges() : 0; }
    [[nodiscard]] SpeedRange range(std::size_t i) const {
        SpeedRange range = law_->range(i);
        range.torque *= normal_, range.slope *= normal_;
        return range;
    }
    /// The range of this speed; of a corner, the one above it.
    [[nodiscard]] std::size_t range_of(double speed) const {
        std::size_t low = 0, high = ranges();
        while (high - low > 1) {
            const std::size_t middle = low + (high - low) / 2;
            (range(middle).from <= speed ? low : high) = middle;
        }
        return low;
    }
    [[nodiscard]] double slope(double speed) const { return normal_ * law_->slope(speed); }
    [[nodiscard]] double scale(double speed) const { return law_->scale(speed); }
    [[nodiscard]] std::optional<text::Error> complaint() const {
        return law_ ? law_->complaint() : std::optional<text::Error>();
    }
    /// The Lua expression that makes the law again, without its normal load; empty when it knows none.
    [[nodiscard]] std::string lua_text() const { return law_ ? law_->lua_text() : ""; }
    /// Nothing brakes and nothing holds: velocity zero means nothing.
    [[nodiscard]] bool none() const { return !depends_on_speed() && greatest_holding() == 0; }
    /// The greater torque of both ways.
    [[nodiscard]] double greatest_sliding() const {
        return std::max(sliding(Motion::forward, 0), sliding(Motion::backward, 0));
    }
    [[nodiscard]] double greatest_holding() const {
        return std::max(holding(Motion::forward), holding(Motion::backward));
    }
    /// The law itself, without its normal load, if it is of this kind.
    template <FrictionLaw Law>
    [[nodiscard]] const Law* as() const {
        const Any* law = law_.get();
        return law != nullptr && typeid(*law) == typeid(Held<Law>) ? &static_cast<const Held<Law>*>(law)->law : nullptr;
    }

private:
    struct Any {
        Any() = default;
        Any(const Any&) = delete;
        Any& operator=(const Any&) = delete;
        virtual ~Any() = default;
        [[nodiscard]] virtual double sliding(Motion way, double speed) const = 0;
        [[nodiscard]] virtual double holding(Motion way) const = 0;
        [[nodiscard]] virtual bool depends_on_speed() const = 0;
        [[nodiscard]] virtual std::optional<text::Error> complaint() const = 0;
        [[nodiscard]] virtual std::string lua_text() const = 0;
        [[nodiscard]] virtual std::size_t ranges() const = 0;
        [[nodiscard]] virtual SpeedRange range(std::size_t i) const = 0;
        [[nodiscard]] virtual double slope(double speed) const = 0;
        [[nodiscard]] virtual double scale(double speed) const = 0;
    };
    template <class Law>
    struct Held final : Any {
        explicit Held(const Law& given) : law(given) {}
        [[nodiscard]] double sliding(Motion way, double speed) const override { return law.sliding(way, speed); }
        [[nodiscard]] double holding(Motion way) const override { return law.holding(way); }
        [[nodiscard]] bool depends_on_speed() const override { return Law::depends_on_speed; }
        [[nodiscard]] std::optional<text::Error> complaint() const override { return law.complaint(); }
        [[nodiscard]] std::string lua_text() const override {
            if constexpr (requires { law.lua_text(); }) {
                return law.lua_text();
            } else {
                return "";
            }
        }
        [[nodiscard]] std::size_t ranges() const override {
            if constexpr (requires { law.ranges(); }) {
                return law.ranges();
            } else {
                return 0;
            }
        }
        [[nodiscard]] SpeedRange range(std::size_t i) const override {
            if constexpr (requires { law.range(i); }) {
                return law.range(i);
            } else {
                return {};
            }
        }
        [[nodiscard]] double slope(double speed) const override {
            if constexpr (requires { law.slope(speed); }) {
                return law.slope(speed);
            } else {
                return 0;
            }
        }
        [[nodiscard]] double scale(double speed) const override {
            if constexpr (requires { law.scale(speed); }) {
                return law.scale(speed);
            } else {
                return std::numeric_limits<double>::infinity();
            }
        }
        Law law;
    };
    std::shared_ptr<const Any> law_;  // shared by the copies of a system, which never change it
    double normal_ = 1;
};

}  // namespace dinal::model
