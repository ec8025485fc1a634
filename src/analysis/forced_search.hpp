// Finds the periodic motion that a run of a driven system approaches, by any period map: by Newton's method from the
// start if the system contracts, otherwise from returns that nearly repeat.
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
    [[nodiscard]] virtual double range() const = 0;
    /// The size of a motion at this place.
    [[nodiscard]] virtual double size_at(const Map::Return& place) const = 0;
    /// Completes the answer for a closed motion. Returns false if it does not qualify, or is unstable and `any` is
    /// false.
    virtual bool complete(const Closed& found, bool any) = 0;
    /// Returns whether every motion stays bounded.
    [[nodiscard]] virtual bool is_bounded() const = 0;
    /// Returns whether nothing restores the angle, which may then drift for ever and counts as growing.
    [[nodiscard]] virtual bool is_free() const = 0;

    SteadyMotion facts_;

private:
    [[nodiscard]] double growth_of(const std::vector<Map::Return>& seen) const;
    void note_failure(model::Outcome outcome, const std::vector<Map::Return>& seen);
    /// The greatest size among the places `from` to `until` - 1.
    [[nodiscard]] double largest(const std::vector<Map::Return>& seen, std::size_t from, std::size_t until) const;
};

}  // namespace dinal::analysis
