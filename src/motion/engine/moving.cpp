#include "motion/engine/moving.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "motion/belt_slope.hpp"
#include "motion/engine/nodes.hpp"

namespace dinal::motion::engine {

namespace {

/// The derivative of a prescribed angle, by series on pieces short enough for a polynomial to reach rounding. The
/// pieces are halvings of equal parts between breaks, so they depend on the angle only and not on the order of
/// evaluation: leftover tiny pieces would differentiate rounding errors.
class VelocityOfAngle final : public model::UserFunction {
public:
    VelocityOfAngle(model::Excitation angle, double start, double pace)
        : angle_(std::move(angle)), longest_(2 * pace), breaks_{start} {}

    double value(double t, const model::State& /*state*/) override {
        auto piece = pieces_.upper_bound(t);
        if (piece == pieces_.begin() || !(t < std::prev(piece)->second.to)) {
            const auto [from, made] = make(t);
            piece = std::next(pieces_.insert_or_assign(from, made).first);
        }
        const auto& [from, own] = *std::prev(piece);
        return cheb::value(own.slope, (t - from) / own.h - 1);
    }
    double next_break(double t) override { return angle_.next_break(t); }

private:
    struct Piece {
        double to = 0, h = 0;
        cheb::Series<node_count - 1> slope{};
    };

    /// The part around t without breaks, no longer than the longest piece, and the next break.
    std::array<double, 3> part_around(double t) {
        while (breaks_.back() <= t) breaks_.push_back(angle_.next_break(breaks_.back()));
        const auto next = std::upper_bound(breaks_.begin(), breaks_.end(), t);
        const double begin = next == breaks_.begin() ? *next : *std::prev(next);
        const bool ends = next != breaks_.begin() && *next < model::never;
        const double length = ends ? (*next - begin) / std::ceil((*next - begin) / longest_) : longest_;
        const double from = begin + std::floor((t - begin) / length) * length, to = from + length;
        return {from, ends && !(to < *next) ? *next : to, *next};
    }

    std::pair<double, Piece> make(double t) {
        constexpr double enough = 8 * rounding;
        constexpr int most_looks = 40;
        auto [from, to, next] = part_around(t);
        std::pair<double, Piece> best;
        double least = model::never;
        for (int look = 0; look < most_looks; ++look) {
            const double h = (to - from) / 2;
            if (look > 0 && (!(from + h > from) || !(from + h < to))) break;
            Nodes angles{};
            for (std::size_t j = 0; j < node_count; ++j) {
                const double at = from + h * (1 + cheb::nodes[j]);
                angles[j] = j == 0       ? belt_from(angle_, from)
                            : at >= next ? angle_.value_before(next)
                                         : angle_.value(at);
            }
            const Series series = cheb::fit(angles);
            const double tail = cheb::tail(series), size = cheb::size(series);
            if (!std::isfinite(size) || tail < least / 2) {
                least = tail;
                cheb::Series<node_count - 1> slope = cheb::derivative(series);
                for (double& c : slope) c /= h;
                best = {from, {to, h, slope}};
            }
            if (!std::isfinite(size) || tail <= enough * size || (look > 3 && !(tail < 2 * least))) break;
            (t < from + h ? to : from) = from + h;
        }
        return best;
    }

    model::Excitation angle_;
    double longest_;
    std::vector<double> breaks_;      // known breaks; the first is the start
    std::map<double, Piece> pieces_;  // by the time at which they begin
};

model::Excitation velocity_of(const model::Moved& moved, double start, double pace) {
    if (!moved.by_angle) return moved.motion;
    if (moved.motion.constant_from() == -model::never) return {};
    model::Scripted script;
    script.function = std::make_shared<VelocityOfAngle>(moved.motion, start, pace);
    return model::Excitation::make(script).value();
}

}  // namespace

Moving::Moving(const model::System& given, const model::Drive& asked, double start, double pace)
    : system(given), drive(asked) {
    drive.loads.resize(system.joints.size());
    for (std::size_t i = 0; i < given.bodies.size(); ++i) {
        const auto& moved = given.bodies[i].moved;
        if (!moved) continue;
        model::Joint joint;
        joint.name = given.bodies[i].name, joint.of = {{i, 1}}, joint.rigid = true;
        system.joints.push_back(std::move(joint));
        drive.loads.emplace_back();
        drive.belts.push_back(velocity_of(*moved, start, pace));
        if (moved->by_angle) drive.theta0[i] = belt_from(moved->motion, start);
        drive.velocity0[i] = belt_from(drive.belts.back(), start);
        if (system.bodies[i].inertia == 0) system.bodies[i].inertia = 1;  // it is held, so any inertia will do
    }
}

}  // namespace dinal::motion::engine
