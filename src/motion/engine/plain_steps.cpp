#include "motion/engine/plain_steps.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "motion/interpolation.hpp"

namespace dinal::motion::engine {

using model::Motion;

namespace {

/// Steps that are made again from their beginning when their motion is asked for.
class StepsAgain final : public Remade {
public:
    /// The steps first to last of a block that begins with step n of the run.
    StepsAgain(const AffineBlock& block, const StepTimes& steps, std::size_t n, std::size_t first, std::size_t last,
               double friction, const model::Excitation& M)
        : map_(block.map),
          inertia_(1 / block.inverse_inertia),
          steps_(steps),
          n_(n + first),
          count_(last - first),
          begin_(block.at(first)),
          friction_(friction),
          M_begin_(block.M[first]),
          M_(M) {
        if (!M.has_script()) return;  // a function may have changed since
        const auto* samples = block.samples.data();
        samples_.assign(samples + 2 * first, samples + 2 * last);
    }

    [[nodiscard]] std::vector<double> at(double since) const override {
        const double t = steps_.time(n_) + since;
        const std::size_t step = std::min(std::max(steps_.at(t), n_) - n_, count_ - 1);
        const AffineBlock block = made(step + 1);
        const model::State y = between(block, step)(t - steps_.time(n_ + step));
        return {y.theta, y.velocity};
    }
    [[nodiscard]] std::function<Work(double)> works() const override {
        const auto block = std::make_shared<const AffineBlock>(made(count_));
        std::vector<Work> sums(count_ + 1);  // up to each step
        for (std::size_t i = 0; i < count_; ++i) sums[i + 1] = sums[i], add(*block, i, map_.h, sums[i + 1]);
        return [this, block, sums](double since) {
            const double from = steps_.time(n_);
            const std::size_t step = std::min(std::max(steps_.at(from + since), n_) - n_, count_);
            Work sum = sums[step];
            const double more = since - (steps_.time(n_ + step) - from);
            if (step < count_ && more > 0) add(*block, step, std::min(more, map_.h), sum);
            return sum;
        };
    }
    [[nodiscard]] std::size_t bytes() const override { return sizeof(*this) + samples_.size() * sizeof(double); }

private:
    /// The first steps.
    [[nodiscard]] AffineBlock made(std::size_t count) const {
        AffineBlock block(map_, inertia_);
        if (samples_.empty()) {
            block.sample(M_, steps_, n_, count);
        } else {
            std::copy_n(samples_.begin(), 2 * count, block.samples.begin());
        }
        block.begin(0, count, begin_, M_begin_, friction_);
        for (std::size_t i = 0; i < count; ++i) {
            const model::State y = block.end_of(i);
            block.theta[i + 1] = y.theta, block.velocity[i + 1] = y.velocity;
        }
        return block;
    }
    static StepInterpolant between(const AffineBlock& block, std::size_t i) {
        const model::State y = block.at(i), y1 = block.at(i + 1);
        return {block.map.h, y, block.acceleration(i, y), y1, block.acceleration(i + 1, y1)};
    }
    /// M is the parabola through its samples.
    void add(const AffineBlock& block, std::size_t i, double length, Work& sum) const {
        constexpr std::array<std::pair<double, double>, 5> gauss{{{0.046910077030668004, 0.11846344252809454},
                                                                  {0.23076534494715845, 0.23931433524968324},
                                                                  {0.5, 0.28444444444444444},
                                                                  {0.76923465505284155, 0.23931433524968324},
                                                                  {0.953089922969332, 0.11846344252809454}}};
        const StepInterpolant motion = between(block, i);
        const double M0 = block.M[i], middle = block.samples[2 * i], M1 = block.M[i + 1];
        const double damping = map_.c * inertia_;
        for (const auto& [place, weight] : gauss) {
            const double x = place * length, s = x / map_.h;
            const double v = motion(x).velocity, dt = weight * length;
            const double M = M0 + s * ((4 * middle - 3 * M0 - M1) + s * 2 * (M0 - 2 * middle + M1));
            sum.input += M * v * dt, sum.viscous += damping * v * v * dt, sum.dry += friction_ * v * dt;
        }
    }

    AffineStep map_;
    double inertia_;
    StepTimes steps_;
    std::size_t n_, count_;
    model::State begin_;
    double friction_, M_begin_;
    model::Excitation M_;
    std::vector<double> samples_;
};

}  // namespace

PlainSteps::PlainSteps(const Request& problem, const Mechanics& mechanics, const Conditions& conditions)
    : problem_(problem),
      mechanics_(mechanics),
      joint_(problem.system.joints.front()),
      M_(problem.drive.loads.front()),
      possible_(problem.step > 0 && mechanics.joints() == 1 && mechanics.size() == 2),
      steps_(problem.window, possible_ ? problem.step : 1),
      block_({joint_.stiffness / problem.system.bodies.front().inertia,
              joint_.damping / problem.system.bodies.front().inertia, steps_.h},
             problem.system.bodies.front().inertia) {
    if (!possible_) return;
    const Signal& load = mechanics.loads().front();
    const bool by_time = !load.asks_the_motion() && load.relays() == 0 && load.delays().empty() && !load.has_sampled();
    possible_ = by_time && mechanics.all_linear() && mechanics.is_native(0) && !mechanics.may_open(0) &&
                !joint_.rigid && !mechanics.has_belts() && !mechanics.has_base() && !conditions.any() &&
                problem.drive.events.empty();
}

bool PlainSteps::may_begin(const Now& now) const {
    const Slipping& how = now.mode.friction[0];
    return possible_ && now.t.lo == 0 && now.mode.leans[0] == 0 && now.mode.presses[0] == 0 && !how.riding &&
           how.creeps == Motion::stuck && now.t.hi == steps_.time(steps_.at(now.t.hi));
}

bool PlainSteps::take(const Of& of, double until) {
    Now& now = of.now;
    if (!may_begin(now)) return false;
    const std::size_t n = steps_.at(now.t.hi);
    if (!(n >= sampled_.from && n < sampled_.to &&
          steps_.time(sampled_.to) < until)) {  // an event leaves samples that are still good
        std::size_t count = std::min(AffineBlock::most, steps_.count - n);
        if (n + count == steps_.count) --count;  // the last step may be shorter
        while (count > 0 && !(steps_.time(n + count) < until)) count /= 2;
        sampled_ = {n, n + block_.sample(M_, steps_, n, count)};
    }
    if (sampled_.to == n) return false;
    if (now.after_break || end_.t != now.t.hi) {
        end_ = {now.t.hi, now.after_break ? M_.value_after(now.t.hi) : M_.value(now.t.hi)};
    }
    if (!std::isfinite(end_.M)) return false;
    const Slipping& how = now.mode.friction[0];
    const bool stands = now.mode.holds(0);
    const Motion way = stands ? Motion::stuck : now.rubs(0) ? how.way : model::motion_of(now.y[1]);
    const std::size_t begin = n - sampled_.from, end = stands ? rest(of, begin) : move(of, begin, way);
    if (end == begin) return false;
    now.y = {block_.theta[end], block_.velocity[end]};
    now.low[0] = 0;
    now.t = {steps_.time(sampled_.from + end), 0};
    now.after_break = false;
    end_ = {now.t.hi, block_.M[end]};
    Slipping& left = now.mode.friction[0];
    left.leaving = false, left.blunt = 0;
    of.contacts.of[0].edge = 0, of.contacts.of[0].leaves_wall = false;
    return true;
}

/// The motion does not come nearer to a wall than it may go in a step.
bool PlainSteps::clear_of_walls(std::size_t i, double reach) const {
    const model::Walls* walls = joint_.any_walls();
    if (walls == nullptr) return true;
    const double far = steps_.h * reach;
    return block_.theta[i] + far < walls->upper && block_.theta[i] - far > walls->lower;
}

/// Moves in one direction from step `begin` of the block on; without dry friction it also turns. Returns the step at
/// which it stops.
std::size_t PlainSteps::move(const Of& of, std::size_t begin, Motion way) {
    const std::size_t n = sampled_.from, count = sampled_.to - n;
    const bool rubs = of.now.rubs(0);
    friction_ = rubs ? model::sign_of(way) * joint_.friction.law.sliding(way, 0) : 0;
    block_.begin(begin, count, {of.now.y[0], of.now.y[1]}, end_.M, friction_);
    if (!rubs && of.recorder.heading()[0] == Motion::stuck) of.recorder.head(0, of.now.y[1]);
    std::size_t first = begin, i = begin;  // rows are written up to step `first`
    for (;;) {
        const double direction = rubs ? model::sign_of(way) : model::sign_of(model::motion_of(block_.velocity[i]));
        i = block_.step(i, count, direction);
        const auto fastest = [&](std::size_t from) {
            double most = 0;
            for (std::size_t k = from; k <= i; ++k) most = std::max(most, std::fabs(block_.velocity[k]));
            return most;
        };
        const double reach = joint_.any_walls() != nullptr ? 2 * fastest(first) : 0;
        while (i > first && !(clear_of_walls(i, reach) && std::isfinite(block_.theta[i] + block_.velocity[i]))) --i;
        const std::size_t good = rows(of, n, first, i, false);
        if (std::exchange(i, good) != good || rubs || i == count || !clear_of_walls(i, reach) || !turn(of, n, i)) break;
        first = i++;
    }
    keep(of, begin, i, false);
    return i;
}

/// Without dry friction a step in which the velocity clearly changes its sign once is a step like any other, and a turn
/// is recorded.
bool PlainSteps::turn(const Of& of, std::size_t n, std::size_t i) {
    const model::State y = block_.at(i), y1 = block_.end_of(i);
    const double h = steps_.h, a = block_.acceleration(i, y), a1 = block_.acceleration(i + 1, y1);
    const double direction = model::sign_of(model::motion_of(y.velocity));
    constexpr double clearly = 1e-9;  // of what it is the sum of
    const double least = clearly * (block_.map.w * std::fabs(y.theta) + std::fabs(block_.forcing[i])) + 1e-280;
    const bool once = direction * a < -least && direction * a1 < -least && direction * y1.velocity < 0;
    if (!once || of.recorder.heading()[0] != model::motion_of(direction)) return false;
    const StepInterpolant motion(h, y, a, y1, a1);
    const auto zero = first_velocity_zero(direction, h, y.velocity, a, y1.velocity, a1);
    if (!zero) return false;
    // The interpolant is more accurate than the cubic: one secant step towards its zero.
    const double e = 1e-4 * h;
    const double slope =
        (motion(std::min(*zero + e, h)).velocity - motion(std::max(*zero - e, 0.0)).velocity) / (2 * e);
    const double better = *zero - motion(*zero).velocity / slope;
    const double x = better > 0 && better <= h ? better : *zero, t = steps_.time(n + i) + x;
    of.recorder.tell({.event = {.t = t, .kind = model::EventKind::turn, .theta = motion(x).theta, .M = M_.value(t)}});
    of.recorder.head(0, -direction);
    block_.theta[i + 1] = y1.theta, block_.velocity[i + 1] = y1.velocity;
    return true;
}

/// Stands while the pull is well within the limits, also between the samples: a parabola through three of them exceeds
/// the highest by at most an eighth of their second difference; a quarter is safe.
std::size_t PlainSteps::rest(const Of& of, std::size_t begin) {
    const std::size_t count = sampled_.to - sampled_.from;
    const Moment here = of.now.here();
    const double forward = mechanics_.holding(0, Motion::forward, here);
    const double backward = mechanics_.holding(0, Motion::backward, here);
    if (!std::isfinite(forward + backward)) return begin;
    const double limit = (forward + backward) / 2 * (1 - 1e-9);
    const double theta = of.now.y[0], middle_of_hold = joint_.stiffness * theta + (forward - backward) / 2;
    double e = std::fabs(end_.M - middle_of_hold);
    std::size_t i = begin;
    block_.theta[i] = theta, block_.velocity[i] = 0, block_.M[i] = end_.M;
    for (; i < count; ++i) {
        const double em = std::fabs(block_.samples[2 * i] - middle_of_hold),
                     e1 = std::fabs(block_.samples[2 * i + 1] - middle_of_hold);
        if (!(std::max({e, em, e1}) + std::fabs(e - 2 * em + e1) / 4 < limit)) break;
        block_.theta[i + 1] = theta, block_.velocity[i + 1] = 0, block_.M[i + 1] = block_.samples[2 * i + 1];
        e = e1;
    }
    i = rows(of, sampled_.from, begin, i, true);
    keep(of, begin, i, true);
    return i;
}

/// Writes the rows of these steps. Returns the step at one of whose rows M is not finite, or the last one.
std::size_t PlainSteps::rows(const Of& of, std::size_t n, std::size_t first, std::size_t last, bool stands) {
    for (std::size_t i = first; i < last;) {
        const double t = of.recorder.next_row_time(), end = steps_.time(n + i + 1);
        if (!(t < steps_.time(n + last))) return last;
        if (!(t < end)) {
            i = std::max(i + 1, std::min(steps_.at(t) - n, last));
            continue;
        }
        model::State y = block_.at(i);
        double M = block_.M[i];
        if (t > steps_.time(n + i)) {
            const model::State y1 = block_.at(i + 1);
            if (!stands) {
                y = StepInterpolant(steps_.h, y, block_.acceleration(i, y), y1,
                                    block_.acceleration(i + 1, y1))(t - steps_.time(n + i));
            }
            M = M_.value(t);
            if (!std::isfinite(M)) return i;
        }
        const double friction = stands ? joint_.stiffness * y.theta - M : 0.0 - friction_;
        of.recorder.put_row(t, y, M, friction);
    }
    return last;
}

/// Keeps these steps of the block.
void PlainSteps::keep(const Of& of, std::size_t first, std::size_t last, bool stands) const {
    if (first == last || !problem_.limits.dense) return;
    const std::size_t n = sampled_.from;
    const double from = steps_.time(n + first), length = steps_.time(n + last) - from;
    Kept kept{
        .start = {from, 0}, .h = length / 2, .length = length, .begin = {block_.theta[first], block_.velocity[first]}};
    if (stands) {
        kept.series.resize(2);
        kept.acting.resize(1);
        kept.acting[0].holds = true;
    } else {
        kept.remade = std::make_shared<StepsAgain>(block_, steps_, n, first, last, friction_, M_);
    }
    of.recorder.keep(std::move(kept));
}

}  // namespace dinal::motion::engine
