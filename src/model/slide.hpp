// The friction of a mass that slides, as the one smooth formula that holds between two corners of its law.
//
// An integrator solves a piece with this formula, wherever its motion would go, and ends the piece where the speed
// comes to one of the two corners: there the next formula begins. So it sees every corner, however narrow what is
// between two of them.
#pragma once

#include "model/lowered.hpp"

namespace dinal::model {

/// How long a polynomial of degree 16 can follow a motion from this speed on, about: along a line that makes it grow or
/// die out fast, and along a curve until the speed has changed by its scale. `first` is the change of the speed by
/// time, `second` the size of what that changes by, C and I those of the system.
double longest_step(const Friction& law, const SpeedRange& range, double speed, double first, double second, double C,
                    double I);

class Slide {
public:
    explicit Slide(const Lowered& system) : law_(system.law_with_corners()) {}

    /// The law names its corners, and so these words have a meaning.
    [[nodiscard]] bool has_corners() const { return law_ != nullptr; }
    /// A range was entered; else the law is what it is at every speed.
    [[nodiscard]] bool inside() const { return inside_; }
    [[nodiscard]] const SpeedRange& range() const { return range_; }
    /// Which of the law's ranges it is.
    [[nodiscard]] std::size_t index() const { return index_; }
    /// The range, if friction on it is a line.
    [[nodiscard]] const SpeedRange* line() const { return inside_ && range_.straight ? &range_ : nullptr; }
    [[nodiscard]] const Friction* law() const { return law_; }
    /// As Lowered has it, but with the formula of this range at all speeds.
    [[nodiscard]] double friction_remainder(const Lowered& system, Motion way, const State& state) const {
        if (line() == nullptr) return system.friction_remainder(way, state);
        const double sign = sign_of(way);
        return sign * range_.at(sign * state.velocity) - system.braking(way);
    }

    /// The range of this speed. A mass that stands at a corner is on the one above it.
    void enter(double speed) { enter_at(law_->range_of(speed)); }
    /// Across the corner at one end of the range.
    void cross(bool upwards) { enter_at(upwards ? index_ + 1 : index_ - 1); }
    void leave() { inside_ = false; }

    /// The same on its range.
    [[nodiscard]] double longest_step(double speed, double first, double second, double C, double I) const {
        return model::longest_step(*law_, range_, speed, first, second, C, I);
    }

private:
    void enter_at(std::size_t index) {
        index_ = index;
        range_ = law_->range(index);
        inside_ = true;
    }

    const Friction* law_;
    std::size_t index_ = 0;
    SpeedRange range_;
    bool inside_ = false;
};

}  // namespace dinal::model
