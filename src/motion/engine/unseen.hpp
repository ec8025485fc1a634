// Whether a function that is read may do, between the nodes of a stretch, what its series there does not.
#pragma once

#include <optional>
#include <vector>

#include "model/bounds.hpp"
#include "motion/engine/nodes.hpp"

namespace dinal::motion::engine {

/// A search on one stretch. A formula whose discs around the stretch are finite is analytic there, and its series is as
/// good as the radius tells; else the stretch is divided, and each part is compared with the series.
class Unseen {
public:
    /// What it looks at from now on; with a piece, held to that.
    void begin(model::Formula& formula, const model::terms::Piece* piece) {
        formula_ = &formula, piece_ = piece;
        inputs_.clear();
    }
    /// What the function is given in a register.
    void give(std::size_t place, const Series& series) { inputs_.push_back({place, series}); }

    /// It surely strays from its series by less, or by less than this part of what it is, and so does what decides the
    /// conditions of its piece from those.
    [[nodiscard]] bool is_told(double allowed, double part);

    struct Found {
        std::optional<double> place = {};  ///< it strays there, by more than is allowed
        bool proven = false;               ///< that it does not, anywhere
    };
    /// The same in parts, at most so many. `allowed` tells how much, from its series. With a `condition`, of what
    /// decides that.
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
    /// A part of the stretch, of which -1 to 1 is all. What may be farther off is looked at first.
    struct Part {
        double middle, half, off;
        bool operator<(const Part& other) const { return off != other.off ? off < other.off : half < other.half; }
    };
    void sample();
    [[nodiscard]] Found search(double allowed, int budget);
    [[nodiscard]] double value(double x);
    [[nodiscard]] double look(const Part& part, double allowed, std::optional<double>& place);

    model::Formula* formula_ = nullptr;
    const model::terms::Piece* piece_ = nullptr;
    std::optional<std::size_t> condition_ = {};
    std::vector<Input> inputs_ = {};
    Series series_{};
    model::bounds::Walk walk_ = {};
};

}  // namespace dinal::motion::engine
