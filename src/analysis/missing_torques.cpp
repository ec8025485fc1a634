#include "analysis/missing_torques.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "model/terms/polyline.hpp"

namespace dinal::analysis {
namespace {

double greatest(std::span<const double> values) {
    double most = std::numeric_limits<double>::min();
    for (const double x : values) most = std::max(most, std::fabs(x));
    return most;
}

double sign_of(double x) {
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

/// The changes of angle and velocity caused by each of the torques, advanced from one time to the next.
class Response {
public:
    using Row = MissingTorques::Row;

    Response(const model::Oscillator& system, const model::Excitation& M)
        : I_(system.inertia()),
          k_(system.stiffness()),
          C_(system.damping()),
          Rd_(system.kinetic_friction()),
          M_(M),
          omega0_(system.natural_frequency()) {}

    const Row& angle() const { return angle_; }

    /// Advances by h, while the torques change linearly.
    void move(double h, const Row& from, const Row& to) {
        if (!(h > 0)) return;
        set_step(h);
        const Row slope = (to - from) / (h * k_), start = (from - C_ * slope) / k_;
        const Row y = angle_ - start, u = velocity_ - slope;
        angle_ = start + h * slope + kept_ * y + passed_ * u;
        velocity_ = slope + back_ * y + left_ * u;
    }
    void stop() { velocity_.setZero(); }
    /// A turn: `way` is the direction before it, after which friction reverses.
    void turn(double pull, double way) {
        const double before = pull - Rd_ * way, after = pull + Rd_ * way;
        if (before != 0) velocity_ *= after / before;
    }
    /// A start in direction `way` when the pull reaches Re: a helping torque makes it start earlier.
    void start(double t, double pull, double way, const Row& torques) {
        const double h = 1e-5 / omega0_, rise = (M_.value(t + h) - M_.value(t - h)) / (2 * h);
        if (rise * way > 0) velocity_ = (pull - Rd_ * way) / (I_ * rise) * (torques - k_ * angle_);
    }

private:
    /// Computes the free motion over h.
    void set_step(double h) {
        constexpr double same = 1e-12;
        if (std::fabs(h - step_) <= same * h) return;
        step_ = h;
        const double decay = C_ / (2 * I_), q = omega0_ * omega0_ - decay * decay, rate = std::sqrt(std::fabs(q));
        double c = 0, s = 0;
        constexpr double least_decay = 1e-6;
        if (rate * h < least_decay) {
            c = std::exp(-decay * h), s = h * c;
        } else if (q > 0) {
            const double kept = std::exp(-decay * h);
            c = kept * std::cos(rate * h), s = kept * std::sin(rate * h) / rate;
        } else {
            const double slow = std::exp((rate - decay) * h), fast = std::exp(-(rate + decay) * h);
            c = (slow + fast) / 2, s = (slow - fast) / (2 * rate);
        }
        kept_ = c + decay * s, passed_ = s, back_ = -omega0_ * omega0_ * s, left_ = c - decay * s;
    }

    double I_, k_, C_, Rd_;
    const model::Excitation& M_;
    double omega0_;
    Row angle_ = Row::Zero(), velocity_ = Row::Zero();
    double step_ = 0, kept_ = 1, passed_ = 0, back_ = 0, left_ = 1;
};

}  // namespace

MissingTorques::MissingTorques(std::span<const double> theta, std::span<const double> velocity)
    : far_(greatest(theta)), fast_(greatest(velocity)) {}

MissingTorques::Row MissingTorques::at(double theta, double velocity, double way) const {
    const double x = theta / far_, v = velocity / fast_;
    const auto slow = [&](double speed) { return way * std::exp(-(v * v) / (speed * speed)); };
    // fractions of the greatest speed below which friction may fall
    constexpr double slowest = 0.1, slower = 0.25, half = 0.6;
    Row row;
    row << v, way, slow(slowest), slow(slower), slow(half), x, x * x, x * x * x;
    return row;
}

Eigen::MatrixXd MissingTorques::along(std::span<const double> theta, std::span<const double> velocity) const {
    Eigen::MatrixXd torques(static_cast<Eigen::Index>(theta.size()), velocity_torques + theta_torques);
    for (std::size_t i = 0; i < theta.size(); ++i) {
        torques.row(static_cast<Eigen::Index>(i)) = at(theta[i], velocity[i], sign_of(velocity[i]));
    }
    return torques;
}

Eigen::MatrixXd responses(const model::Oscillator& system, const model::Excitation& M, const motion::Run& run,
                          std::span<const double> times) {
    using model::EventKind;
    const Eigen::VectorXd theta = run.column(motion::Column::theta), velocity = run.column(motion::Column::velocity);
    const Eigen::Index n = theta.size();
    const MissingTorques torques({theta.data(), times.size()}, {velocity.data(), times.size()});
    const double k = system.stiffness();
    double way = run.began_stuck ? 0 : sign_of(velocity[0] != 0 ? velocity[0] : M.value(times[0]) - k * theta[0]);
    double t = times[0];
    MissingTorques::Row now = torques.at(theta[0], velocity[0], way);
    Response response(system, M);
    Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(n, velocity_torques + theta_torques);
    auto event = run.events.begin();
    for (Eigen::Index i = 1; i < n; ++i) {
        const double until = times[static_cast<std::size_t>(i)];
        for (; event != run.events.end() && event->t <= until; ++event) {
            const double pull = event->M - k * event->theta;
            if (way != 0) response.move(event->t - t, now, torques.at(event->theta, 0, way));
            t = event->t;
            if (event->kind == EventKind::turn) {
                response.turn(pull, way);
                way = -way;
            } else if (event->kind == EventKind::slip) {
                way = sign_of(pull);
                response.start(t, pull, way, torques.at(event->theta, 0, 0));
            } else if (event->kind == EventKind::stick || event->kind == EventKind::rest) {
                response.stop();
                way = 0;
            }
            now = torques.at(event->theta, 0, way);
        }
        const MissingTorques::Row next = torques.at(theta[i], velocity[i], way);
        if (way != 0) response.move(until - t, now, next);
        t = until;
        now = next;
        changes.row(i) = response.angle();
    }
    return changes;
}

std::optional<Eigen::MatrixXd> responses(const Pushed& pushed, std::span<const double> times,
                                         const Eigen::MatrixXd& torques, double whole, double noise) {
    const auto here = pushed(model::Excitation());
    if (!here) return {};
    Eigen::MatrixXd columns(here->size(), torques.cols());
    double step = 1e-3 * whole;
    for (Eigen::Index i = 0; i < torques.cols(); ++i) {
        auto samples = std::make_shared<model::terms::Samples>();
        samples->t.assign(times.begin(), times.end());
        samples->M.assign(torques.col(i).begin(), torques.col(i).end());
        const auto torque = model::Excitation::make(model::terms::Polyline(std::move(samples))).value();
        constexpr int most_tries = 6;
        for (int tries = 0; tries < most_tries; ++tries) {
            const auto there = pushed(torque.scaled(step));
            if (!there) return {};
            columns.col(i) = (*there - *here) / step;
            const double change = (*there - *here).norm();
            // change of the prediction relative to the noise, over all samples
            constexpr double least = 0.05, most = 20, widest = 1e3;
            if (change > least * noise && change < most * noise) break;
            step *= std::clamp(noise / std::max(change, 1e-300), 1 / widest, widest);
        }
        step = std::clamp(step, 1e-9 * whole, whole);
    }
    return columns;
}

}  // namespace dinal::analysis
