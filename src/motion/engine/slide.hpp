// Slides of the motion along a surface on which a load, or the rate of a state, jumps and both sides drive the motion
// back (Filippov). The load is then the mixture of both sides that keeps the motion on the surface. If the condition
// depends on angles and time only, the loads accelerate the motion back to the surface, which it passes at ever shorter
// intervals; such a surface is called a place.
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
    /// Slides that begin or end, and all functions in them.
    struct Changes {
        std::vector<SlideChange> slides{};
        std::vector<const Piecewise*> functions{};
    };
    struct Begun {
        Changes changes{};
        double work = 0;  ///< work done by the loads when velocities were moved onto the surface
    };
    /// A condition that was crossed.
    struct Crossing {
        double jump = 0;                 ///< jump of the function
        bool of_place = false;           ///< whether the condition depends on angles and time only
        std::vector<double> rates = {};  ///< rates of y along the surface, if known
    };
    /// Starts a slide along a condition that was crossed repeatedly. Empty if the two sides do not drive the motion
    /// back, or, at a place, if the passages do not become shorter or the contact there sticks.
    std::optional<Begun> begin(Piecewise& function, const Crossing& crossing, Now& now);
    /// Returns whether the slides hold the slip of a joint: whether it depends on what this frame holds and on surfaces
    /// that stand still, and on nothing that moves, such as a belt.
    [[nodiscard]] bool holds_slip(std::size_t joint, const Mode& mode, const Frame& frame, const Moment& at) const;
    /// Moves the bodies on, with the velocities of those that belts carry along, until a belt that turns now has
    /// clearly moved. Returns that moment.
    Moment advance_with_belts(const Moment& at, const Mode& mode, std::vector<double>& y) const;
    /// The rates of y in this mode, with functions evaluated at this very moment, not on their pieces.
    [[nodiscard]] std::vector<double> free_rates(const Mode& mode, const Moment& at);
    /// The rate of the slip of a joint at these rates of y.
    [[nodiscard]] double slip_rate(std::size_t joint, const std::vector<double>& rates, const Moment& at) const;
    /// Sets the mode of contacts to evaluate with.
    void follow(const Mode& mode) { mode_ = mode; }
    /// Ends slides if sticking contacts now hold the velocities of the surface, so that the load does not move them.
    void end_lost(const Now& now, std::vector<SlideChange>& changes);
    /// Returns whether contacts have ended a slide of this function at this time, so that its side is known.
    [[nodiscard]] bool just_left(const Piecewise& function, double t) const {
        return left_at_ == t && left_.has(function);
    }
    /// Removes the error of a stretch from the velocities that slides hold, because other contacts may be compared with
    /// them.
    void return_to_surfaces(Now& now) const;
    /// Continues slides behind a break, or ends those that do not exist there.
    void renew(Now& now, std::vector<SlideChange>& changes);
    /// Starts a slide if the motion stands exactly on the surface and is about to leave it.
    void start(Piecewise& function, Now& now);
    /// Handles a changed condition of a slide: ends the slide, or continues it if the condition belongs to one side's
    /// piece. Returns false if this function does not slide.
    bool leave(Piecewise& function, std::size_t condition, Now& now, Changes& changes);
    /// Ends all slides, for use when all functions are decided anew. Returns them.
    std::vector<SlideChange> end();

private:
    struct Side {
        /// margin and its rate; at a place, a combination of the margin and its rate, and the rate of that rate
        double margin = 0, rate = 0;
        std::vector<double> rates{};  ///< rates of y
        double off = 0, speed = 0;    ///< at a place: the margin itself and its rate
    };
    /// The two sides; rates are those of the own side's margin, which must fall on the own side and rise beyond the
    /// surface.
    struct Sides {
        Side own, beyond;
        /// Returns whether the load from beyond drives the motion back more than that of the own side.
        [[nodiscard]] bool differ() const;
        [[nodiscard]] bool drive_back() const;
        /// Returns whether one side neither drives the motion back nor away, to rounding, and the other one back.
        [[nodiscard]] bool at_limit() const;
        /// Returns the rates of y on the surface.
        [[nodiscard]] std::vector<double> mixed() const;
    };
    /// Returns the velocity at which moving belts carry each body along.
    [[nodiscard]] std::vector<double> carried_by_belts(const Mode& mode, const Moment& at) const;
    /// The right-hand acceleration of the belt of a joint.
    [[nodiscard]] double belt_rate(std::size_t joint, const Moment& at) const;

    /// Functions that jump at one surface, and so have one share.
    struct Sliding {
        Piecewise* function = nullptr;
        std::optional<std::size_t> joint{};  ///< joint of the load; none: a rate
        double jump = 0;                     ///< jump of the function at the surface
        bool of_place = false;
        std::vector<Piecewise*> along{};    ///< the other functions
        std::vector<std::size_t> joints{};  ///< joints of all loads among them

        template <class F>
        void each(const F& call) const;
        [[nodiscard]] bool has(const Piecewise& one) const;
        void use_side(Piecewise::Slide::Side which) const;
        void add_changes(bool begins, std::vector<SlideChange>& changes) const;
    };
    [[nodiscard]] bool others_jump(const Sliding& of, const Now& now, const Sides& sides) const;
    [[nodiscard]] bool passes_fade(const Sliding& of, const Now& now, const Sides& sides);
    [[nodiscard]] std::vector<double> rates_at(const Moment& at) const;
    [[nodiscard]] Side side_of(const Sliding& of, const Moment& at, std::vector<double> rates) const;
    /// The rates of y with the own sides of all slides, and with one of them beyond its surface.
    struct Mixing {
        std::vector<const Sliding*> of;
        std::vector<double> own{};
        std::vector<std::vector<double>> beyond{};
    };
    [[nodiscard]] Mixing mixing(std::vector<const Sliding*> of, const Moment& at) const;
    std::vector<double> keep(const Mixing& all, const std::vector<std::size_t>& staying, const Moment& at,
                             std::vector<double>& rates) const;
    [[nodiscard]] Sides both(const Sliding& of, const Moment& at) const;
    [[nodiscard]] bool falls_if_held(const Sliding& of, const Side& own, const Moment& at) const;
    [[nodiscard]] double share(const Sliding& of, const Moment& at) const;
    [[nodiscard]] std::optional<Sliding> owner_of(Piecewise& function, double t) const;
    [[nodiscard]] std::size_t first_held(const Sliding& of) const;
    [[nodiscard]] bool stands_still(const Sliding& of, const std::vector<double>& slopes, const Moment& at) const;
    [[nodiscard]] static std::vector<double> gradient(const Piecewise& function, const Moment& at);
    [[nodiscard]] bool is_same_surface(const Sliding& of, const Piecewise& other, const Moment& at) const;
    void move_aside(const Sliding& of, double side, std::vector<double>& y) const;
    void move_out(const Sliding& of, double side, std::vector<double>& y) const;
    [[nodiscard]] double rate_beside(const Sliding& of, const Now& now, const std::vector<double>& y);
    [[nodiscard]] std::vector<std::pair<Piecewise*, Piecewise>> all_functions(double t);
    [[nodiscard]] std::vector<Sliding>::iterator slide_of(const Piecewise& function);
    /// Makes the functions slide that jump along the condition that differs between both sides, with the pieces
    /// slightly later on a motion with these rates, or at present without rates. Empty if no condition differs.
    [[nodiscard]] std::optional<Sides> decide(Sliding& of, const Now& now, const std::vector<double>& rates);
    /// Returns whether both sides drive the motion back now, or a little later if it is at the limit now.
    [[nodiscard]] bool drive_back(const Sliding& of, const Now& now, const Sides& sides) const;
    /// Returns the sides if both drive the motion back, otherwise empty.
    [[nodiscard]] std::optional<Sides> find_sides(Sliding& of, const Now& now, const std::vector<double>& rates);
    void put_on_surface(const Sliding& of, const Sides& sides, Now& now, double& work) const;
    [[nodiscard]] std::optional<std::vector<double>> rates_along(const Piecewise& function, std::size_t condition,
                                                                 const Now& now, const Sides& sides) const;

    Mechanics& mechanics_;
    Frames& frames_;
    double unit_;
    Mode mode_;
    std::vector<Sliding> sliding_;
    Sliding left_;                    ///< the slide that contacts ended last
    double left_at_ = -model::never;  ///< the time at which they did
};

}  // namespace dinal::motion::engine
