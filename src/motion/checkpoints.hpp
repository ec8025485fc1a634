// A run's states at some of its steps. run:at() replays a part of the run from the nearest one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dinal::motion {

/// Evenly spaced checkpoints in bounded memory: when full, every second one is dropped. A Checkpoint is an integrator's
/// own record of its state, with the number of its `step`.
template <class Checkpoint>
class Checkpoints {
public:
    explicit Checkpoints(std::size_t steps) { list_.reserve(std::min(steps / spacing_ + 2, most)); }

    bool due(std::size_t step) const { return step == next_; }
    std::size_t next() const { return next_; }
    void add(const Checkpoint& checkpoint) {
        if (list_.size() == most) thin_out();
        if (checkpoint.step % spacing_ == 0) list_.push_back(checkpoint);
        next_ = (checkpoint.step / spacing_ + 1) * spacing_;
    }
    /// The last checkpoint at or before this step, and the next one (null at the end).
    const Checkpoint& before(std::size_t step) const { return list_[index(step)]; }
    const Checkpoint* after(std::size_t step) const {
        const std::size_t i = index(step) + 1;
        return i < list_.size() ? &list_[i] : nullptr;
    }

private:
    std::size_t index(std::size_t step) const { return std::min(step / spacing_, list_.size() - 1); }
    void thin_out() {
        for (std::size_t i = 0; 2 * i < list_.size(); ++i) list_[i] = list_[2 * i];
        list_.resize((list_.size() + 1) / 2);
        spacing_ *= 2;
    }

    static constexpr std::size_t most = 1 << 15;
    std::size_t spacing_ = 128;  // a block of steps of the Runge-Kutta engine
    std::size_t next_ = 0;
    std::vector<Checkpoint> list_;
};

}  // namespace dinal::motion
