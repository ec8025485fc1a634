// Bounds of a motion over some steps, and of formulas on it.
#pragma once

#include <optional>
#include <vector>

#include "model/bounds.hpp"

namespace dinal::motion::engine {

struct Ranges {
    model::bounds::Interval t;
    std::vector<model::bounds::Interval> y{};  ///< ranges of all entries of y

    /// The range of the formula, on its piece if given, or of the quantity that decides `condition`; empty if unknown.
    /// `named`: the formula receives all of y as states.
    [[nodiscard]] std::optional<model::bounds::Interval> of(const model::Formula* formula,
                                                            const model::terms::Piece* piece, bool named,
                                                            double delay = 0,
                                                            std::optional<std::size_t> condition = {}) const;
};

}  // namespace dinal::motion::engine
