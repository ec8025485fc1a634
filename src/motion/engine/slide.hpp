// Slides of the motion along a surface on which a load, or the rate of a state, jumps and both sides drive the motion
// back (Filippov). The load is then the mixture of both sides that keeps the motion on the surface.
#pragma once

#include <optional>
#include <vector>

#include "motion/engine/frames.hpp"
#include "motion/engine/now.hpp"

namespace dinal::motion::engine {

/// The begin or end of a slide of a load or of the rate of a state.
struct SlideChange {
    std::optional<std::size_t> joint;  ///< joint of the load; none: a rate
    bool begins;
};

/// Manages the functions that slide and computes their mixtures. Reports no event.
class Slides {
public:
    /// `unit` is the time scale of the motion.
    Slides(Mechanics& mechanics, Frames& frames, double unit) : mechanics_(mechanics), frames_(frames), unit_(unit) {}

    [[nodiscard]] bool any() const { return !sliding_.empty(); }
    /// Returns whether the joint loaded by the function sticks.
    [[nodiscard]] bool stands(Piecewise& function, const Now& now) const;
    struct Begun {
        std::optional<std::size_t> joint;  ///< joint of the load; none: a rate
        double work;                       ///< work done by the load when velocities were moved onto the surface
    };
    /// Starts a slide along a condition that was crossed repeatedly; `jump` is the function's jump, `rates` the rates
    /// of y along it if known. Empty if the two sides do not drive the motion back.
    std::optional<Begun> begin(Piecewise& function, double jump, Now& now, const std::vector<double>& rates = {});
    /// Sets the mode of contacts to evaluate with.
    void follow(const Mode& mode) { mode_ = mode; }
    /// Returns whether sticking contacts now hold the velocities of a surface, so that the load does not move them.
    [[nodiscard]] bool lost(const Moment& here) const;
    /// Starts a slide of a motion that stands exactly on the surface and is about to leave it.
    void start(Piecewise& function, Now& now);
    /// Handles a changed condition of a slide: ends the slide, or continues it if the condition belongs to one side's
    /// piece. Returns false if this function does not slide.
    bool leave(Piecewise& function, std::size_t condition, Now& now, std::vector<SlideChange>& changes);
    /// Ends all slides, for use when all functions are decided anew. Returns them.
    std::vector<SlideChange> end();

private:
    struct Side {
        double margin = 0, rate = 0;
        std::vector<double> rates{};  ///< rates of y
    };
    [[nodiscard]] Side on(Piecewise& function, Piecewise::Slide::Side which, const Moment& at) const;
    /// The two sides; rates are those of the own side's margin, which must fall on the own side and rise beyond the
    /// surface.
    struct Sides {
        Side own, beyond;
        /// Returns whether the load from beyond drives the motion back more than that of the own side.
        [[nodiscard]] bool differ() const;
        [[nodiscard]] bool drive_back() const;
        /// Returns the rates of y on the surface.
        [[nodiscard]] std::vector<double> mixed() const;
    };
    [[nodiscard]] double share(Piecewise& function, const Moment& at) const;
    /// The right-hand acceleration of the belt of a joint.
    [[nodiscard]] double belt_rate(std::size_t joint, const Moment& at) const;

    Mechanics& mechanics_;
    Frames& frames_;
    double unit_;
    Mode mode_;
    struct Sliding {
        Piecewise* function;
        std::optional<std::size_t> joint;  ///< joint of the load; none: a rate
        double jump = 0;                   ///< jump of the function at the surface
    };
    [[nodiscard]] std::optional<Sliding> owner_of(Piecewise& function, double t) const;
    /// Makes the function slide along the condition that differs between both sides, with the pieces slightly later on
    /// a motion with these rates, or at present without rates. Empty if no condition differs.
    [[nodiscard]] std::optional<Sides> decide(const Sliding& of, const Now& now, const std::vector<double>& rates);
    /// Returns the sides if both drive the motion back, otherwise empty.
    [[nodiscard]] std::optional<Sides> meet(const Sliding& of, const Now& now, const std::vector<double>& rates);
    void put_on_surface(const Sides& sides, Now& now, double& work) const;
    std::vector<Sliding> sliding_;
};

}  // namespace dinal::motion::engine
