// The conditions on the motion in users' functions that are known as formulas: they are decided, watched and
// crossed.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "motion/engine/chatter.hpp"
#include "motion/engine/mechanics.hpp"
#include "motion/engine/segment.hpp"
#include "motion/engine/signal.hpp"
#include "motion/engine/slide.hpp"
#include "motion/engine/torque_sizes.hpp"

namespace dinal::motion::engine {

/// Keeps each function on one smooth piece until a condition changes. Changes no state and reports no event.
class Conditions {
public:
    /// `passed` is the number of values of the state passed to functions; `unit` is the time scale of the motion.
    Conditions(Mechanics& mechanics, Frames& frames, std::size_t passed, double start, double unit);

    bool any() const { return any_; }
    /// Returns whether a function of the motion has unknown pieces, so that it may jump anywhere.
    bool samples() const { return samples_; }
    /// Starts slides of loads that jump at the surface on which the motion rests.
    void start(Now& now) {
        mechanics_.for_each_piecewise(now.t.hi, [&](Piecewise& function) { slides_.start(function, now); });
        forgotten_ = forgotten_ && !slides_.any();
    }
    /// Discards all decisions, for use after the state has jumped.
    void forget() { forgotten_ = true, cease(); }
    /// Discards all decisions at a break, unless a condition passes zero there: its decision would be rounding. Slides
    /// continue if both sides still drive the motion back.
    void pass_break(Now& now) {
        if (now.t.hi == crossing_at_) return;
        forgotten_ = true;
        slides_.renew(now, ceased_);
    }
    void return_to_surfaces(Now& now) const { slides_.return_to_surfaces(now); }
    /// Announces that the stretch is repeated up to this time, at which a condition passes zero.
    void crosses_at(double t) { crossing_at_ = t; }

    /// Decides the conditions at a moment if a contact begins to hold a velocity or is about to release it from 0,
    /// since that velocity is exact. Other decisions stay, because rounding would reverse those that have just changed.
    void decide(const Moment& at, const Mode& mode, const Segment& last);
    /// Returns whether all conditions have decisions that certainly hold while the motion is within these ranges.
    [[nodiscard]] bool stay_clear(const Ranges& ranges, const Moment& from);
    const Slides& slides() const { return slides_; }
    /// Ends the stretch at the first change of a condition, if it precedes the present end.
    void watch(const Segment& segment, const std::vector<double>& begin, double now, Ending& ending);

    struct Crossed {
        bool jumps = false;     ///< whether a function has jumped
        std::size_t count = 0;  ///< number of functions that jumped, not counting friction laws
        Slides::Changes changes{};
        double work = 0;  ///< work done by the first sliding load when the velocities were moved onto the condition
        bool endless = false;
        double since = model::never;  ///< shortest time since an earlier crossing of one of these conditions
        /// A condition of a load that was crossed back and forth without a slide.
        struct Back {
            Piecewise* function;
            std::size_t condition;
            double since;  ///< time since its previous crossing
            double jump;   ///< jump of the function
        };
        std::optional<Back> back{};
    };
    /// Crosses the conditions at which the stretch has ended. A long row of tiny jumps comes from truncated digits:
    /// then all decisions are dropped, and the functions are sampled from there on. The same happens at a kink that
    /// rounding reverses. If both sides of a jump drive the motion back, the load slides along the condition, and the
    /// velocities are moved onto it.
    Crossed cross(const Ending& ending, Now& now, Chatter& chatter);
    /// Starts a slide along a condition on angles that was crossed back and forth, if both sides bend the motion back.
    std::optional<Slides::Begun> hold(const Crossed::Back& back, Now& now) {
        const auto& [step, beyond, of] = back.function->conditions()[back.condition];
        if (!is_of_place(*back.function, of)) return {};
        return slides_.begin(*back.function, {.jump = back.jump, .of_place = true}, now);
    }
    /// Ends the slides of loads whose joints now stick. Returns the slides that ended since the last call.
    std::vector<SlideChange> ceased(const Now& now) {
        if (slides_.any()) slides_.follow(now.mode), slides_.end_lost(now, ceased_);
        return std::exchange(ceased_, {});
    }

private:
    void let_go(double t);
    [[nodiscard]] double belt_of(std::size_t body, const Moment& at) const;
    [[nodiscard]] double least_slip(std::size_t body, const Moment& at) const;
    [[nodiscard]] std::vector<double> rounding_of(const Piecewise& function, const Moment& at,
                                                  const std::vector<double>& margins, double later,
                                                  const std::vector<double>& more) const;
    [[nodiscard]] bool decide_clearly(Piecewise& function, const Moment& at, std::uint64_t selected);
    void decide_by_rate(Piecewise& function, const Moment& at, const Mode& mode, std::uint64_t again);
    /// Returns whether a condition with these arguments depends on angles and time only.
    bool is_of_place(const Piecewise& function, std::uint64_t arguments) const {
        if (function.is_friction() || function.is_spring()) return function.is_spring();
        const std::size_t bodies = mechanics_.system().named ? mechanics_.bodies() : 1;
        return bodies < 64 && arguments >> bodies == 0;
    }
    bool comes_back(const Piecewise& function, std::size_t condition, double now) const;
    void cease() {
        for (const SlideChange& change : slides_.end()) ceased_.push_back(change);
    }

    Mechanics& mechanics_;
    std::size_t passed_;
    double unit_;
    bool any_ = false, samples_, forgotten_ = true;
    double crossing_at_ = -model::never;
    struct LastCrossing {
        bool rises = false;              ///< whether the decision became greater
        double t = -model::never;        ///< the time at which it changed
        double within = 0;               ///< greatest |margin| that counted as zero
        double earlier = -model::never;  ///< time of the previous crossing that was not at t
    };
    const LastCrossing& last_of(const Piecewise& function, std::size_t step) const {
        static const LastCrossing none;
        const auto found = last_.find({&function, step});
        return found == last_.end() ? none : found->second;
    }
    bool has_just_crossed(const Piecewise& function, std::uint64_t arguments, double now) const;
    /// The last crossing of each condition, by its step.
    std::map<std::pair<const Piecewise*, std::size_t>, LastCrossing> last_;
    std::map<const Piecewise*, double> crossed_;  ///< time of the last crossing of each function
    double crossed_at_ = -model::never;           ///< time of the last crossing of any condition
    double within_ = 0;                           ///< greatest |margin| that counts as zero at the next crossing
    int small_in_a_row_ = 0;                      ///< number of successive small jumps
    double greatest_ = 0;                         ///< greatest value or jump so far
    Slides slides_;
    std::vector<SlideChange> ceased_;
    TorqueSizes sizes_;
    std::vector<double> soon_;  ///< state slightly later, after a velocity has left 0
    /// for each joint: 0 free or sliding, 1 held, 2 or 3 about to leave in either direction
    std::vector<int> standing_;
};

}  // namespace dinal::motion::engine
