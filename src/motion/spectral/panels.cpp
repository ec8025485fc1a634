#include "motion/spectral/panels.hpp"

#include <algorithm>

namespace dinal::motion::spectral {

model::State Panel::at(double x) const {
    if (motion == model::Motion::stuck && begin.velocity == 0) return begin;
    if (x <= -1) return begin;
    const auto v = velocity();
    return {begin.theta + chebyshev::value(chebyshev::integral(v, 0), x), chebyshev::value(v, x) / h};
}

void Panels::add(const Panel& panel) {
    if (size_ == most_) complete_ = false;
    if (!complete_) return;
    if (size_ % chunk == 0) chunks_.push_back(std::make_unique_for_overwrite<Chunk>());
    (*chunks_.back())[size_ % chunk] = panel;
    ++size_;
}

void Panels::append(const Panels& later) {
    for (std::size_t i = 0; i < later.size(); ++i) add(later[i]);
    complete_ = complete_ && later.complete_;
}

double Panels::end() const {
    const Panel& last = (*this)[size_ - 1];
    return last.start.after(last.length);
}

model::State Panels::at(double t) const {
    // The last panel that begins at or before t.
    std::size_t low = 0, high = size_;
    while (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        ((*this)[middle].start.until(t) >= 0 ? low : high) = middle;
    }
    const Panel& panel = (*this)[low];
    return panel.at(std::min(panel.x(t), 1.0));
}

}  // namespace dinal::motion::spectral
