// Writes the rows of a run, each exactly at its time on the user's grid, and keeps the states at some of its steps:
// run:at() replays a part of the run from the nearest one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "motion/simulate.hpp"
#include "text/not_copied.hpp"

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

class RowWriter : text::NotCopied {
public:
    /// Requires a grid from Grid::within; reserves all its rows.
    RowWriter(const model::Oscillator& system, const Grid& grid, Run& run)
        : grid_(grid), run_(run), damping_(system.damping()) {
        Growing<double> table(grid.count(), column_count);
        column_ = table.writable_values();
        run.rows = Rows(std::move(table));
        set_next();
    }

    /// The time of the next row; `never` after the last one.
    double next_time() const { return next_time_; }
    std::size_t next_row() const { return next_; }

    void put(const model::State& y, double M, double friction) {
        double* row = column_ + next_;
        const AtRow at{next_time_, y, M, friction, damping_};
        for_each_column<body_columns>([&](std::size_t c, auto value) { row[c * grid_.count()] = value(at); });
        ++next_;
        set_next();
    }
    /// Writes consecutive rows of one motion, column by column.
    void put_block(std::size_t count, const double* theta, const double* velocity, const double* M, double friction) {
        count = std::min(count, grid_.count() - next_);
        for_each_column<body_columns>([&](std::size_t c, auto value) {
            double* row = column_ + c * grid_.count() + next_;
            for (std::size_t i = 0; i < count; ++i) {
                row[i] = value({grid_.time(next_ + i), {theta[i], velocity[i]}, M[i], friction, damping_});
            }
        });
        next_ += count;
        set_next();
    }
    /// Drops the unwritten rows of a run that ended early.
    void finish() {
        if (next_ < grid_.count()) {
            run_.rows = Rows(run_.rows.table().first(next_));
        }
    }
    /// The number of steps of length h between two rows if they coincide to rounding, otherwise 0.
    std::size_t steps_per_row(double h) const {
        const double ratio = grid_.dt() / h;
        const double whole = std::round(ratio);
        return whole >= 1 && std::fabs(ratio - whole) <= 4e-16 * whole ? static_cast<std::size_t>(whole) : 0;
    }

private:
    void set_next() { next_time_ = next_ < grid_.count() ? grid_.time(next_) : model::never; }

    const Grid& grid_;
    Run& run_;
    double damping_;
    double* column_ = nullptr;
    std::size_t next_ = 0;
    double next_time_ = model::never;
};

/// Runs an engine to its end and collects the results.
template <class Engine>
void run_whole(Engine& engine, const Problem& problem, RowWriter& rows, std::vector<model::Event>& events,
               std::shared_ptr<const Course> course, Run& run) {
    run.outcome = engine.run();
    rows.finish();
    run.t_start = problem.window.start;
    engine.leave(run);
    run.events = Growing<model::Event>(std::move(events));
    run.course = std::move(course);
}

}  // namespace dinal::motion
