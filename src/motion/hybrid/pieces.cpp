#include "motion/hybrid/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dinal::motion::hybrid {

namespace {

/// Integrals of products of series are exact.
class PieceLeg final : public Leg {
public:
    PieceLeg(const model::Lowered& system, const Piece& piece) : piece_(piece), around_(piece.surroundings()) {
        Series theta = piece.series[0], v = piece.series[1];
        theta[0] += piece.begin[0], v[0] += piece.begin[1];
        const auto work = [&](const Series& torque) {
            Integral sum = cheb::integral(cheb::product(torque, v), 0);
            for (double& c : sum) c *= piece.h;
            return sum;
        };
        input_ = work(piece.M), base_ = work(around_.push);
        Series damping = v;
        for (double& c : damping) c *= system.damping();
        viscous_ = work(damping);
        const Series friction = friction_on(system, theta, v);
        belt_ = cheb::integral(cheb::product(friction, around_.belt), 0);
        Series against = v;
        for (std::size_t k = 0; k < against.size(); ++k) against[k] = around_.belt[k] - v[k];
        dry_ = cheb::integral(cheb::product(friction, against), 0);
        for (double& c : belt_) c *= piece.h;
        for (double& c : dry_) c *= piece.h;
        if (piece.way == model::Motion::stuck && !piece.leans) dry_ = {};
    }
    [[nodiscard]] double length() const override { return piece_.length; }
    [[nodiscard]] double since_start(double t) const override { return piece_.start.until(t); }
    [[nodiscard]] Work work(double since_start) const override {
        if (!(since_start > 0)) return {};
        const double x = std::min(std::min(since_start, piece_.length) / piece_.h - 1, 1.0);
        return {cheb::value(input_, x), cheb::value(viscous_, x), cheb::value(dry_, x), cheb::value(belt_, x),
                cheb::value(base_, x)};
    }

private:
    using Integral = cheb::Series<2 * node_count>;

    /// The torque of dry friction on the mass.
    [[nodiscard]] Series friction_on(const model::Lowered& system, const Series& theta, const Series& v) const {
        Series friction{};
        if (piece_.leans) return friction_at_wall(system, theta);
        if (piece_.way == model::Motion::stuck) {
            Nodes own = cheb::at_nodes(theta);
            for (double& torque : own) torque = system.spring(torque);
            const Series spring = cheb::fit(own);
            for (std::size_t k = 0; k < friction.size(); ++k) {
                friction[k] = system.inertia() * around_.belt_rate[k] + system.damping() * v[k] +
                              (system.stiffness() * theta[k] + spring[k]) - around_.push[k] - piece_.M[k];
            }
            return friction;
        }
        const Nodes theta_at = cheb::at_nodes(theta), v_at = cheb::at_nodes(v), belt_at = cheb::at_nodes(around_.belt);
        const double sign = model::sign_of(piece_.way);
        const model::SpeedRange& line = piece_.friction;
        Nodes values{};
        for (std::size_t j = 0; j < node_count; ++j) {
            const double slip = v_at[j] - belt_at[j];
            values[j] = line.straight
                            ? -sign * line.at(sign * slip)
                            : -system.braking(piece_.way) - system.friction_remainder(piece_.way, {theta_at[j], slip});
        }
        return cheb::fit(values);
    }

    /// At a wall the belt slides along the mass.
    [[nodiscard]] Series friction_at_wall(const model::Lowered& system, const Series& theta) const {
        const Nodes theta_at = cheb::at_nodes(theta), belt_at = cheb::at_nodes(around_.belt);
        Nodes values{};
        for (std::size_t j = 0; j < node_count; ++j) {
            const model::Motion slides = model::motion_of(-belt_at[j]);
            values[j] = -system.braking(slides) - system.friction_remainder(slides, {theta_at[j], -belt_at[j]});
        }
        return cheb::fit(values);
    }

    const Piece& piece_;
    const Piece::Surroundings& around_;
    Integral input_{}, viscous_{}, dry_{}, belt_{}, base_{};
};

/// No time, but energy.
class JumpLeg final : public Leg {
public:
    JumpLeg(double t, const Work& done) : t_(t), work_(done) {}
    [[nodiscard]] double length() const override { return 0; }
    [[nodiscard]] double since_start(double t) const override { return t - t_; }
    [[nodiscard]] Work work(double since_start) const override { return since_start < 0 ? Work{} : work_; }

private:
    double t_;
    Work work_;
};

}  // namespace

Pieces::Pieces(const model::Oscillator& system, const model::State& initial, double t_start,
               std::shared_ptr<const Pieces> before, std::size_t most_bytes, bool whole)
    : Course(system),
      initial_(initial),
      t_start_(t_start),
      before_(std::move(before)),
      most_(most_bytes),
      whole_(whole) {}

void Pieces::add(Piece piece) {
    const std::size_t bytes = sizeof(Piece) + piece.begin.size() * (sizeof(Series) + sizeof(double));
    if (bytes_ + bytes > most_) complete_ = false;
    if (!complete_) return;
    bytes_ += bytes;
    list_.push_back(std::move(piece));
}

void Pieces::close(const Clock& end, Values state) {
    if (list_.empty()) return;
    std::vector<Series> still(state.size());
    add({.start = end, .h = 1, .begin = std::move(state), .series = std::move(still)});
}

void Pieces::forget(double t) {
    const auto old = std::partition_point(list_.begin(), list_.end(),
                                          [t](const Piece& piece) { return piece.start.after(piece.length) < t; });
    constexpr std::ptrdiff_t worth_it = 256;
    if (old - list_.begin() < worth_it) return;
    list_.erase(list_.begin(), old);
    bytes_ = 0;
}

const Piece* Pieces::piece_at(double t, Side side) const {
    // The last piece that begins at or before t, as far as a double can say it; before it, for a limit from the left.
    const auto after = std::partition_point(list_.begin(), list_.end(), [t, side](const Piece& piece) {
        return side == Side::before ? piece.start.hi < t : piece.start.hi <= t;
    });
    return after == list_.begin() ? nullptr : &*(after - 1);
}

model::State Pieces::at(double t, Side side) const {
    const Piece* piece = t < t_start_ || (t == t_start_ && side == Side::before) ? nullptr : piece_at(t, side);
    if (piece == nullptr) return before_ != nullptr ? before_->at(t, side) : initial_;
    const double x = piece->x(t);
    return {piece->value(0, x), piece->value(1, x)};
}

text::Expected<model::State> Pieces::at(double t) const {
    if (list_.empty()) return text::Error{"the run has no motion to evaluate: it ended where it started"};
    const Piece& last = list_.back();
    if (!complete_ && t > last.start.after(last.length)) {
        return text::Error{"only part of the motion was kept, for lack of memory: ask for rows, or start a run there"};
    }
    return at(t, Side::at);
}

std::vector<double> Pieces::states_at(double t) const {
    const Piece* piece = piece_at(t, Side::at);
    std::vector<double> states;
    if (piece == nullptr) return states;
    for (std::size_t k = 2; k < piece->begin.size(); ++k) states.push_back(piece->value(k, piece->x(t)));
    return states;
}

void Pieces::legs(const std::function<void(const Leg&)>& told) const {
    const model::Lowered lowered(system());
    auto jump = jumps_.begin();
    for (std::size_t i = 0; i <= list_.size(); ++i) {
        for (; jump != jumps_.end() && jump->piece == i; ++jump) told(JumpLeg(jump->t, jump->work));
        if (i < list_.size() && list_[i].length > 0) told(PieceLeg(lowered, list_[i]));
    }
}

}  // namespace dinal::motion::hybrid
