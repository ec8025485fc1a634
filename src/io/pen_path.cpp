#include "io/pen_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dinal {

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

Painted::Painted(Box pixels, double coarseness)
    : brush_(static_cast<int>(coarseness)),
      width_(static_cast<int>(pixels.width) + 1),
      height_(static_cast<int>(pixels.height) + 1),
      done_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), false) {}

bool Painted::line(Point from, Point to) {
    const double length = std::max(std::fabs(to.x - from.x), std::fabs(to.y - from.y));
    const int steps = std::max(1, static_cast<int>(std::ceil(length)));
    const auto point = [&](int i) {
        const double part = static_cast<double>(i) / steps;
        return Point{from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
    };
    bool fresh = false;
    for (int i = 0; i <= steps && !fresh; ++i) {
        fresh = is_blank(point(i));
    }
    for (int i = 0; i <= steps && fresh; ++i) {
        paint(point(i));
    }
    return fresh;
}

bool Painted::is_blank(Point point) const {
    return point.x >= 0 && point.y >= 0 && point.x < width_ && point.y < height_ &&
           !done_[place(static_cast<int>(point.x), static_cast<int>(point.y))];
}

void Painted::paint(Point point) {
    const int left = std::max(0, static_cast<int>(std::floor(point.x)) - brush_);
    const int right = std::min(width_ - 1, static_cast<int>(std::floor(point.x)) + brush_);
    const int low = std::max(0, static_cast<int>(std::floor(point.y)) - brush_);
    const int high = std::min(height_ - 1, static_cast<int>(std::floor(point.y)) + brush_);
    for (int y = low; y <= high; ++y) {
        for (int x = left; x <= right; ++x) {
            done_[place(x, y)] = true;
        }
    }
}

std::size_t Painted::place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
}

}  // namespace dinal
