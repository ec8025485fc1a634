// Decides whether a formula can deviate between the nodes of a stretch from its series.
#pragma once

#include <optional>
#include <vector>

#include "model/bounds.hpp"
#include "motion/engine/mechanics.hpp"
#include "motion/engine/nodes.hpp"
#include "motion/engine/segment.hpp"

namespace dinal::motion::engine {

/// A test on one stretch. If the complex discs around the stretch have bounded images, the formula is analytic there,
/// and their radius bounds the error of its series. Otherwise the stretch is divided and each part is tested.
class Unseen {
public:
    /// Starts with a formula, evaluated on `piece` if given.
    void begin(model::Formula& formula, const model::terms::Piece* piece) {
        formula_ = &formula, piece_ = piece;
        inputs_.clear();
    }
    /// Sets an argument of the function.
    void give(std::size_t place, const Series& series) { inputs_.push_back({place, series}); }

    /// Returns whether the formula certainly deviates from its series by at most `allowed` or the fraction `part` of
    /// its value, and the operands of its piece's conditions by little as well.
    [[nodiscard]] bool certainly_follows(double allowed, double part);

    struct Found {
        std::optional<double> place = {};  ///< a point with a larger deviation than allowed
        bool proven = false;               ///< whether no such point exists
    };
    /// The same test by division into at most `budget` parts. `allowed` returns the tolerance for a series. With
    /// `condition`, tests the quantity that decides this condition.
    template <class Allowed>
    [[nodiscard]] Found search(std::optional<std::size_t> condition, int budget, const Allowed& allowed) {
        condition_ = condition;
        sample();
        return search(allowed(series_), budget);
    }
    [[nodiscard]] const model::terms::Piece* piece() const { return piece_; }
    /// The error of the function, or of the quantity that decides a condition, in the middle of the stretch due to
    /// rounding in its steps, for a condition also in its arguments; not finite if unknown.
    [[nodiscard]] double rounded(std::optional<std::size_t> condition = {});

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

/// Proves for each stretch that functions known as formulas follow their series between its nodes. Does not change the
/// motion.
class Proofs {
public:
    /// Scales relative to which errors of functions are allowed.
    struct Beside {
        double tolerance;
        const std::vector<double>& torques;  ///< magnitude on each body
        const Floor& floor;
        const std::vector<double>&fastest_belt, &fastest_rate;  ///< greatest so far, for each joint and each state
    };
    explicit Proofs(const Mechanics& mechanics) : mechanics_(mechanics), any_(mechanics.has_functions()) {}

    /// Returns false if a function deviates before the point `until`; seen() is then its time. Sets Segment::proven to
    /// false if nothing could be proven.
    bool hides_nothing(Segment& segment, const Mode& mode, const Beside& beside, double until = 1);
    /// Returns the rounding of formulas at the start of the stretch: of the torques on each body and of the rate of
    /// each state.
    std::vector<double> roundings(const Segment& segment, const Mode& mode);
    /// The greatest rounding of the formulas of a belt on the stretch, and of those of a friction limit at rest.
    double rounding_of_belt(const Segment& segment, std::size_t joint);
    double rounding_of_limit(const Segment& segment, const Mode& mode, std::size_t joint);
    /// The time at which a load deviated from its series; loads are sampled until it has passed.
    [[nodiscard]] double seen() const { return seen_; }
    void note_deviation(double t) { seen_ = t; }
    [[nodiscard]] bool failed_last() const { return failed_in_a_row_ > 0; }

private:
    double rounding_at(std::size_t node, const Segment& segment, model::Formula& formula,
                       const model::terms::Piece* piece, double first, const double* speed);
    double rounding_at(std::size_t node, const Segment& segment, const Signal& signal);

    const Mechanics& mechanics_;
    bool any_;  ///< whether there is any user function
    Unseen unseen_;
    double seen_ = -model::never;
    int failed_in_a_row_ = 0;
    std::vector<double> point_;
};

}  // namespace dinal::motion::engine
