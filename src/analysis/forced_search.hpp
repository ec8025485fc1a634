// Finds the periodic motion that a run of a driven system approaches, by any period map: by Newton's method from the
// start if the system contracts, otherwise from returns that nearly repeat.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/steady.hpp"
#include "model/event.hpp"
#include "motion/engine/run.hpp"
#include "text/not_copied.hpp"

namespace dinal::analysis {

/// The discrete part of a state, which cannot change continuously.
struct HeldMode {
    motion::engine::Mode mode;
    std::vector<std::vector<motion::engine::Signal::Memory>> controllers;

    friend bool operator==(const HeldMode& a, const HeldMode& b);
};

/// Maps a place to the place one return later. A place is a vector of coordinates of order 1.
class Map {
public:
    struct Return {
        Eigen::VectorXd to;
        double time = 0;
        bool finished = false;
        model::Outcome outcome = model::Outcome::reached_end;
        std::optional<HeldMode> mode = {};                          ///< none if it follows from the place
        std::vector<std::pair<model::EventKind, int>> events = {};  ///< kind and joint of each event on the way
        /// with respect to the place; none: use differences
        std::optional<Eigen::MatrixXd> derivative = {};
    };
    struct Derivative {
        Eigen::MatrixXd by_place;
        double bend = 0;  ///< greatest deviation of one-sided slopes from their mean
    };

    Map() = default;
    Map(const Map&) = default;
    Map& operator=(const Map&) = delete;
    virtual ~Map() = default;

    /// Makes several returns.
    virtual Return operator()(const Eigen::VectorXd& from, const std::optional<HeldMode>& mode, int returns) = 0;
    /// The derivative of the map of several returns by differences of this order, 2 or 4, within the mode.
    virtual std::optional<Derivative> derivative(const Eigen::VectorXd& at, const std::optional<HeldMode>& mode,
                                                 int returns, int order) = 0;
    /// The rounding of a place; may exceed the digits of a tiny motion.
    virtual double rounding() const { return 0; }
};

/// A motion that closes after some returns.
struct Closed {
    Eigen::VectorXd x;
    std::optional<HeldMode> mode;
    int returns = 1;
    double period = 0, residual = 0;
};

/// The greatest magnitude of a component.
double size_of_step(const Eigen::VectorXd& step);

/// Finds a place to which a map returns: by Newton's method, from a start or from successive returns that come near to
/// themselves.
class ClosedSearch {
public:
    using Return = Map::Return;
    /// `maps` is increased by the number of returns computed; `longest` is the greatest number of returns after which a
    /// motion may close.
    ClosedSearch(Map& map, int& maps, int longest) : map_(map), maps_(maps), longest_(longest) {}

    /// Tries Newton's method from `from` for motions that close after `returns`. If `waits`, returns are computed when
    /// no Newton step helps, because each is closer in a contracting system.
    std::optional<Closed> at_once(const Return& from, int returns, bool waits);

    /// Makes returns until the motion closes; checks after each of `counts`.
    std::optional<Closed> follow(Return first, const std::vector<int>& counts);

    const std::vector<Return>& seen() const { return seen_; }
    /// The greatest distance of the last returns from earlier ones, in sizes of the motion; empty if they do not nearly
    /// repeat or there are too few.
    std::optional<double> nearest_repeat() const;
    std::optional<model::Outcome> failed() const { return failed_; }

private:
    /// A place, and its return.
    struct Try {
        Eigen::VectorXd x;
        std::optional<HeldMode> mode;
        Return back;
        Eigen::VectorXd off = {};
        double residual = 0;
        bool keeps_mode() const { return back.mode == mode; }
    };

    std::optional<Closed> find_closed(double near);
    Closed shortest(Closed found);
    bool approaches(const Eigen::VectorXd& x, std::size_t m) const;
    std::optional<Closed> itself(const Return& from, int m);
    std::optional<Closed> newton(const Return& from, int m, double farthest, bool waits);
    std::optional<Try> at(const Eigen::VectorXd& x, const std::optional<HeldMode>& mode, int m);
    /// Tries fractions of a Newton step; empty if none reduces the residual.
    std::optional<Try> nearer(const Try& now, const Eigen::VectorXd& step, int m);
    bool is_within(double residual, double tolerance) const {
        return residual <= tolerance || residual <= map_.rounding();
    }

    Map& map_;
    int& maps_;
    int longest_;
    std::vector<Return> seen_;
    std::optional<model::Outcome> failed_;
};

class ForcedSearch : text::NotCopied {
public:
    virtual ~ForcedSearch() = default;

protected:
    ForcedSearch() = default;

    /// Sets facts_. `at_once`: whether to try Newton's method from the start. If the run did not approach a motion,
    /// returns the place it has reached.
    std::optional<Map::Return> search(const SteadyQuestion& question, bool at_once);
    /// Tries Newton's method from `last`, as the approach may be slow. If `periods` is not 0, an unstable motion of
    /// this period is accepted, also one near the start.
    void look_beside(const Map::Return& last, int periods);

    [[nodiscard]] virtual Map& map() = 0;
    /// Runs the beginning and returns the first place, scaled by the motion; empty if the run failed.
    virtual std::optional<Map::Return> begin() = 0;
    /// Returns a later place with the scale of the motion there.
    virtual std::optional<Map::Return> measured(const Map::Return& from) = 0;
    /// The range of the last measured period.
    virtual double range() const = 0;
    virtual double size_at(const Map::Return& place) const = 0;
    /// Completes the answer for a closed motion. Returns false if it does not qualify, or is unstable and `any` is
    /// false.
    virtual bool complete(const Closed& found, bool any) = 0;
    /// Returns whether every motion stays bounded.
    virtual bool is_bounded() const = 0;
    /// Returns whether nothing restores the angle, which may then drift for ever and counts as growing.
    virtual bool is_free() const = 0;

    /// A motion that grows evenly at most doubles in the second half of a search; a greater ratio is not linear growth.
    static constexpr double faster = 2.5;
    SteadyMotion facts_;

private:
    double growth_of(const std::vector<Map::Return>& seen) const;
    void note_failure(model::Outcome outcome);
    /// The greatest size among the places `from` to `until` - 1.
    double largest(const std::vector<Map::Return>& seen, std::size_t from, std::size_t until) const;
};

}  // namespace dinal::analysis
