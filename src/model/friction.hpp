// Dry friction as a value: the torque that brakes a sliding mass, and the torque that a standing one can be held by.
//
// A law is a struct of model/laws (FrictionLaw says what it must answer); a Friction is any of them, cheap to copy.
#pragma once

#include <algorithm>
#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

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

// A law may also have
//     std::string lua_text() const;   the Lua expression that makes it again

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

    [[nodiscard]] double sliding(Motion way, double speed) const { return law_ ? law_->sliding(way, speed) : 0; }
    [[nodiscard]] double holding(Motion way) const { return law_ ? law_->holding(way) : 0; }
    [[nodiscard]] bool depends_on_speed() const { return law_ && law_->depends_on_speed(); }
    [[nodiscard]] std::optional<text::Error> complaint() const {
        return law_ ? law_->complaint() : std::optional<text::Error>();
    }
    /// The Lua expression that makes the law again; empty when it knows none.
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
    /// The law itself, if it is of this kind.
    template <FrictionLaw Law>
    [[nodiscard]] const Law* as() const {
        const auto* held = dynamic_cast<const Held<Law>*>(law_.get());
        return held != nullptr ? &held->law : nullptr;
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
        Law law;
    };
    std::shared_ptr<const Any> law_;  // shared by the copies of a system, which never change it
};

}  // namespace dinal::model
