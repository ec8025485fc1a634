// Decides whether a formula may deviate, between the nodes of a stretch, from its series there.
#pragma once

#include <optional>
#include <vector>

#include "model/bounds.hpp"
#include "motion/engine/mechanics.hpp"
#include "motion/engine/nodes.hpp"
#include "motion/engine/segment.hpp"

namespace dinal::motion::engine {

/// A search on one stretch. If the discs around the stretch are finite, the formula is analytic there, and the radius
/// bounds the error of its series; otherwise the stretch is divided and each part compared.
class Unseen {
public:
    /// Starts with a formula, evaluated on `piece` if given.
    void begin(model::Formula& formula, const model::terms::Piece* piece) {
        formula_ = &formula, piece_ = piece;
        inputs_.clear();
    }
    /// Sets an argument of the function.
    void give(std::size_t place, const Series& series) { inputs_.push_back({place, series}); }

    /// Returns whether it certainly deviates from its series by at most `allowed`, or by this part of its value, and
    /// the deciders of its piece's conditions by little as well.
    [[nodiscard]] bool is_told(double allowed, double part);

    struct Found {
        std::optional<double> place = {};  ///< a point with a larger deviation than allowed
        bool proven = false;               ///< whether there is none
    };
    /// The same by division into at most `budget` parts. `allowed` returns the tolerance for a series. With
    /// `condition`, checks the quantity that decides this condition.
    template <class Allowed>
    [[nodiscard]] Found search(std::optional<std::size_t> condition, int budget, const Allowed& allowed) {
        condition_ = condition;
        sample();
        return search(allowed(series_), budget);
    }
    [[nodiscard]] const model::terms::Piece* piece() const { return piece_; }
    /// What the function may be off in the middle of the stretch by the rounding of its steps; not finite if that is
    /// not known.
    [[nodiscard]] double rounded();

private:
    struct Input {
        std::size_t place;
        Series series;
    };
    /// A part of the stretch -1 to 1; parts with the greatest possible deviation come first.
    struct Part {
        double middle, half, off;
        bool operator<(const Part& other) const { return off != other.off ? off < other.off : half < other.half; }
    };
    void sample();
    [[nodiscard]] Found search(double allowed, int budget);
    [[nodiscard]] double value(double x);
    [[nodiscard]] double deviation_on(const Part& part, double allowed, std::optional<double>& place);

    model::Formula* formula_ = nullptr;
    const model::terms::Piece* piece_ = nullptr;
    std::optional<std::size_t> condition_ = {};
    std::vector<Input> inputs_ = {};
    Series series_{};
    model::bounds::Walk walk_ = {};
};

/// Proves for stretch after stretch that functions that are read do nothing between its nodes that their series do not.
/// It changes nothing of the motion.
class Proofs {
public:
    /// The sizes beside which functions act.
    struct Beside {
        double tolerance;
        const std::vector<double>& torques;  ///< on each body
        const Floor& floor;
        const std::vector<double>&fastest_belt, &fastest_rate;  ///< of each joint, and of each state, so far
    };
    explicit Proofs(const Mechanics& mechanics) : mechanics_(mechanics), any_(mechanics.has_functions()) {}

    /// Returns false if one does something else, at seen(), before the place `until`. The stretch is marked if that
    /// could not be proven.
    bool hides_nothing(Segment& segment, const Mode& mode, const Beside& beside, double until = 1);
    /// Returns the rounding of functions that are read, at the beginning of the stretch: of the torques on each body
    /// and of the rate of each state.
    std::vector<double> roundings(const Segment& segment, const Mode& mode);
    /// The time at which a load did what its series does not: it is looked at until it is behind.
    [[nodiscard]] double seen() const { return seen_; }
    void see(double t) { seen_ = t; }
    /// Returns whether nothing could be proven for the last stretch.
    [[nodiscard]] bool failed_last() const { return failed_in_a_row_ > 0; }

private:
    const Mechanics& mechanics_;
    bool any_;  ///< function
    Unseen unseen_;
    double seen_ = -model::never;
    int failed_in_a_row_ = 0;
    std::vector<double> point_;
};

}  // namespace dinal::motion::engine
