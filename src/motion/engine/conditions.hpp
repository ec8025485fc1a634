// The conditions of the motion in users' functions that are read: each is decided, watched and crossed.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "motion/engine/chatter.hpp"
#include "motion/engine/ending.hpp"
#include "motion/engine/mechanics.hpp"
#include "motion/engine/ranges.hpp"
#include "motion/engine/slide.hpp"
#include "motion/engine/torque_sizes.hpp"

namespace dinal::motion::engine {

/// Holds the functions to their pieces. It changes no state and reports no event.
class Conditions {
public:
    /// `told`: the number of values of the state that functions are given; `unit`: of time.
    Conditions(Mechanics& mechanics, Frames& frames, std::size_t told, double start, double unit);

    [[nodiscard]] bool any() const { return any_; }
    /// Returns whether a function of the motion has no pieces that are known: it may jump anywhere.
    [[nodiscard]] bool samples() const { return samples_; }
    /// Loads slide from the start where it is a standstill on a surface on which they jump.
    void start(Now& now) {
        mechanics_.for_each_piecewise(now.t.hi, [&](Piecewise& function) { slides_.start(function, now); });
        forgotten_ = forgotten_ && !slides_.any();
    }
    /// All are decided anew the next time: the state has jumped.
    void forget() { forgotten_ = true; }
    /// The same at a break, unless that is where one of them passes zero and is not decided by rounding.
    void pass_break(double t) {
        if (t != crossing_at_) forgotten_ = true;
    }
    /// A stretch is made again, up to the time at which one passes zero.
    void crosses_at(double t) { crossing_at_ = t; }

    /// Decides them at a moment, if a contact begins to hold a velocity there or is about to let it leave 0: then the
    /// velocity is exact. Other decisions stay, because rounding would reverse those that have just passed zero.
    void decide(const Moment& at, const Mode& mode, const Segment& last);
    /// Returns whether all are decided, and certainly stay so from here on where the motion is within these ranges.
    [[nodiscard]] bool stay_clear(const Ranges& ranges, const Moment& from);
    [[nodiscard]] bool slides() const { return slides_.any(); }
    /// Ends the stretch where the first one changes, if that is before its end.
    void watch(const Segment& segment, const std::vector<double>& begin, double now, Ending& ending);

    struct Crossed {
        bool jumps = false;     ///< a function has jumped
        std::size_t count = 0;  ///< functions that have jumped, other than laws of friction
        std::vector<SlideChange> slides{};
        double work = 0;  ///< of the load of the first, which has put velocities on the condition
        bool endless = false;
        /// A load that was crossed to and fro, and does not slide.
        struct Back {
            Piecewise* function;
            std::size_t condition;
            double since;  ///< it was crossed before
        };
        std::optional<Back> back{};
    };
    /// Crosses those at which the stretch has ended. Many jumps in a row that are next to nothing are digits that the
    /// user has cut off: then all are let go, and the functions are sampled from there on; so they are beside a kink
    /// that rounding reverses. Where a load is driven back from both sides, it slides along the condition, and the
    /// velocities are put on it.
    Crossed cross(const Ending& ending, Now& now, Chatter& chatter);
    /// Where contacts hold, loads no longer slide. Returns those that have ceased to since the last call.
    std::vector<SlideChange> ceased(const Now& now) {
        if (slides_.any()) slides_.follow(now.mode);
        if (slides_.any() && (forgotten_ || slides_.lost(now.here()))) forget(), cease();
        return std::exchange(ceased_, {});
    }

private:
    void let_go(double t);
    [[nodiscard]] bool comes_back(const Piecewise& function, std::size_t condition, double now) const;
    void cease() {
        for (const SlideChange& change : slides_.end()) ceased_.push_back(change);
    }

    Mechanics& mechanics_;
    std::size_t told_;
    double unit_;
    bool any_ = false, samples_, forgotten_ = true;
    double crossing_at_ = -model::never;
    struct {
        const Piecewise* function = nullptr;
        std::size_t step = 0;
        double from = 0, t = -model::never;  ///< the decision that it had until then
        double within = 0;                   ///< it was taken to be so near to zero
        double earlier = -model::never;      ///< the time of the crossing before, which was not at t
        std::uint64_t of = 0;                ///< what it depends on
    } last_;
    double within_ = 0;       ///< the same of those that are about to be crossed
    int small_in_a_row_ = 0;  ///< jumps
    double greatest_ = 0;     ///< value or jump so far
    Slides slides_;
    std::vector<SlideChange> ceased_;
    TorqueSizes sizes_;
    std::vector<double> soon_;   ///< the state, where a velocity that leaves 0 has left
    std::vector<int> standing_;  ///< of each body: 0 it moves, 1 a contact holds it, 2 and 3 it is about to leave
};

}  // namespace dinal::motion::engine
