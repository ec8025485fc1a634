// A nonlinear spring in addition to k theta, as a value: its torque at an angle, and its stored energy.
//
// A kind of spring is a struct in model/springs that satisfies SpringLaw; a Spring holds any of them and is cheap to
// copy.
#pragma once

#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <typeinfo>

#include "text/expected.hpp"
#include "text/not_copied.hpp"

namespace dinal::model {

/// theta in rad; a positive torque acts against theta: I theta'' = ... - torque(theta).
template <class Law>
concept SpringLaw = requires(const Law& law, double theta) {
    { law.torque(theta) } -> std::same_as<double>;
    /// The integral of the torque from 0 to theta; NaN if it cannot be computed.
    { law.energy(theta) } -> std::same_as<double>;
    /// An error if the numbers of the law are invalid.
    { law.complaint() } -> std::same_as<std::optional<text::Error>>;
    /// Returns whether torque(-theta) = -torque(theta).
    { law.is_odd() } -> std::same_as<bool>;
    /// The Lua expression that constructs the spring; empty if there is none.
    { law.lua_text() } -> std::same_as<std::string>;
};

class Spring {
public:
    /// No spring.
    Spring() = default;
    template <SpringLaw Law>
    Spring(const Law& law)  // NOLINT(google-explicit-constructor): a law is a spring
        : law_(std::make_shared<const HeldSpring<Law>>(law)) {}

    bool none() const { return law_ == nullptr; }
    double torque(double theta) const { return law_ ? law_->torque(theta) : 0; }
    double energy(double theta) const { return law_ ? law_->energy(theta) : 0; }
    [[nodiscard]] std::optional<text::Error> complaint() const {
        return law_ ? law_->complaint() : std::optional<text::Error>();
    }
    bool is_odd() const { return !law_ || law_->is_odd(); }
    std::string lua_text() const { return law_ ? law_->lua_text() : ""; }
    /// The law if it is a `Law`, otherwise nullptr.
    template <SpringLaw Law>
    const Law* as() const {
        const AnySpring* law = law_.get();
        return law != nullptr && typeid(*law) == typeid(HeldSpring<Law>)
                   ? &static_cast<const HeldSpring<Law>*>(law)->law
                   : nullptr;
    }

private:
    struct AnySpring : text::NotCopied {
        virtual ~AnySpring() = default;
        virtual double torque(double theta) const = 0;
        virtual double energy(double theta) const = 0;
        [[nodiscard]] virtual std::optional<text::Error> complaint() const = 0;
        virtual bool is_odd() const = 0;
        virtual std::string lua_text() const = 0;
    };
    template <class Law>
    struct HeldSpring final : AnySpring {
        explicit HeldSpring(const Law& given) : law(given) {}
        double torque(double theta) const override { return law.torque(theta); }
        double energy(double theta) const override { return law.energy(theta); }
        [[nodiscard]] std::optional<text::Error> complaint() const override { return law.complaint(); }
        bool is_odd() const override { return law.is_odd(); }
        std::string lua_text() const override { return law.lua_text(); }
        Law law;
    };
    std::shared_ptr<const AnySpring> law_;  // shared by copies of a system; never changed
};

}  // namespace dinal::model
