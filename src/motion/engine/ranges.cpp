#include "motion/engine/ranges.hpp"

namespace dinal::motion::engine {

using model::bounds::Interval;

std::optional<Interval> Ranges::of(const model::Formula* formula, const model::terms::Piece* piece, bool named,
                                   double delay, std::optional<std::size_t> condition) const {
    if (formula == nullptr || formula->gave_up()) return {};
    const std::size_t from = named ? 0 : 2;
    if (formula->state_count() != 0 && formula->state_count() != y.size() - from) return {};
    model::bounds::Walk walk;
    walk.begin(*formula, piece, true);
    const auto give = [&walk](std::size_t place, const Interval& range) {
        walk.set(place, {range.lo + (range.hi - range.lo) / 2, (range.hi - range.lo) / 2}, range);
    };
    give(0, {t.lo - delay, t.hi - delay});
    if (formula->takes_motion() && !named) give(1, y[0]), give(2, y[1]);
    for (std::size_t k = 0; k < formula->state_count(); ++k) give(formula->first_state() + k, y[from + k]);
    const Interval range = walk.run(condition).range;
    return range.is_anything() ? std::nullopt : std::optional(range);
}

}  // namespace dinal::motion::engine
