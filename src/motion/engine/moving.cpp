#include "motion/engine/moving.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "motion/belt_slope.hpp"
#include "motion/engine/nodes.hpp"

namespace dinal::motion::engine {

namespace {

/// The derivative of given angles by series on pieces, each as long as a polynomial follows them to rounding.
class VelocityOfAngle final : public model::UserFunction {
public:
    VelocityOfAngle(model::Excitation angle, double pace) : angle_(std::move(angle)), h_(pace), longest_(pace) {}

    double value(double t, const model::State& /*state*/) override {
        auto piece = pieces_.upper_bound(t);
        if (piece == pieces_.begin() || !(t < std::prev(piece)->second.to)) {
            const double before = piece == pieces_.begin() ? -model::never : std::prev(piece)->second.to;
            const double after = piece == pieces_.end() ? +model::never : piece->first;
            const auto [from, made] = make(t, before, after);
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

    /// Around t, between those that are there and where the angle breaks.
    std::pair<double, Piece> make(double t, double before, double after) {
        constexpr double enough = 8 * rounding;
        constexpr int most_looks = 40;
        const double next = std::min(angle_.next_break(t), after);
        std::pair<double, Piece> best;
        double least = model::never;
        for (int look = 0; look < most_looks; ++look) {
            double from = std::max(before, t - h_), broken = angle_.next_break(from);
            while (broken <= t) from = broken, broken = angle_.next_break(from);
            const double to = std::min(from + 2 * h_, next), h = (to - from) / 2;
            if (!(from + h > from) || !(from + h < to)) break;
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
            h_ /= 2;
        }
        h_ = std::min(2 * h_, longest_);
        return best;
    }

    model::Excitation angle_;
    double h_, longest_;
    std::map<double, Piece> pieces_;  // by where they begin
};

model::Excitation velocity_of(const model::Moved& moved, double pace) {
    if (!moved.by_angle) return moved.motion;
    if (moved.motion.constant_from() == -model::never) return {};
    model::Scripted script;
    script.function = std::make_shared<VelocityOfAngle>(moved.motion, pace);
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
        drive.belts.push_back(velocity_of(*moved, pace));
        if (moved->by_angle) drive.theta0[i] = belt_from(moved->motion, start);
        drive.velocity0[i] = belt_from(drive.belts.back(), start);
        if (system.bodies[i].inertia == 0) system.bodies[i].inertia = 1;  // it is held, so any will do
    }
}

}  // namespace dinal::motion::engine
