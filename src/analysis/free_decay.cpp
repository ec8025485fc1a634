#include "analysis/free_decay.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "theory/theory_free.hpp"

namespace dinal::analysis {
namespace {

/// The most rows computed by rotation from the previous row, for even times; limits the rounding error.
constexpr int turned_on = 32;

class DecayRows {
public:
    DecayRows(const model::Oscillator& system, std::span<const double> times, Eigen::VectorXd& theta)
        : decay_(system.damping_ratio() * system.natural_frequency()),
          omega_(theory::Modes(system.damping_ratio()).rate() * system.natural_frequency()),
          times_(times),
          theta_(theta) {
        if (times.size() < 2) return;
        spacing_ = times[1] - times[0];
        constexpr double roundings = 4;
        slack_ =
            roundings * std::numeric_limits<double>::epsilon() * std::max(std::fabs(times[0]), std::fabs(times.back()));
        step_ = turned({1, 0}, spacing_);
    }

    [[nodiscard]] bool done() const { return next_ >= times_.size(); }
    /// The time of the next row relative to the first.
    [[nodiscard]] double next_time() const { return times_[next_] - times_[0]; }

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
    void put(double theta) { theta_[static_cast<Eigen::Index>(next_++)] = theta; }
    [[nodiscard]] std::complex<double> turned(std::complex<double> z, double tau) const {
        const double kept = std::exp(-decay_ * tau), c = kept * std::cos(omega_ * tau),
                     s = kept * std::sin(omega_ * tau);
        return {z.real() * c - z.imag() * s, z.real() * s + z.imag() * c};
    }

    double decay_, omega_;
    std::span<const double> times_;
    Eigen::VectorXd& theta_;
    double spacing_ = 0, slack_ = 0;
    std::complex<double> step_ = 1;
    std::size_t next_ = 0;
};

}  // namespace

Eigen::VectorXd free_decay(const model::Oscillator& system, const model::State& initial, std::span<const double> times,
                           std::optional<double> rests_at) {
    Eigen::VectorXd theta(static_cast<Eigen::Index>(times.size()));
    const theory::FreeMotion motion(system, initial);
    const double zeta = system.damping_ratio();
    constexpr double slow = 1e-3;  // relative to w0: slower swings need other forms than sine and cosine
    if (!theory::Modes(zeta).swings() || theory::Modes(zeta).rate() < slow) {
        for (std::size_t i = 0; i < times.size(); ++i) {
            theta[static_cast<Eigen::Index>(i)] = motion.at(times[i] - times[0]).theta;
        }
        return theta;
    }
    const double shift = system.kinetic_friction() / system.stiffness();
    DecayRows rows(system, times, theta);
    const theory::Extreme first = motion.extreme(0);
    if (initial.velocity != 0) rows.swing(initial.velocity > 0 ? -shift : shift, 0, initial, first.t);
    const double until_rest = rests_at.value_or(motion.extremes() - 1);
    const double half = std::numbers::pi / (theory::Modes(zeta).rate() * system.natural_frequency());
    while (!rows.done()) {
        const double n = std::max(0.0, std::floor((rows.next_time() - first.t) / half));
        if (n >= until_rest) {
            rows.rest(motion.extreme(until_rest).theta);
            break;
        }
        const theory::Extreme last = motion.extreme(n);
        const double end = first.t + (n + 1) * half;
        const bool from_below = (first.theta < 0) != (std::fmod(n, 2) != 0);
        // A row that rounding places before its swing still belongs to it.
        rows.swing(from_below ? -shift : shift, last.t, {last.theta, 0},
                   std::max(end, std::nextafter(rows.next_time(), 1e300)));
    }
    return theta;
}

}  // namespace dinal::analysis
