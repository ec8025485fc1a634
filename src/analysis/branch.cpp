#include "analysis/branch.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace dinal::analysis {
namespace {

// Lengths along the curve are measured in amplitudes of the motion and in ranges of the parameter.
constexpr double first_step = 0.01, longest_step = 0.08, shortest_step = 1e-6;
constexpr double closes = 1e-11;  // of the motion: what a point of the branch may miss
constexpr double nearly_closes = 1e-9;
constexpr double straight = 0.9;      // the cosine of how far the branch may turn in a step
constexpr double corner_step = 1e-3;  // so short a step has found a corner, as where the motion begins to stop
constexpr double creeping = 1e-4;     // with so short steps for so long it comes to an end
constexpr int most_creeps = 40;
constexpr double least_slope = 1e-7;  // of a fold: dp/ds

}  // namespace

FixedPointSearch::Try BranchWalk::look(const Place& x, double p, std::optional<SteadyQuestion>* asked) {
    FixedPointSearch::Try found;
    found.x = x;
    SteadyQuestion question = family_(p);
    const double length = half_ ? question.drive.period / 2 : periods_ * question.drive.period;
    const PeriodMap map(question.system, question.excitation, question.drive.start, length, monitor_);
    found.step = map(x);
    found.off = sign_ * found.step.to - x;
    found.size = std::max({length_of(x), length_of(found.step.to), found.step.high - found.step.low, 1e-300});
    if (map.contradiction()) contradiction_ = map.contradiction();
    const model::Outcome outcome = found.step.outcome;
    stopped_ = stopped_ || contradiction_ || outcome == model::Outcome::interrupted ||
               outcome == model::Outcome::excitation_not_finite;
    if (asked != nullptr) *asked = std::move(question);
    return found;
}

void BranchWalk::differentiate(Spot& spot) {
    MapStep& step = spot.found.step;
    if (!step.differentiable) {
        const double h = 1e-6 * spot.found.size;
        step.differentiable = true;
        for (int i = 0; i < 2; ++i) {
            const auto ahead = look(spot.x + h * Place::Unit(i), spot.p),
                       behind = look(spot.x - h * Place::Unit(i), spot.p);
            step.differentiable = step.differentiable && ahead.step.finished && behind.step.finished;
            step.derivative.col(i) = (ahead.step.to - behind.step.to) / (2 * h);
        }
    }
    const double up = std::min(spot.p + 1e-6 * range_, values_.back()),
                 down = std::max(spot.p - 1e-6 * range_, values_.front());
    const auto above = look(spot.x, up), below = look(spot.x, down);
    step.differentiable = step.differentiable && above.step.finished && below.step.finished;
    spot.slopes.leftCols<2>() = sign_ * step.derivative - Eigen::Matrix2d::Identity();
    spot.slopes.col(2) = (above.off - below.off) / (up - down);
}

BranchWalk::Vector3 BranchWalk::tangent(const Spot& spot, const Vector3& before) const {
    const Slopes slopes = scaled(spot.slopes);
    Vector3 t = Vector3(slopes.row(0)).cross(Vector3(slopes.row(1)));
    const double most = slopes.row(0).norm() * slopes.row(1).norm();
    // Where the mass may rest anywhere there is a surface of fixed points: stay where it is.
    if (!(t.norm() > 1e-12 * std::max(most, 1e-300))) t = Vector3::UnitZ();
    return t.normalized() * (t.dot(before) < 0 ? -1 : 1);
}

std::optional<BranchWalk::Spot> BranchWalk::correct(const Vector3& guess, const Vector3& normal, Slopes slopes) {
    constexpr int most_steps = 12;
    slopes = scaled(slopes);
    Vector3 y = guess;
    Spot spot;
    std::optional<SteadyQuestion> question;
    Vector3 last = Vector3::Zero();
    bool renewed = false;
    for (int i = 0; i <= most_steps; ++i) {
        const double p = y[2] * range_;
        if (!y.allFinite() || p < values_.front() - slack_ || p > values_.back() + slack_) return {};
        spot.x = size_ * y.head<2>();
        spot.p = value_near(p);
        spot.found = look(spot.x, spot.p, &question);
        if (!spot.found.step.finished || stopped_) return {};
        const Eigen::Vector2d off = spot.found.off / size_;
        // Broyden's update: the slopes that explain what the last step has left.
        if (i > 0 && !renewed) slopes += off * last.transpose() / std::max(last.squaredNorm(), 1e-300);
        renewed = false;
        if (off.norm() <= closes || (i > 3 && off.norm() <= nearly_closes)) {
            differentiate(spot);
            if (!spot.found.step.differentiable || stopped_) return {};
            const double length = half_ ? question->drive.period / 2 : periods_ * question->drive.period;
            const PeriodMap map(question->system, question->excitation, question->drive.start, length, monitor_);
            spot.motion = facts_of(*question, map, spot.found, periods_, half_);
            return spot;
        }
        if (i == 4) {
            differentiate(spot);
            slopes = scaled(spot.slopes);
            renewed = true;
        }
        Eigen::Matrix3d all;
        all << slopes, normal.transpose();
        Vector3 rest;
        rest << -off, normal.dot(guess - y);
        Eigen::JacobiSVD<Eigen::Matrix3d> parts(all, Eigen::ComputeFullU | Eigen::ComputeFullV);
        parts.setThreshold(1e-10);
        last = parts.solve(rest);
        y += last;
        if ((y - guess).norm() > 0.5) return {};
    }
    return {};
}

std::optional<BranchWalk::Spot> BranchWalk::at_value(const Spot& a, const Spot& b, double p) {
    const double part = (p - a.p) / (b.p - a.p);
    Vector3 guess = (1 - part) * scaled(a) + part * scaled(b);
    guess[2] = p / range_;
    return correct(guess, Vector3::UnitZ(), part < 0.5 ? a.slopes : b.slopes);
}

std::optional<BranchWalk::Spot> BranchWalk::fold_between(const Spot& a, const Spot& b, const Vector3& from) {
    const Vector3 begin = scaled(a), way = scaled(b) - begin;
    double low = 0, high = 1, f_low = tangent(a, from)[2], f_high = tangent(b, way)[2];
    std::optional<Spot> best;
    int side = 0;
    for (int i = 0; i < 30 && high - low > 1e-9; ++i) {
        const double at = (low * f_high - high * f_low) / (f_high - f_low);
        const auto spot = correct(begin + at * way, way.normalized(), at < 0.5 ? a.slopes : b.slopes);
        if (!spot) return best;
        best = spot;
        const double f = tangent(*spot, way)[2];
        if (std::fabs(f) < least_slope) return best;
        // Illinois: an end that stays counts half.
        if (f * f_high > 0) {
            high = at, f_high = f;
            if (side == 1) f_low /= 2;
            side = 1;
        } else {
            low = at, f_low = f;
            if (side == -1) f_high /= 2;
            side = -1;
        }
    }
    return best;
}

double BranchWalk::next_value(double p, double way) const {
    if (way > 0) {
        const auto next = std::upper_bound(values_.begin(), values_.end(), p + slack_);
        return next == values_.end() ? values_.back() : *next;
    }
    const auto next = std::lower_bound(values_.begin(), values_.end(), p - slack_);
    return next == values_.begin() ? values_.front() : *(next - 1);
}

double BranchWalk::value_near(double p) const {
    const auto near = std::lower_bound(values_.begin(), values_.end(), p - slack_);
    return near != values_.end() && *near <= p + slack_ ? *near : p;
}

void BranchWalk::add(const Spot& spot, bool fold) {
    const bool asked = std::binary_search(values_.begin(), values_.end(), spot.p);
    // The points between are for the eye: few do.
    std::vector<BranchPoint>& points = path_.points;
    const auto is_between = [](const BranchPoint& point) { return !point.asked && !point.fold; };
    if (points.size() > 1 && is_between(points.back())) {
        const BranchPoint& before = points[points.size() - 2];
        const double way =
            std::hypot((spot.p - before.parameter) / range_, (spot.motion.amplitude - before.motion.amplitude) / size_);
        if (way < first_step && spot.motion.stable == before.motion.stable) points.pop_back();
    }
    points.push_back({spot.p, spot.motion, asked, fold});
}

bool BranchWalk::add_way(const Spot& a, const Spot& b, bool fold) {
    const double way = b.p - a.p;
    double p = next_value(a.p, way);
    while ((b.p - p) * way > slack_ * std::fabs(way)) {
        if (std::fabs(p - a.p) <= slack_) break;  // the end of the range
        if (const auto between = at_value(a, b, p)) add(*between, false);
        if (p == values_.front() || p == values_.back()) break;
        p = next_value(p, way);
    }
    add(b, fold);
    return (way > 0 ? values_.back() - b.p : b.p - values_.front()) > slack_;
}

BranchPath BranchWalk::walk(double parameter, const SteadyMotion& from, double way) {
    path_ = {};
    half_ = from.symmetric && from.periods == 1;
    sign_ = half_ ? -1 : 1;
    periods_ = from.periods;
    Spot now;
    {
        const SteadyQuestion question = family_(parameter);
        const double length = half_ ? question.drive.period / 2 : periods_ * question.drive.period;
        const PeriodMap map(question.system, question.excitation, question.drive.start, length, monitor_);
        now.x = place_of(from.start, map.omega());
    }
    now.p = parameter;
    now.found = look(now.x, now.p);
    size_ = now.found.size;
    if (now.found.step.finished && !stopped_) differentiate(now);
    if (!now.found.step.differentiable || stopped_) {
        path_.end = stopped_ ? WalkEnd::stopped : WalkEnd::lost;
        return path_;
    }
    const Spot first = now;
    Vector3 ahead = way * Vector3::UnitZ();
    ahead = tangent(now, ahead);
    const Vector3 first_ahead = ahead;
    double longest = first_step, greatest = size_;
    int creeps = 0;
    const std::size_t most_points = 2000 + 20 * values_.size();
    path_.end = WalkEnd::lost;
    while (path_.points.size() < most_points) {
        // A motion that dies is not looked at more and more closely.
        const double size = std::max(now.found.size, 1e-2 * greatest);
        greatest = std::max(greatest, size);
        if (size > 1.2 * size_ || size < size_ / 1.2) {
            const Vector3 unscaled(ahead[0] * size_, ahead[1] * size_, ahead[2]);
            size_ = size;
            ahead = tangent(now, Vector3(unscaled[0] / size_, unscaled[1] / size_, unscaled[2]));
        }
        const double target = next_value(now.p, ahead[2]);
        const double left = std::fabs(target - now.p) / range_;
        if (left * range_ <= slack_) {
            path_.end = WalkEnd::range;
            return path_;
        }
        const bool reaches = left <= longest * std::fabs(ahead[2]);
        const double step = reaches ? left / std::fabs(ahead[2]) : longest;
        Vector3 guess = scaled(now) + step * ahead;
        if (reaches) guess[2] = target / range_;
        const auto spot = correct(guess, reaches ? Vector3::UnitZ() : ahead, now.slopes);
        if (stopped_) {
            path_.end = WalkEnd::stopped;
            return path_;
        }
        const Vector3 moved = spot ? Vector3(scaled(*spot) - scaled(now)) : Vector3::Zero();
        const Vector3 on = spot ? tangent(*spot, moved) : ahead;
        const bool good = spot && moved.norm() <= 2 * step && moved.dot(ahead) > straight / 2 * moved.norm() &&
                          (on.dot(ahead) > straight || step < corner_step);
        if (!good) {
            longest = step / 2;
            if (longest < shortest_step || creeps > most_creeps) return path_;
            continue;
        }
        creeps = step < creeping ? creeps + 1 : 0;
        longest = std::min(longest_step, 1.5 * longest);
        bool inside = true;
        if (on[2] * ahead[2] < 0) {
            if (const auto fold = fold_between(now, *spot, ahead)) {
                inside = add_way(now, *fold, true) && add_way(*fold, *spot, false);
            } else {
                inside = add_way(now, *spot, false);
            }
        } else {
            inside = add_way(now, *spot, false);
        }
        if (!inside) {
            path_.end = WalkEnd::range;
            return path_;
        }
        if (path_.points.size() > 10 && (scaled(*spot) - scaled(first)).norm() < step &&
            on.dot(first_ahead) > straight) {
            path_.end = WalkEnd::closed;
            return path_;
        }
        now = *spot;
        ahead = on;
    }
    return path_;
}

}  // namespace dinal::analysis
