#include "theory/theory_free.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "model/sticking.hpp"

namespace dinal::theory {

namespace {

using std::numbers::pi;

constexpr double never = std::numeric_limits<double>::infinity();

double side_of(double x) {
    return x < 0 ? -1 : 1;
}

/// zeta, but exactly 1 if the system is critical: the root in damping_ratio() may be rounded.
double regime_zeta(const model::Oscillator& system) {
    return system.regime() == model::Regime::critical ? 1 : system.damping_ratio();
}

// Above this k the two exponentials are computed separately; below it, as sum and difference, which have a limit.
constexpr double apart = 0.5;

}  // namespace

Modes::Modes(double zeta) : zeta_(zeta), rate_(std::sqrt(std::fabs(1 - zeta)) * std::sqrt(1 + zeta)) {}

double Modes::damped_cosine(double x) const {
    if (swings()) return std::exp(-zeta_ * x) * std::cos(rate_ * x);
    return (std::exp(-slow_root() * x) + std::exp(-fast_root() * x)) / 2;
}

double Modes::pushed(double x) const {
    if (rate_ == 0) return x * std::exp(-x);
    if (swings()) return std::exp(-zeta_ * x) * std::sin(rate_ * x) / rate_;
    return -std::exp(-slow_root() * x) * std::expm1(-2 * rate_ * x) / (2 * rate_);
}

Modes::Answers Modes::after(double x) const {
    const double g = pushed(x);
    if (swings() || rate_ < apart) {
        const double cosine = damped_cosine(x);
        return {cosine + zeta_ * g, g, cosine - zeta_ * g};
    }
    const double slow = std::exp(-slow_root() * x), fast = std::exp(-fast_root() * x), between = 2 * rate_;
    return {(fast_root() * slow - slow_root() * fast) / between, g,
            (fast_root() * fast - slow_root() * slow) / between};
}

model::State free_response(double natural_frequency, double zeta, const model::State& initial, double t) {
    const Motion2 y =
        free_motion(Modes(zeta), {initial.theta, initial.velocity / natural_frequency}, natural_frequency * t);
    return {y.y, y.dy * natural_frequency};
}

HalfCycles::HalfCycles(double zeta, double friction_shift)
    : logarithm_(logarithmic_decrement(zeta) / 2), shift_(friction_shift) {}

// n half cycles a -> e a - x_f (1 + e) give e^n a - x_f (1 + e)(1 - e^n)/(1 - e), or a - 2 n x_f for e = 1.
double HalfCycles::shrunk(double n, double size) const {
    if (logarithm_ == 0) return std::fma(-2 * n, shift_, size);
    const double sum = std::expm1(-n * logarithm_) / std::expm1(-logarithm_);
    return size * std::exp(-n * logarithm_) - shift_ * (1 + std::exp(-logarithm_)) * sum;
}

double HalfCycles::after(double n, double X) const {
    const double side = std::fmod(n, 2) == 0 ? side_of(X) : -side_of(X);
    return side * shrunk(n, std::fabs(X));
}

double HalfCycles::until_within(double dead_zone, double X) const {
    const double size = std::fabs(X);
    const double excess = size - dead_zone;
    if (excess <= 0) return 0;
    if (dead_zone == 0 || (logarithm_ == 0 && shift_ == 0)) return never;
    // The extremes are e^n (a + c) - c with c = x_f (1 + e)/(1 - e) = x_f/slope; solve for the edge of the dead zone.
    const double slope = std::tanh(logarithm_ / 2);
    const double guess = logarithm_ == 0 ? excess / (2 * shift_)
                                         : std::log1p(excess * slope / (dead_zone * slope + shift_)) / logarithm_;
    constexpr double countable = 0x1p50;
    if (!(guess < countable)) return std::ceil(guess);
    double n = std::max(1.0, std::ceil(guess) - 1);
    const double edge = dead_zone + 8 * std::numeric_limits<double>::epsilon() * size;  // rounding of the extremes
    for (int i = 0; i < 4 && shrunk(n, size) > edge; ++i) ++n;  // the guess is off by at most a rounding
    return n;
}

FreeMotion::FreeMotion(const model::Oscillator& system, const model::State& initial)
    : system_(system),
      initial_(initial),
      modes_(regime_zeta(system)),
      w0_(system.natural_frequency()),
      shift_(system.kinetic_friction() / system.stiffness()) {
    first_ = {0, initial.theta};
    if (initial.velocity != 0) {
        const double side = side_of(initial.velocity);
        first_.t = first_zero(side) / w0_;
        first_.theta = first_.t < never ? arc(-side, initial, first_.t).theta : 0;
    }
    until_rest_ = half_cycles_to_rest();
}

double FreeMotion::half_cycles_to_rest() const {
    if (first_.t == never) return never;
    if (stays(first_.theta)) return 0;
    if (!modes_.swings()) return never;
    const double n = HalfCycles(modes_.zeta(), shift_).until_within(system_.dead_zone(), first_.theta);
    return std::max(1.0, n);  // the friction law decides at the edge of the dead zone
}

bool FreeMotion::stays(double theta) const {
    return model::motion_from_standstill(system_, 0, theta) == model::Motion::stuck;
}

/// The motion while friction pushes towards `side`: about side x_f.
model::State FreeMotion::arc(double side, const model::State& start, double t) const {
    const model::State y = free_response(w0_, modes_.zeta(), {start.theta - side * shift_, start.velocity}, t);
    return {y.theta + side * shift_, y.velocity};
}

/// x = w0 t of the first zero of the velocity, which begins towards `side`; infinity without one.
/// v(x) = 0 where (tan qx)/q (tanh, or x) is |v0|/(zeta |v0| + y0).
double FreeMotion::first_zero(double side) const {
    const double v = std::fabs(initial_.velocity) / w0_;
    const double y = side * initial_.theta + shift_;
    const double rate = modes_.rate();
    if (modes_.swings()) return std::atan2(rate * v, modes_.zeta() * v + y) / rate;
    const double slow = modes_.slow_root() * v + y;
    if (slow <= 0) return never;
    return rate == 0 ? v / slow : std::log1p(2 * rate * v / slow) / (2 * rate);
}

double FreeMotion::half_cycle() const {
    return pi / (modes_.rate() * w0_);
}

model::State FreeMotion::at(double t) const {
    if (t < first_.t) return arc(-side_of(initial_.velocity), initial_, t);
    if (t >= time_to_rest()) return {extreme(until_rest_).theta, 0};
    const double n = modes_.swings() ? std::min(std::floor((t - first_.t) / half_cycle()), until_rest_ - 1) : 0;
    const Extreme last = extreme(n);
    return arc(side_of(last.theta), {last.theta, 0}, t - last.t);
}

double FreeMotion::time_to_rest() const {
    return until_rest_ < never ? extreme(until_rest_).t : never;
}

std::optional<double> FreeMotion::rest_position() const {
    if (until_rest_ < never) return extreme(until_rest_).theta;
    if (modes_.zeta() == 0) return {};
    if (modes_.swings()) return 0;
    return shift_ * (first_.t < never ? side_of(first_.theta) : -side_of(initial_.velocity));
}

double FreeMotion::extremes() const {
    if (first_.t == never) return 0;
    return modes_.swings() || until_rest_ == 0 ? until_rest_ + 1 : 1;
}

Extreme FreeMotion::extreme(double n) const {
    if (n == 0) return first_;
    return {first_.t + n * half_cycle(), HalfCycles(modes_.zeta(), shift_).after(n, first_.theta)};
}

namespace {

/// The most rows computed by rotation from the previous row, for even times; limits the rounding error.
constexpr int turned_on = 32;

class DecayRows {
public:
    DecayRows(const model::Oscillator& system, std::span<const double> times, std::span<double> theta)
        : decay_(system.damping_ratio() * system.natural_frequency()),
          omega_(Modes(system.damping_ratio()).rate() * system.natural_frequency()),
          times_(times),
          theta_(theta) {
        if (times.size() < 2) return;
        spacing_ = times[1] - times[0];
        constexpr double roundings = 4;
        slack_ =
            roundings * std::numeric_limits<double>::epsilon() * std::max(std::fabs(times[0]), std::fabs(times.back()));
        step_ = turned({1, 0}, spacing_);
    }

    bool done() const { return next_ >= times_.size(); }
    /// The time of the next row relative to the first.
    double next_time() const { return times_[next_] - times_[0]; }

    /// Computes the rows before `until` as a swing about `centre` from this state at the time `from`.
    void swing(double centre, double from, const model::State& start, double until) {
        const double y = start.theta - centre;
        const std::complex<double> begin{y, -(start.velocity + decay_ * y) / omega_};
        std::complex<double> now;
        for (int since = turned_on; !done() && next_time() < until; ++since) {
            const bool even =
                since < turned_on && next_ > 0 && std::fabs(times_[next_] - times_[next_ - 1] - spacing_) <= slack_;
            if (even) {
                now = {now.real() * step_.real() - now.imag() * step_.imag(),
                       now.real() * step_.imag() + now.imag() * step_.real()};
            } else {
                now = turned(begin, next_time() - from);
                since = 0;
            }
            put(centre + now.real());
        }
    }
    void rest(double theta) {
        while (!done()) put(theta);
    }

private:
    void put(double theta) { theta_[next_++] = theta; }
    std::complex<double> turned(std::complex<double> z, double tau) const {
        const double kept = std::exp(-decay_ * tau), c = kept * std::cos(omega_ * tau),
                     s = kept * std::sin(omega_ * tau);
        return {z.real() * c - z.imag() * s, z.real() * s + z.imag() * c};
    }

    double decay_, omega_;
    std::span<const double> times_;
    std::span<double> theta_;
    double spacing_ = 0, slack_ = 0;
    std::complex<double> step_ = 1;
    std::size_t next_ = 0;
};

}  // namespace

void free_decay(const model::Oscillator& system, const model::State& initial, std::span<const double> times,
                std::optional<double> rests_at, std::span<double> theta) {
    const FreeMotion motion(system, initial);
    const double zeta = system.damping_ratio();
    constexpr double slow = 1e-3;  // relative to w0: slower swings need other forms than sine and cosine
    if (!Modes(zeta).swings() || Modes(zeta).rate() < slow) {
        for (std::size_t i = 0; i < times.size(); ++i) theta[i] = motion.at(times[i] - times[0]).theta;
        return;
    }
    const double shift = system.kinetic_friction() / system.stiffness();
    DecayRows rows(system, times, theta);
    const Extreme first = motion.extreme(0);
    if (initial.velocity != 0) rows.swing(initial.velocity > 0 ? -shift : shift, 0, initial, first.t);
    const double until_rest = rests_at.value_or(motion.extremes() - 1);
    const double half = pi / (Modes(zeta).rate() * system.natural_frequency());
    while (!rows.done()) {
        const double n = std::max(0.0, std::floor((rows.next_time() - first.t) / half));
        if (n >= until_rest) {
            rows.rest(motion.extreme(until_rest).theta);
            break;
        }
        const Extreme last = motion.extreme(n);
        const double end = first.t + (n + 1) * half;
        const bool from_below = (first.theta < 0) != (std::fmod(n, 2) != 0);
        // A row that rounding places before its swing still belongs to it.
        rows.swing(from_below ? -shift : shift, last.t, {last.theta, 0},
                   std::max(end, std::nextafter(rows.next_time(), 1e300)));
    }
}

double logarithmic_decrement(double zeta) {
    return 2 * pi * zeta / (std::sqrt(1 - zeta) * std::sqrt(1 + zeta));
}

std::optional<Dampings> identify(double X0, double X1, double X2) {
    X0 = std::fabs(X0), X1 = std::fabs(X1), X2 = std::fabs(X2);
    const double first = X0 - X1;
    const double second = X1 - X2;
    if (!(first > 0 && second > 0)) return {};
    const double q = second / first;
    const double decay = -std::log(q);
    return Dampings{decay / std::hypot(decay, pi), (q * X0 - X1) / (1 + q)};
}

}  // namespace dinal::theory
