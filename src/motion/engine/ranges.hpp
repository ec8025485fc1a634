// The ranges in which a motion stays on some steps, and what functions that are read do there.
#pragma once

#include <optional>
#include <vector>

#include "model/bounds.hpp"

namespace dinal::motion::engine {

struct Ranges {
    model::bounds::Interval t;
    std::vector<model::bounds::Interval> y{};  ///< of all of y

    /// Returns a range of the function, on its piece if it has one, or of what decides the condition at this step of
    /// it. None if it is not known. `named`: it is given all of y as states.
    [[nodiscard]] std::optional<model::bounds::Interval> of(const model::Formula* formula,
                                                            const model::terms::Piece* piece, bool named,
                                                            double delay = 0,
                                                            std::optional<std::size_t> condition = {}) const;
};

}  // namespace dinal::motion::engine
