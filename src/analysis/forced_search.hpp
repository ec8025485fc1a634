// Finds the motion that a run leads to and that repeats with what drives it, over any map from period to period: by
// Newton's method at once where the system contracts, otherwise from returns that come near to themselves.
#pragma once

#include <optional>
#include <vector>

#include "analysis/closed_search.hpp"
#include "analysis/steady.hpp"

namespace dinal::analysis {

class ForcedSearch {
public:
    ForcedSearch(const ForcedSearch&) = delete;
    ForcedSearch& operator=(const ForcedSearch&) = delete;
    virtual ~ForcedSearch() = default;

protected:
    ForcedSearch() = default;

    /// Sets facts_. `at_once`: whether to try Newton's method from the start. If no approach to a motion was seen,
    /// returns where the run has got to.
    std::optional<Map::Return> search(const SteadyQuestion& question, bool at_once);
    /// Tries Newton's method from there, as the approach may be slow. If a number of `periods` is given, not 0, a
    /// motion on which no run stays is better than none, also one near the start.
    void look_beside(const Map::Return& last, int periods);

    [[nodiscard]] virtual Map& map() = 0;
    /// The place where the search begins, in units of the motion about there; none if it could not be followed.
    virtual std::optional<Map::Return> begin() = 0;
    /// The same for a later place.
    virtual std::optional<Map::Return> measured(const Map::Return& from) = 0;
    /// The range of the last period that was measured.
    [[nodiscard]] virtual double range() const = 0;
    /// The size of a motion at this place.
    [[nodiscard]] virtual double size_at(const Map::Return& place) const = 0;
    /// Completes the answer for a closed motion; returns false if it is none, or no run stays on it and `any` is false.
    virtual bool complete(const Closed& found, bool any) = 0;
    /// Returns whether no motion can grow for ever.
    [[nodiscard]] virtual bool is_bounded() const = 0;
    /// Returns whether nothing holds the angle: it may drift for ever, which is growth.
    [[nodiscard]] virtual bool is_free() const = 0;

    SteadyMotion facts_;

private:
    [[nodiscard]] double growth_of(const std::vector<Map::Return>& seen) const;
    void note_failure(model::Outcome outcome, const std::vector<Map::Return>& seen);
    /// The greatest size among these places.
    [[nodiscard]] double largest(const std::vector<Map::Return>& seen, std::size_t from, std::size_t until) const;
};

}  // namespace dinal::analysis
