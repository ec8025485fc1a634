#include "plots/pen_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace dinal::plots {

void Corners::add(std::size_t i, Point point) {
    if (!open_) {
        begin(i, point);
        return;
    }
    const double dx = point.x - corner_.x;
    const double dy = point.y - corner_.y;
    const double distance = std::hypot(dx, dy);
    if (distance <= tolerance_ && reach_ <= tolerance_) {
        last_ = i;
        last_point_ = point;
        return;
    }
    const double direction = std::atan2(dy, dx);
    const double half = std::asin(std::min(1.0, tolerance_ / distance));
    const double turn = has_cone_ ? std::remainder(direction - middle_, 2 * std::numbers::pi) : 0;
    if (has_cone_ && (turn < low_ || turn > high_ || distance < reach_ - tolerance_)) {
        const std::size_t corner = last_;
        const Point corner_point = last_point_;
        begin(corner, corner_point);
        add(i, point);
        return;
    }
    if (!has_cone_) {
        has_cone_ = true;
        middle_ = direction;
        low_ = -half;
        high_ = half;
    } else {
        low_ = std::max(low_, turn - half);
        high_ = std::min(high_, turn + half);
    }
    reach_ = std::max(reach_, distance);
    last_ = i;
    last_point_ = point;
}

void Corners::finish() {
    if (open_ && last_ != kept_.back()) {
        kept_.push_back(last_);
    }
    open_ = false;
}

void Corners::begin(std::size_t i, Point point) {
    kept_.push_back(i);
    open_ = true;
    has_cone_ = false;
    corner_ = last_point_ = point;
    last_ = i;
    reach_ = 0;
}

Ink::Ink(Box pixels, double cell)
    : cell_(cell),
      columns_(static_cast<int>(std::ceil(pixels.width / cell)) + 1),
      rows_(static_cast<int>(std::ceil(pixels.height / cell)) + 1),
      inked_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), false) {}

bool Ink::dot(Point point) {
    const double column = point.x / cell_;
    const double row = point.y / cell_;
    if (!(column >= 0 && row >= 0 && column < columns_ && row < rows_)) {
        return false;
    }
    const std::size_t here = place(static_cast<int>(column), static_cast<int>(row));
    const bool blank = !inked_[here];
    inked_[here] = true;
    return blank;
}

void Ink::line(Line line) {
    if (!clip(line, {columns_ * cell_, rows_ * cell_}, 0)) {
        return;
    }
    const auto& [from, to] = line;
    const double length = std::max(std::fabs(to.x - from.x), std::fabs(to.y - from.y));
    const int steps = static_cast<int>(std::ceil(length / cell_));
    walked_ += steps;
    for (int i = 0; i < steps; ++i) {
        const double part = static_cast<double>(i) / steps;
        dot({from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)});
    }
    dot(to);
}

std::vector<std::vector<Ink::Run>> Ink::runs_of_rows() const {
    std::vector<std::vector<Run>> rows(static_cast<std::size_t>(rows_));
    for (int row = 0; row < rows_; ++row) {
        auto& runs = rows[static_cast<std::size_t>(row)];
        for (int column = 0; column < columns_; ++column) {
            if (!inked_[place(column, row)]) {
                continue;
            }
            if (runs.empty() || runs.back().end < column) {
                runs.push_back({column, column});
            }
            runs.back().end = column + 1;
        }
    }
    return rows;
}

Strokes Ink::strokes(double pen) const {
    const std::vector<std::vector<Run>> rows = runs_of_rows();
    const double radius = pen / 2 / cell_;  // in cells
    const int reach = static_cast<int>(radius);
    Strokes strokes{{}, cell_};
    std::vector<int> change;  // of the number of runs that ink a cell, from the cell before
    for (int row = 0; row < rows_; ++row) {
        change.assign(static_cast<std::size_t>(columns_) + 1, 0);
        for (int other = std::max(0, row - reach); other <= std::min(rows_ - 1, row + reach); ++other) {
            const int more = static_cast<int>(std::sqrt(radius * radius - (other - row) * (other - row)));
            for (const Run& run : rows[static_cast<std::size_t>(other)]) {
                ++change[static_cast<std::size_t>(std::max(0, run.begin - more))];
                --change[static_cast<std::size_t>(std::min(columns_, run.end + more))];
            }
        }
        int runs = 0;
        for (int column = 0; column <= columns_; ++column) {
            const int before = std::exchange(runs, runs + change[static_cast<std::size_t>(column)]);
            if (before == 0 && runs > 0) {
                strokes.all.push_back({column * cell_, 0, (row + 0.5) * cell_});
            } else if (before > 0 && runs == 0) {
                strokes.all.back().to = column * cell_;
            }
        }
    }
    return strokes;
}

Ink Ink::coarser() const {
    Ink result({columns_ * cell_, rows_ * cell_}, 2 * cell_);
    for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
            if (inked_[place(column, row)]) {
                result.inked_[result.place(column / 2, row / 2)] = true;
            }
        }
    }
    return result;
}

std::size_t Ink::place(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
}

}  // namespace dinal::plots
