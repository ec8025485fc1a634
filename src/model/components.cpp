#include "model/components.hpp"

#include <algorithm>

namespace dinal::model {
namespace {

/// The time from which a term is constant, and whether it is 0 then.
struct Settled {
    double time;
    bool at_zero;
};
Settled settled(const Component& c) {
    return std::visit(
        [](const auto& term) -> Settled {
            if (term.most() == 0) return {-never, true};
            const double time = term.constant_from();
            if constexpr (terms::NativeTerm<std::decay_t<decltype(term)>>) {
                return {time, time < never && term.value(time) == 0};
            }
            return {time, false};
        },
        c.term);
}

}  // namespace

double next_break(const Component& c, double t) {
    if (c.gain == 0 || t >= c.to) {
        return never;
    }
    if (t < c.from) {
        return c.from;
    }
    return std::min(c.to, std::visit([t](const auto& term) { return term.next_break(t); }, c.term));
}

double constant_from(const Component& c) {
    if (c.gain == 0) {
        return -never;
    }
    const auto [time, at_zero] = settled(c);
    if (c.to < never) {
        return at_zero ? std::min(c.to, time) : c.to;
    }
    return at_zero ? time : std::max(c.from, time);
}

terms::Detail detail_of(const Component& c) {
    if (c.gain == 0) {
        return {};
    }
    const terms::Detail whole = std::visit([](const auto& term) { return terms::detail_of(term); }, c.term);
    return {std::max(c.from, whole.from), std::min(c.to, whole.to), whole.apart};
}

Components::Components(std::shared_ptr<Places> places, std::size_t first, std::size_t count)
    : places_(std::move(places)), stretch_(places_->all.data() + first, count) {}

Components::Components(std::vector<Component> all) {
    const std::size_t count = all.size();
    places_ = std::make_shared<Places>(std::move(all), 0, count);
    stretch_ = places_->all;
}

std::size_t Components::first_place() const {
    return static_cast<std::size_t>(stretch_.data() - places_->all.data());
}

bool Components::claim_after(std::size_t count) const {
    std::size_t last = first_place() + stretch_.size();
    return places_->all.size() - last >= count && places_->last.compare_exchange_strong(last, last + count);
}

bool Components::claim_before(std::size_t count) const {
    std::size_t begin = first_place();
    return begin >= count && places_->first.compare_exchange_strong(begin, begin - count);
}

Components Components::joined(const Components& a, const Components& b) {
    const std::size_t n = a.stretch_.size(), m = b.stretch_.size();
    if (n == 0 || m == 0) {
        return n == 0 ? b : a;
    }
    if (m <= n && a.claim_after(m)) {
        std::copy(b.stretch_.begin(), b.stretch_.end(),
                  a.places_->all.begin() + static_cast<std::ptrdiff_t>(a.first_place() + n));
        return {a.places_, a.first_place(), n + m};
    }
    if (n <= m && b.claim_before(n)) {
        const std::size_t first = b.first_place() - n;
        std::copy(a.stretch_.begin(), a.stretch_.end(), b.places_->all.begin() + static_cast<std::ptrdiff_t>(first));
        return {b.places_, first, n + m};
    }
    // Twice as many places, with free ones on both sides: a sum may grow at either end.
    const std::size_t first = (n + m) / 2;
    const auto places = std::make_shared<Places>(std::vector<Component>(2 * (n + m)), first, first + n + m);
    const auto middle =
        std::copy(a.stretch_.begin(), a.stretch_.end(), places->all.begin() + static_cast<std::ptrdiff_t>(first));
    std::copy(b.stretch_.begin(), b.stretch_.end(), middle);
    return {places, first, n + m};
}

}  // namespace dinal::model
