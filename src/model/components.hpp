// The components of a sum, contiguous in memory; sums derived from one another share them.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "model/terms.hpp"

namespace dinal::model {

/// gain * term for from <= t < to, otherwise 0
struct Component {
    double gain = 1;
    Term term;
    double from = -never, to = never;
};

/// The time from which the component is constant for ever; `never` if unknown.
double constant_from(const Component& component);
/// The first time after t at which the component or a derivative of it jumps; `never` if there is none.
double next_break(const Component& component, double t);
/// The finest detail of the component within its window; empty (from >= to) if there is none.
terms::Detail detail_of(const Component& component);

/// An immutable list. Copies cost nothing; joining two costs the length of the shorter one, amortised over a sum that
/// grows term by term.
// The storage is shared: a list is a range of it. The shorter list is written beside the range of the longer one if
// there is free space, which no other list sees; otherwise both move to larger storage. A place is claimed only once,
// also by concurrent threads, and lives as long as any list that uses the storage.
class Components {
public:
    Components() = default;
    explicit Components(std::vector<Component> all);

    [[nodiscard]] std::span<const Component> all() const { return stretch_; }
    [[nodiscard]] static Components joined(const Components& a, const Components& b);

private:
    struct Places {
        Places(std::vector<Component> places, std::size_t begin, std::size_t end)
            : all(std::move(places)), first(begin), last(end) {}
        std::vector<Component> all;            // all places, free or taken
        std::atomic<std::size_t> first, last;  // the taken range [first, last)
    };
    Components(std::shared_ptr<Places> places, std::size_t first, std::size_t count);

    /// The index of this list's first component in the storage.
    [[nodiscard]] std::size_t first_place() const;
    /// Claim `count` free places behind or before this list; return false if they are taken.
    [[nodiscard]] bool claim_after(std::size_t count) const;
    [[nodiscard]] bool claim_before(std::size_t count) const;

    std::shared_ptr<Places> places_;
    std::span<const Component> stretch_;
};

}  // namespace dinal::model
