// Motions along a surface on which a load, or the rate of a state, jumps, where both sides drive them back (Filippov):
// the load is the mixture of both sides that keeps the motion on the surface.
#pragma once

#include <optional>
#include <vector>

#include "motion/engine/frames.hpp"
#include "motion/engine/now.hpp"

namespace dinal::motion::engine {

/// A load, or the rate of a state, begins or ceases to slide.
struct SlideChange {
    std::optional<std::size_t> joint;  ///< of the load; none: a rate
    bool begins;
};

/// Knows which functions slide, and finds their mixtures. It reports no event.
class Slides {
public:
    /// `unit`: of time.
    Slides(Mechanics& mechanics, Frames& frames, double unit) : mechanics_(mechanics), frames_(frames), unit_(unit) {}

    [[nodiscard]] bool any() const { return !sliding_.empty(); }
    /// Returns whether a contact holds the joint that the function loads.
    [[nodiscard]] bool stands(Piecewise& function, const Now& now) const;
    struct Begun {
        std::optional<std::size_t> joint;  ///< of the load; none: a rate
        double work;                       ///< of the load on the velocities, which are put on the surface
    };
    /// Slides along the condition of a function that was crossed to and fro and jumps by so much; `rates` of y: of the
    /// motion along it, if they are known. Returns none if that is not possible, or both sides do not drive the motion
    /// back.
    std::optional<Begun> begin(Piecewise& function, double jump, Now& now, const std::vector<double>& rates = {});
    /// Contacts have, or may have, this mode.
    void follow(const Mode& mode) { mode_ = mode; }
    /// Returns whether contacts now hold the velocities of a surface, so that the load does not move them.
    [[nodiscard]] bool lost(const Moment& here) const;
    /// The same where a motion starts at a standstill on the very surface, which a load is about to let it leave.
    void start(Piecewise& function, Now& now);
    /// One of the conditions of a slide has changed: it ends, or goes on if another one than its own has. Returns false
    /// if this function does not slide.
    bool leave(Piecewise& function, std::size_t condition, Now& now, std::vector<SlideChange>& changes);
    /// All functions are decided anew. Returns those that have slid.
    std::vector<SlideChange> end();

private:
    struct Side {
        double margin = 0, rate = 0;
        std::vector<double> rates{};  ///< of y
    };
    [[nodiscard]] Side on(Piecewise& function, Piecewise::Slide::Side which, const Moment& at) const;
    /// Both rates are those of the margin of the own side: there it must fall, and beyond the surface it must rise.
    struct Sides {
        Side own, beyond;
        /// Returns whether the load beyond drives the motion back more than that on the own side.
        [[nodiscard]] bool differ() const;
        [[nodiscard]] bool drive_back() const;
        /// Returns the rates of y along the surface.
        [[nodiscard]] std::vector<double> mixed() const;
    };
    [[nodiscard]] double share(Piecewise& function, const Moment& at) const;
    /// The acceleration of the belt of a joint, from here on.
    [[nodiscard]] double belt_rate(std::size_t joint, const Moment& at) const;

    Mechanics& mechanics_;
    Frames& frames_;
    double unit_;
    Mode mode_;
    struct Sliding {
        Piecewise* function;
        std::optional<std::size_t> joint;  ///< of the load
        double jump = 0;                   ///< of the function at the surface
    };
    [[nodiscard]] std::optional<Sliding> owner_of(Piecewise& function, double t) const;
    /// Lets the function slide along the condition that differs between both sides, on the pieces that it has a little
    /// later in a motion with these rates of y, or here if there are none. Returns none if no condition differs.
    [[nodiscard]] std::optional<Sides> decide(const Sliding& of, const Now& now, const std::vector<double>& rates);
    /// Decides whether it may slide now: both sides drive it back.
    [[nodiscard]] std::optional<Sides> meet(const Sliding& of, const Now& now, const std::vector<double>& rates);
    void put_on_surface(const Sides& sides, Now& now, double& work) const;
    std::vector<Sliding> sliding_;
};

}  // namespace dinal::motion::engine
