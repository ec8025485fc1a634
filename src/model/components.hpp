// The components of a sum, one after the other in memory. Sums that grow out of one another share them.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "model/terms.hpp"

namespace dinal::model {

/// gain * term for from <= t < to, else 0
struct Component {
    double gain = 1;
    Term term;
    double from = -never, to = never;
};

/// From when on it is known to be constant for ever; `never` when that is not known.
double constant_from(const Component& component);
/// The first time after t at which it or a derivative of it jumps; `never` if there is none.
double next_break(const Component& component, double t);
/// What must be looked at closely in it, as far as the window shows it; empty (from >= to) when there is nothing.
terms::Detail detail_of(const Component& component);

/// A list that never changes. Joining two costs what the shorter one is long, on average over a sum that grows term by
/// term, and copying one costs nothing.
// The places for components are shared: a list sees a stretch of them. Where there is a free place beside the stretch
// of the longer list, the shorter one is written there, which no other list sees; else both move to new and more
// places. A place is taken once, also when two threads want it. What is written lives as long as any list with these
// places.
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
        std::vector<Component> all;            // as many as there will ever be
        std::atomic<std::size_t> first, last;  // taken: [first, last)
    };
    Components(std::shared_ptr<Places> places, std::size_t first, std::size_t count);

    /// The place of this list's first component.
    [[nodiscard]] std::size_t first() const;
    /// Takes `count` free places beside this list.
    [[nodiscard]] bool take_after(std::size_t count) const;
    [[nodiscard]] bool take_before(std::size_t count) const;

    std::shared_ptr<Places> places_;
    std::span<const Component> stretch_;
};

}  // namespace dinal::model
