#include "motion/engine/plain_steps.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "motion/interpolation.hpp"

namespace dinal::motion::engine {

using model::Motion;

/// The motion and torques at the start of some successive steps and at the end of the last.
struct Made {
    std::vector<model::State> y{};
    std::vector<double> accelerations{}, M{}, friction{};  ///< friction as a torque against the motion
    std::vector<double> middle_M{}, middle_friction{};     ///< at the middle of each step
    std::size_t m = 0;                                     ///< number of states
    std::vector<double> states{}, rates{};

    StepInterpolant between(std::size_t i, double h) const {
        return {h, y[i], accelerations[i], y[i + 1], accelerations[i + 1]};
    }
    /// Adds the work of part of a step, with M and friction as parabolas through their samples.
    void add_work(std::size_t i, double h, double length, double damping, Work& sum) const {
        constexpr std::array<std::pair<double, double>, 5> gauss{{{0.046910077030668004, 0.11846344252809454},
                                                                  {0.23076534494715845, 0.23931433524968324},
                                                                  {0.5, 0.28444444444444444},
                                                                  {0.76923465505284155, 0.23931433524968324},
                                                                  {0.953089922969332, 0.11846344252809454}}};
        const StepInterpolant motion = between(i, h);
        const auto parabola = [](double first, double middle, double last, double s) {
            return first + s * ((4 * middle - 3 * first - last) + s * 2 * (first - 2 * middle + last));
        };
        for (const auto& [place, weight] : gauss) {
            const double x = place * length, s = x / h;
            const double v = motion(x).velocity, dt = weight * length;
            sum.input += parabola(M[i], middle_M[i], M[i + 1], s) * v * dt, sum.viscous += damping * v * v * dt;
            sum.dry += parabola(friction[i], middle_friction[i], friction[i + 1], s) * v * dt;
        }
    }
};

namespace {

/// The Hermite cubic at the fraction s of a step of length h, from values z and rates r at both ends.
double cubic(double s, double h, double z0, double r0, double z1, double r1) {
    const double d = z1 - z0, v0 = h * r0, v1 = h * r1;
    return z0 + s * (v0 + s * ((3 * d - 2 * v0 - v1) + s * (v0 + v1 - 2 * d)));
}

/// The `count` steps of a run from step n on.
class StepsOfRun : public Remade {
public:
    StepsOfRun(const StepTimes& steps, std::size_t n, std::size_t count, double damping)
        : steps_(steps), n_(n), count_(count), damping_(damping) {}

    std::vector<double> at(double since) const override {
        const double t = steps_.time(n_) + since, h = steps_.h;
        const std::size_t i = std::min(std::max(steps_.at(t), n_) - n_, count_ - 1);
        const auto made = first_steps(i + 1);
        const double x = t - steps_.time(n_ + i);
        const model::State y = made->between(i, h)(x);
        std::vector<double> all{y.theta, y.velocity};
        for (std::size_t k = i * made->m; k < (i + 1) * made->m; ++k) {
            all.push_back(
                cubic(x / h, h, made->states[k], made->rates[k], made->states[k + made->m], made->rates[k + made->m]));
        }
        return all;
    }
    [[nodiscard]] std::function<Work(double)> works() const override {
        const auto made = first_steps(count_);
        std::vector<Work> sums(count_ + 1);  // work up to each step
        for (std::size_t i = 0; i < count_; ++i) {
            sums[i + 1] = sums[i];
            made->add_work(i, steps_.h, steps_.h, damping_, sums[i + 1]);
        }
        return [this, made, sums](double since) {
            const double from = steps_.time(n_);
            const std::size_t step = std::min(std::max(steps_.at(from + since), n_) - n_, count_);
            Work sum = sums[step];
            const double more = since - (steps_.time(n_ + step) - from);
            if (step < count_ && more > 0) made->add_work(step, steps_.h, std::min(more, steps_.h), damping_, sum);
            return sum;
        };
    }

protected:
    virtual std::shared_ptr<const Made> first_steps(std::size_t count) const = 0;

    StepTimes steps_;
    std::size_t n_, count_;
    double damping_;
};

/// Stores the steps, because user functions may have changed when they are evaluated again.
class StepsKept final : public StepsOfRun {
public:
    StepsKept(const StepTimes& steps, std::size_t n, std::size_t count, double damping, Made made)
        : StepsOfRun(steps, n, count, damping), made_(std::make_shared<const Made>(std::move(made))) {}
    std::size_t bytes() const override {
        return sizeof(*this) + sizeof(Made) + (count_ + 1) * (7 + 2 * made_->m) * sizeof(double);
    }

private:
    std::shared_ptr<const Made> first_steps(std::size_t /*count*/) const override { return made_; }

    std::shared_ptr<const Made> made_;
};

/// Recomputes affine steps from their start when their motion is evaluated.
class StepsAgain final : public StepsOfRun {
public:
    /// The steps `first` to `last` of a block that begins with step n of the run.
    StepsAgain(const AffineBlock& block, const StepTimes& steps, std::size_t n, std::size_t first, std::size_t last,
               double friction, const model::Excitation& M, std::vector<double> states, std::vector<double> rates)
        : StepsOfRun(steps, n + first, last - first, block.map.c / block.inverse_inertia),
          map_(block.map),
          inertia_(1 / block.inverse_inertia),
          begin_(block.at(first)),
          friction_(friction),
          M_begin_(block.M[first]),
          M_(M),
          states_(std::move(states)),
          rates_(std::move(rates)) {
        if (!M.has_script()) return;  // a user's function may have changed since
        const auto* samples = block.samples.data();
        samples_.assign(samples + 2 * first, samples + 2 * last);
    }
    std::size_t bytes() const override {
        return sizeof(*this) + (samples_.size() + 2 * states_.size()) * sizeof(double);
    }

private:
    std::shared_ptr<const Made> first_steps(std::size_t count) const override {
        AffineBlock block(map_, inertia_);
        if (samples_.empty()) {
            block.sample(M_, steps_, n_, count);
        } else {
            std::copy_n(samples_.begin(), 2 * count, block.samples.begin());
        }
        block.begin(0, count, begin_, M_begin_, friction_);
        Made made{.friction = std::vector(count + 1, friction_),
                  .middle_friction = std::vector(count, friction_),
                  .m = states_.size()};
        for (std::size_t i = 0; i <= count; ++i) {
            const model::State y = i == 0 ? begin_ : block.end_of(i - 1);
            block.theta[i] = y.theta, block.velocity[i] = y.velocity;
            made.y.push_back(y), made.accelerations.push_back(block.acceleration(i, y)), made.M.push_back(block.M[i]);
            if (i < count) made.middle_M.push_back(block.samples[2 * i]);
            for (std::size_t k = 0; k < states_.size(); ++k) {
                made.states.push_back(states_[k] + static_cast<double>(i) * map_.h * rates_[k]);
                made.rates.push_back(rates_[k]);
            }
        }
        return std::make_shared<const Made>(std::move(made));
    }

    AffineStep map_;
    double inertia_;
    model::State begin_;
    double friction_, M_begin_;
    model::Excitation M_;
    std::vector<double> samples_, states_, rates_;  ///< states at the start; their rates are constant
};

}  // namespace

PlainSteps::PlainSteps(const Request& problem, const Mechanics& mechanics)
    : problem_(problem),
      mechanics_(mechanics),
      joint_(problem.system.joints.front()),
      M_(problem.drive.loads.front()),
      m_(mechanics.states()),
      possible_(problem.step > 0 && mechanics.joints() == 1 && m_ == mechanics.states_of_user()),
      watches_(!problem.drive.events.empty()),
      steps_(problem.window, possible_ ? problem.step : 1),
      block_({joint_.stiffness / problem.system.bodies.front().inertia,
              joint_.damping / problem.system.bodies.front().inertia, steps_.h},
             problem.system.bodies.front().inertia) {
    const Signal& load = mechanics.loads().front();
    const model::Friction& law = joint_.friction.law;
    even_friction_ = mechanics.is_native(0) && !law.depends_on_speed() && joint_.spring.none() && !joint_.stops;
    ranges_.t = model::bounds::anything, ranges_.y.assign(2 + m_, model::bounds::anything);
    for (std::size_t k = 0; possible_ && k < m_; ++k) {
        const auto range = ranges_.of(mechanics.rate_function(k).function->read(), nullptr, problem.system.named);
        if (range && range->is_one() && std::isfinite(range->lo)) constant_rates_.push_back(range->lo);
    }
    if (constant_rates_.size() < m_) constant_rates_.clear();
    affine_ = even_friction_ && !load.depends_on_motion() && constant_rates_.size() == m_;
    const bool remembers = load.relays() > 0 || !load.delays().empty() || load.has_sampled();
    // Rows of a named body include accelerations, which plain steps compute from these torques only.
    possible_ = possible_ && !remembers && !mechanics.may_open(0) && !mechanics.has_normal(0) && !joint_.rigid &&
                !mechanics.has_belts() && !mechanics.has_base() && (even_friction_ || problem.joined_elsewhere);
    for (const model::WantedEvent& event : problem.drive.events) {
        possible_ = possible_ && event.when->read() != nullptr;  // otherwise its distance from zero cannot be bounded
    }
    if (!possible_) return;
    if (!affine_) accelerations_.resize(AffineBlock::most + 1);
    states_.resize(m_ * (AffineBlock::most + 1)), rates_.resize(states_.size());
    slopes_.resize(4 * (2 + m_));
    point_.resize(2 + m_);
}

bool PlainSteps::may_begin(const Now& now) const {
    const Slipping& how = now.mode.friction[0];
    return possible_ && now.mode.leans[0] == 0 && now.mode.presses[0] == 0 && !how.riding &&
           how.creeps == Motion::stuck && how.beside == 0 && !how.driven_back &&
           (!now.mode.holds(0) || mechanics_.is_native(0));
}

bool PlainSteps::take(const Parts& parts, double until) {
    const double t = parts.now.t.hi;
    return t == steps_.time(steps_.at(t)) ? parts.now.t.lo == 0 && take_steps(parts, until)
                                          : take_rest_of_step(parts, until);
}

/// Completes the step that an event has interrupted by a step of the remaining length.
bool PlainSteps::take_rest_of_step(const Parts& parts, double until) {
    const double t = parts.now.t.hi, end = steps_.time(steps_.at(t) + 1);
    if (!(end - t > 1e-3 * steps_.h) || !(end < until)) return false;
    const StepTimes whole = std::exchange(steps_, StepTimes({t, end}, end - t));
    const AffineStep map = std::exchange(block_.map, AffineStep(block_.map.w, block_.map.c, end - t));
    const auto sampled = std::exchange(sampled_, {0, 0});
    is_rest_of_step_ = true;
    const bool took = take_steps(parts, until);
    is_rest_of_step_ = false;
    steps_ = whole, block_.map = map;
    // The samples of this step are overwritten.
    sampled_ = steps_.at(t) > sampled.from ? sampled : decltype(sampled_){0, 0};
    return took;
}

bool PlainSteps::take_steps(const Parts& parts, double until) {
    Now& now = parts.now;
    const bool waits = watches_ || parts.conditions.any();
    const std::size_t most = waits ? tries_ : AffineBlock::most;
    const std::size_t n = steps_.at(now.t.hi);
    if (!(n >= sampled_.from && n < sampled_.to &&
          steps_.time(sampled_.to) < until)) {  // after an event the samples are still valid
        std::size_t count = std::min(AffineBlock::most, steps_.count - n);
        if (n + count == steps_.count && !is_rest_of_step_) --count;  // the last step may be shorter
        while (count > 0 && !(steps_.time(n + count) < until)) count /= 2;
        sampled_ = {n, n + (affine_ ? block_.sample(M_, steps_, n, count) : count)};
    }
    if (sampled_.to == n) return false;
    if (affine_ && (now.after_break || end_.t != now.t.hi)) {
        end_ = {now.t.hi, now.after_break ? M_.value_after(now.t.hi) : M_.value(now.t.hi)};
    }
    const std::size_t begin = n - sampled_.from;
    const bool stands = now.mode.holds(0);
    const Motion way = stands ? Motion::stuck : now.rubs(0) ? now.mode.friction[0].way : model::motion_of(now.y[1]);
    friction_ =
        !stands && now.rubs(0) && even_friction_ ? model::sign_of(way) * joint_.friction.law.sliding(way, 0) : 0;
    const model::Friction& law = joint_.friction.law;
    const bool has_corners = !stands && now.rubs(0) && law.ranges() > 1 && joint_.friction.function == nullptr;
    range_ = has_corners ? law.range(now.mode.friction[0].range) : model::SpeedRange{.from = 0, .to = model::never};
    if (!begin_functions(parts, begin) || !std::isfinite(end_.M)) return false;
    const std::size_t stop = std::min(begin + most, sampled_.to - sampled_.from);
    const std::size_t end = stands ? rest(parts, begin, stop) : move(parts, begin, stop, way);
    if (waits && end == stop) tries_ = std::min(2 * tries_, AffineBlock::most);
    if (end == begin) return false;
    now.y[0] = block_.theta[end], now.y[1] = block_.velocity[end];
    std::copy_n(states(end), m_, now.y.begin() + 2);
    now.low[0] = 0;
    now.t = {time(end), 0};
    now.after_break = false;
    end_ = {now.t.hi, block_.M[end]};
    Slipping& left = now.mode.friction[0];
    left.leaving = false, left.margin = 0;
    parts.contacts.of[0].edge = 0, parts.contacts.of[0].leaves_wall = false;
    return true;
}

/// Evaluates acceleration, rates of states, and M. Returns false if one is not finite.
bool PlainSteps::find_rates(const Mode& mode, const Moment& at, double* rates, double& M) const {
    rates[0] = at.y[1];
    if (!affine_) {
        M = mechanics_.loads().front().value(at);
        const double torque = even_friction_ ? friction_ + joint_.damping * at.y[1] + joint_.stiffness * at.y[0]
                                             : mechanics_.joint_torque(0, at, mode, 0);
        rates[1] = mode.holds(0) ? 0 : (M - torque) * block_.inverse_inertia;
        if (!std::isfinite(rates[1] + M)) return false;
    }
    if (m_ > 0) mechanics_.rates(at, rates + 2, &mode);
    return std::all_of(rates + 2, rates + 2 + m_, [](double rate) { return std::isfinite(rate); });
}

/// Evaluates the functions at the start of a sequence of steps.
bool PlainSteps::begin_functions(const Parts& parts, std::size_t i) {
    if (affine_ && m_ == 0) return true;
    const Moment at{parts.now.t.hi, parts.now.side(), parts.departing};
    if (!find_rates(parts.now.mode, at, slopes_.data(), affine_ ? end_.M : block_.M[i])) return false;
    std::copy_n(parts.now.y.begin() + 2, m_, states(i));
    std::copy_n(slopes_.begin() + 2, m_, rates(i));
    if (affine_) return true;
    block_.theta[i] = parts.now.y[0], block_.velocity[i] = parts.now.y[1];
    accelerations_[i] = slopes_[1], end_.M = block_.M[i];
    return true;
}

/// Makes step i of the classical method. Returns false if a value is not finite or, with a direction, if the velocity
/// may leave it or reach a corner of the friction law.
bool PlainSteps::step_functions(const Parts& parts, std::size_t i, double direction) {
    const std::size_t size = 2 + m_;
    const double h = steps_.h, t = time(i);
    const std::array<double, 4> along{0, h / 2, h / 2, h};
    const auto value = [&](std::size_t k) {
        return k == 0 ? block_.theta[i] : k == 1 ? block_.velocity[i] : states(i)[k - 2];
    };
    slopes_[0] = block_.velocity[i], slopes_[1] = accelerations_[i];
    std::copy_n(rates(i), m_, slopes_.begin() + 2);
    double M = 0;
    const auto leaves = [&](double v) {
        return direction != 0 && !(direction * v > range_.from && direction * v < range_.to);
    };
    for (std::size_t stage = 1; stage < along.size(); ++stage) {
        const double* before = slopes_.data() + (stage - 1) * size;
        for (std::size_t k = 0; k < size; ++k) point_[k] = value(k) + along[stage] * before[k];
        if (leaves(point_[1])) return false;
        const double at = stage + 1 < along.size() ? t + h / 2 : time(i + 1);
        if (!find_rates(parts.now.mode, {at, Side::at, point_}, slopes_.data() + stage * size, M)) return false;
    }
    const double* k = slopes_.data();
    for (std::size_t j = 0; j < size; ++j)
        point_[j] = value(j) + h / 6 * (k[j] + 2 * k[size + j] + 2 * k[2 * size + j] + k[3 * size + j]);
    if (leaves(point_[1])) return false;
    if (!find_rates(parts.now.mode, {time(i + 1), Side::at, point_}, slopes_.data(), M)) return false;
    // the velocity may have dipped below zero
    if (direction * accelerations_[i] < 0 && direction * slopes_[1] > 0) return false;
    block_.theta[i + 1] = point_[0], block_.velocity[i + 1] = point_[1];
    accelerations_[i + 1] = slopes_[1], block_.M[i + 1] = block_.samples[2 * i + 1] = M;
    std::copy_n(point_.begin() + 2, m_, states(i + 1));
    std::copy_n(slopes_.begin() + 2, m_, rates(i + 1));
    return true;
}

/// Advances the states, whose rates are constant, with an affine step.
void PlainSteps::step_states(std::size_t i) {
    for (std::size_t k = 0; k < m_; ++k)
        states(i + 1)[k] = states(i)[k] + steps_.h * constant_rates_[k], rates(i + 1)[k] = constant_rates_[k];
}

/// Returns whether the motion stays clear of walls during a step.
bool PlainSteps::clear_of_walls(std::size_t i, double reach) const {
    const model::Walls* walls = joint_.any_walls();
    if (walls == nullptr) return true;
    const double far = steps_.h * reach;
    return block_.theta[i] + far < walls->upper && block_.theta[i] - far > walls->lower;
}

/// Returns whether certainly no user event and no change of a condition happens in these steps. Between the ends of a
/// step, values may change by twice as much as the rates at its ends indicate.
bool PlainSteps::is_calm(const Parts& parts, std::size_t first, std::size_t last) {
    const double h = steps_.h;
    const bool stands = parts.now.mode.holds(0);
    ranges_.t = {time(first), time(last)};
    const auto range = [&](auto&& value, auto&& rate) {
        double low = value(first), high = low, fastest = 0;
        for (std::size_t i = first; i <= last; ++i) {
            low = std::min(low, value(i)), high = std::max(high, value(i));
            fastest = std::max(fastest, std::fabs(rate(i)));
        }
        return model::bounds::Interval{low - h * fastest, high + h * fastest};
    };
    const auto velocity = [&](std::size_t i) { return block_.velocity[i]; };
    ranges_.y[0] = range([&](std::size_t i) { return block_.theta[i]; }, velocity);
    ranges_.y[1] = range(velocity, [&](std::size_t i) { return stands ? 0 : acceleration(i, block_.at(i)); });
    for (std::size_t k = 0; k < m_; ++k) {
        ranges_.y[2 + k] =
            range([&](std::size_t i) { return states(i)[k]; }, [&](std::size_t i) { return rates(i)[k]; });
    }
    return parts.users.stay_clear(ranges_) && parts.conditions.stay_clear(ranges_, parts.now.here());
}

/// Returns the step up to which certainly nothing happens from `first` on.
std::size_t PlainSteps::calm_until(const Parts& parts, std::size_t first, std::size_t last) {
    if (first == last || (!watches_ && !parts.conditions.any()) || is_calm(parts, first, last)) return last;
    std::size_t calm = first, busy = last;
    while (busy - calm > 1) {
        const std::size_t middle = calm + (busy - calm) / 2;
        (is_calm(parts, calm, middle) ? calm : busy) = middle;
    }
    tries_ = std::max<std::size_t>(1, calm - first);
    return calm;
}

/// Moves in one direction from step `begin` of the block on; without dry friction it also turns. Returns the step at
/// which it stops, at most `stop`.
std::size_t PlainSteps::move(const Parts& parts, std::size_t begin, std::size_t stop, Motion way) {
    const std::size_t n = sampled_.from;
    const bool rubs = parts.now.rubs(0);
    if (affine_) block_.begin(begin, stop, {parts.now.y[0], parts.now.y[1]}, end_.M, friction_);
    if (!rubs && parts.recorder.heading()[0] == Motion::stuck) parts.recorder.set_heading(0, parts.now.y[1]);
    std::size_t first = begin, i = begin;  // rows are written up to step `first`
    for (;;) {
        const double direction = rubs ? model::sign_of(way) : model::sign_of(model::motion_of(block_.velocity[i]));
        const std::size_t from = i;
        if (affine_) {
            i = block_.step(i, stop, direction);
            for (std::size_t k = from; m_ > 0 && k < i; ++k) step_states(k);
        } else {
            while (direction != 0 && i < stop && step_functions(parts, i, direction)) ++i;
        }
        const auto fastest = [&](std::size_t since) {
            double most = 0;
            for (std::size_t k = since; k <= i; ++k) most = std::max(most, std::fabs(block_.velocity[k]));
            return most;
        };
        const double reach = joint_.any_walls() != nullptr ? 2 * fastest(first) : 0;
        while (i > first && !(clear_of_walls(i, reach) && std::isfinite(block_.theta[i] + block_.velocity[i]))) --i;
        if (i > from) i = calm_until(parts, from, i);
        const std::size_t good = rows(parts, n, first, i, false);
        if (std::exchange(i, good) != good || rubs || i == stop || !clear_of_walls(i, reach) || !turn(parts, n, i))
            break;
        first = i++;
    }
    keep(parts, begin, i, false);
    return i;
}

/// Without dry friction, continues through a step in which the velocity clearly changes its sign once, and records the
/// turn.
bool PlainSteps::turn(const Parts& parts, std::size_t n, std::size_t i) {
    if (!affine_ && !step_functions(parts, i, 0)) return false;
    const model::State y = block_.at(i), y1 = affine_ ? block_.end_of(i) : block_.at(i + 1);
    const double h = steps_.h, a = acceleration(i, y), a1 = acceleration(i + 1, y1);
    const double direction = model::sign_of(model::motion_of(y.velocity));
    constexpr double clearly = 1e-9;  // relative to the terms of the acceleration
    const double M = affine_ ? std::fabs(block_.forcing[i]) : std::fabs(block_.M[i]) * block_.inverse_inertia;
    const double least = clearly * (block_.map.w * std::fabs(y.theta) + M) + 1e-280;
    const bool once = direction * a < -least && direction * a1 < -least && direction * y1.velocity < 0;
    if (!once || parts.recorder.heading()[0] != model::motion_of(direction)) return false;
    const StepInterpolant motion(h, y, a, y1, a1);
    const auto zero = first_velocity_zero(direction, h, y.velocity, a, y1.velocity, a1);
    if (!zero) return false;
    block_.theta[i + 1] = y1.theta, block_.velocity[i + 1] = y1.velocity;
    if (affine_) step_states(i);
    if (calm_until(parts, i, i + 1) == i) return false;
    const double x = TurnInStep(motion, h, *zero).x, t = steps_.time(n + i) + x;
    const model::State there{motion(x).theta, 0};
    parts.recorder.report_event(
        {.event = {.t = t, .kind = model::EventKind::turn, .theta = there.theta, .M = M_at(i, t, there)}});
    parts.recorder.set_heading(0, -direction);
    return true;
}

double PlainSteps::M_at(std::size_t i, double t, const model::State& y) {
    if (affine_) return M_.value(t);
    put_state(i, t, y);
    return mechanics_.loads().front().value({t, Side::at, point_});
}

/// Sets `point_` to the state within step i for the motion y.
void PlainSteps::put_state(std::size_t i, double t, const model::State& y) {
    const double h = steps_.h, s = (t - time(i)) / h;
    point_[0] = y.theta, point_[1] = y.velocity;
    for (std::size_t k = 0; k < m_; ++k) {
        point_[2 + k] =
            s > 0 ? cubic(s, h, states(i)[k], rates(i)[k], states(i + 1)[k], rates(i + 1)[k]) : states(i)[k];
    }
}

/// Stands still as long as the pull is well within the limits.
std::size_t PlainSteps::rest(const Parts& parts, std::size_t begin, std::size_t stop) {
    const Moment here = parts.now.here();
    const double forward = mechanics_.holding(0, Motion::forward, here);
    const double backward = mechanics_.holding(0, Motion::backward, here);
    if (!std::isfinite(forward + backward)) return begin;
    const double theta = parts.now.y[0];
    const double held = joint_.stiffness * theta + joint_.spring.torque(theta);
    Hold hold(forward, backward, held, end_.M);
    std::size_t i = begin;
    const auto stand_at = [&](std::size_t k) {
        block_.theta[k] = theta, block_.velocity[k] = 0;
        if (!affine_) accelerations_[k] = 0;
    };
    stand_at(i), block_.M[i] = end_.M;
    for (; i < stop; ++i) {
        if (affine_) step_states(i);
        if (!affine_ && m_ > 0 && !step_functions(parts, i, 0)) break;
        stand_at(i + 1);
        if (!affine_) {
            block_.samples[2 * i] = M_at(i, time(i) + steps_.h / 2, {theta, 0});
            block_.samples[2 * i + 1] = M_at(i, time(i) + steps_.h, {theta, 0});
        }
        if (!hold.lasts(block_.samples[2 * i], block_.samples[2 * i + 1])) break;
        block_.M[i + 1] = block_.samples[2 * i + 1];
    }
    i = rows(parts, sampled_.from, begin, calm_until(parts, begin, i), true);
    keep(parts, begin, i, true);
    return i;
}

/// Writes the rows of these steps. Returns the step at one of whose rows M is not finite, otherwise `last`.
std::size_t PlainSteps::rows(const Parts& parts, std::size_t n, std::size_t first, std::size_t last, bool stands) {
    for (std::size_t i = first; i < last;) {
        const double t = parts.recorder.next_row_time(), end = steps_.time(n + i + 1);
        if (!(t < steps_.time(n + last))) return last;
        if (!(t < end)) {
            i = std::max(i + 1, std::min(steps_.at(t) - n, last));
            continue;
        }
        model::State y = block_.at(i);
        double M = block_.M[i];
        const double x = t - steps_.time(n + i);
        if (x > 0) {
            const model::State y1 = block_.at(i + 1);
            if (!stands) y = StepInterpolant(steps_.h, y, acceleration(i, y), y1, acceleration(i + 1, y1))(x);
            M = M_at(i, t, y);
            if (!std::isfinite(M)) return i;
        }
        if (m_ > 0 || !affine_) put_state(i, t, y);
        double friction = stands ? joint_.stiffness * y.theta + joint_.spring.torque(y.theta) - M : 0.0 - friction_;
        if (!stands && !even_friction_) friction = mechanics_.friction(0, {t, Side::at, point_}, parts.now.mode, 0);
        parts.recorder.put_row(t, y, M, friction, std::span(point_).subspan(2));
    }
    return last;
}

/// Stores these steps of the block in the history.
void PlainSteps::keep(const Parts& parts, std::size_t first, std::size_t last, bool stands) {
    if (first == last || !problem_.limits.dense) return;
    const std::size_t n = sampled_.from;
    const double from = steps_.time(n + first), length = steps_.time(n + last) - from;
    Kept kept{.start = {from, 0}, .h = length / 2, .length = length};
    kept.y.push_back({block_.theta[first]}), kept.y.push_back({block_.velocity[first]});
    for (std::size_t k = 0; k < m_; ++k) kept.y.push_back({states(first)[k]});
    const bool constant = m_ == 0 || !constant_rates_.empty();  // whether the rates are constant
    if (stands && constant) {
        for (std::size_t k = 0; k < m_; ++k) {
            Series& change = kept.y[2 + k].change;
            change[0] = change[1] = constant_rates_[k] * length / 2;
        }
        kept.acting.resize(1);
        kept.acting[0].holds = true;
    } else if (affine_ && constant) {
        kept.remade = std::make_shared<StepsAgain>(block_, steps_, n, first, last, friction_, M_,
                                                   std::vector(states(first), states(first) + m_), constant_rates_);
    } else {
        kept.remade = std::make_shared<StepsKept>(steps_, n + first, last - first, joint_.damping,
                                                  made(parts, first, last, stands));
    }
    parts.recorder.keep(std::move(kept));
}

Made PlainSteps::made(const Parts& parts, std::size_t first, std::size_t last, bool stands) {
    Made made{.m = m_};
    for (auto* each : {&made.accelerations, &made.M, &made.friction, &made.middle_M, &made.middle_friction}) {
        each->reserve(last - first + 1);
    }
    made.y.reserve(last - first + 1);
    const auto friction_at = [&](std::size_t i, double t, const model::State& y) {
        if (stands || even_friction_) return friction_;
        put_state(i, t, y);
        return -mechanics_.friction(0, {t, Side::at, point_}, parts.now.mode, 0);
    };
    const double h = steps_.h;
    for (std::size_t i = first; i <= last; ++i) {
        const model::State y = block_.at(i);
        const double a = stands ? 0 : acceleration(i, y);
        made.y.push_back(y), made.accelerations.push_back(a), made.M.push_back(block_.M[i]);
        made.friction.push_back(friction_at(i, time(i), y));
        if (i == last) break;
        const model::State y1 = block_.at(i + 1);
        const double a1 = stands ? 0 : acceleration(i + 1, y1), t = time(i) + h / 2;
        const model::State middle = StepInterpolant(h, y, a, y1, a1)(h / 2);
        made.middle_friction.push_back(friction_at(i, t, middle));
        // The stages of a step are slightly off the motion, so M follows from the acceleration.
        const double between = 1.5 * (y1.velocity - y.velocity) / h - (a + a1) / 4;
        made.middle_M.push_back(affine_ || stands
                                    ? block_.samples[2 * i]
                                    : between / block_.inverse_inertia + joint_.damping * middle.velocity +
                                          joint_.stiffness * middle.theta + joint_.spring.torque(middle.theta) +
                                          made.middle_friction[i - first]);
    }
    made.states.assign(states(first), states(last) + m_);
    made.rates.assign(rates(first), rates(last) + m_);
    return made;
}

}  // namespace dinal::motion::engine
