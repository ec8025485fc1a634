// A sum of powers, sines, exponentials, a free motion and resonances as a curve over time. A walk advances along it in
// steps called looks, each with a bound of the deviation between its ends.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "motion/complex_product.hpp"
#include "motion/exact/free_motion.hpp"
#include "text/not_copied.hpp"

namespace dinal::motion::exact {

using Complex = std::complex<double>;

/// The imaginary part of a g + b u.
inline double imaginary(Complex a, Complex g, Complex b, Complex u) {
    return (a.real() * g.imag() + a.imag() * g.real()) + (b.real() * u.imag() + b.imag() * u.real());
}
/// An upper bound of |z|, at most 1.42 |z|.
inline double length_of(Complex z) {
    return std::fabs(z.real()) + std::fabs(z.imag());
}

/// Near resonance the response to exp(mu tau) is the divided difference (exp(mu tau) - exp(lambda tau)) / (mu -
/// lambda), which is tau exp(lambda tau) at resonance, rather than two large numbers that nearly cancel.
struct Resonance {
    Complex mu, from_root;                          ///< mu - lambda
    Complex growing, turning;                       ///< the curve is Im(growing g(tau) + turning exp(mu tau))
    Complex way_growing = 0, way_turning = 0;       ///< coefficients of the integral, if the curve is a velocity
    Complex slope_growing = 0, slope_turning = 0;   ///< coefficients of the derivative
    double fourth_growing = 0, fourth_turning = 0;  ///< bounds for the fourth derivative

    /// Returns the divided difference g(tau), given root_turned = exp(lambda tau).
    Complex difference(double tau, Complex root_turned) const {
        const Complex z = from_root * tau;
        const double size = length_of(z);
        if (size == 0) return tau * root_turned;
        if (size < 0.05) {
            // (exp(z) - 1)/z: the first omitted term is z^3/24, or z^9/10!.
            Complex series = 1;
            for (int n = size < 1e-6 ? 3 : 9; n >= 2; --n) series = 1.0 + product(series, z) / static_cast<double>(n);
            return tau * product(series, root_turned);
        }
        // exp(x + i y) - 1 without a difference of nearly equal numbers.
        const double half = std::sin(z.imag() / 2), grown = std::expm1(z.real());
        const Complex less_one{grown * std::cos(z.imag()) - 2 * half * half, (grown + 1) * std::sin(z.imag())};
        return product(root_turned, less_one) / from_root;
    }
};

class WalkedCurve : text::NotCopied {
public:
    explicit WalkedCurve(const LinearMotion& free);

    struct Value {
        double f = 0, slope = 0;
    };
    /// The value and two derivatives at the end of an interval.
    struct End {
        double f = 0, slope = 0, bend = 0;
    };
    /// A value and its derivatives, each divided by the factorial of its order.
    static constexpr std::size_t jet_order = 6;
    using Jet = std::array<double, jet_order + 1>;

    // Terms are added again for each arc; usually the frequencies and rates are those of the previous arc.
    void clear() { sum_.clear(); }
    void add_power(double c) { sum_.powers.push_back(c); }
    /// For a velocity: adds a power of its integral ("way").
    void add_way_power(double c) { sum_.way_powers.push_back(c); }
    /// Im(turning exp(i omega tau))
    void add_sine(double omega, Complex turning) {
        sum_.place_for(omega, sum_.sines, sum_.omega);
        if (start_.sines.size() < sum_.sines) start_.sines.resize(sum_.sines);
        start_.sines[sum_.sines - 1] = turning;
    }
    void add_exponential(double rate, double amount) {
        sum_.place_for(rate, sum_.rates, sum_.rate);
        if (start_.amounts.size() < sum_.rates) start_.amounts.resize(sum_.rates);
        start_.amounts[sum_.rates - 1] = amount;
    }
    void add_resonance(const Resonance& resonance) { sum_.resonances.push_back(resonance); }
    /// The velocity of a free motion from this state.
    void add_free(double theta, double velocity) { start_.free = free_.parts(theta, velocity), sum_.has_free = true; }
    /// Completes the definition and begins the walk at 0.
    void begin();

    /// The value at tau, accurate to rounding. Does not move the walk.
    Value at(double tau) {
        last_point_.set(other_, tau);
        return turn(start_, turn_by(tau), other_, tau);
    }
    /// The value at tau with three derivatives; further_jet() adds the others.
    const Jet& jet(double tau) { return derive(at(tau)); }
    const Jet& further_jet();
    /// The same at the end of a look of this length, including its rounding.
    const Jet& jet_ahead(double length) {
        next_place_ = place_ + length;
        there_ = turn(*now_, turn_by(length), *next_, next_place_);
        last_point_.set(*next_, next_place_);
        return derive(there_);
    }
    bool is_ahead() const { return last_point_.values != &other_; }
    /// Moves the point of way() by this much from the last point of jet().
    void step_aside(double further) { last_point_.aside = further; }
    /// For a velocity: its integral from the start to the last point of at() or jet().
    double way() const;

    // The walk.
    double place() const { return place_; }
    const Value& here() const { return here_; }
    /// look() looks ahead by the length of a level, look_at() to any time; accept_look() moves there.
    static constexpr int levels = 40;
    double length(int level) const { return table_.longest * halved[static_cast<std::size_t>(level)]; }
    const Value& look(int level) {
        std::uint8_t& slot = table_.of_levels[static_cast<std::size_t>(level)];
        if (slot == none) slot = new_turn(length(level));
        next_place_ = place_ + length(level);
        return there_ = turn(*now_, table_.turns[slot], *next_, next_place_);
    }
    const Value& look_at(double tau) {
        next_place_ = tau;
        return there_ = turn(start_, turn_by(tau), *next_, tau);
    }
    void accept_look() {
        now_ = next_;
        next_ = next_ == &first_ ? &second_ : &first_;
        place_ = next_place_;
        here_ = there_;
    }
    /// h^4/384 for a look of this level. Times max|f''''| it bounds the distance from the Hermite cubic through both
    /// ends.
    double hides(int level) const {
        const double square = length(level) * length(level);
        return square * square * (1.0 / 384);
    }
    /// A bound of |f''''| from here to `until`.
    double fourth_bound(double until) const {
        const double bound = sum_.has_free ? sines_fourth_ + free_.fourth_bound(now_->free) : sines_fourth_;
        return may_grow() ? bound + growing_bound(until) : bound;
    }
    /// Returns whether that bound grows with `until`.
    bool may_grow() const { return !only_swings_; }
    /// An estimate of the rate at which higher derivatives grow.
    double fastest() const {
        if (sum_.powers.size() > jet_order + 1) return too_fast;
        return fastest_;
    }
    /// A bound of the sixth derivative, given one of the fourth. Near resonance the sixth derivative has six products
    /// of five factors each, the fourth derivative four of three.
    double sixth_bound(double fourth_bound) const {
        if (sum_.powers.size() > 6) return too_fast;
        return fourth_bound * fastest_ * fastest_ * (sum_.resonances.empty() ? 1 : 2);
    }
    /// The magnitude of the terms of the sum, from here to `until`.
    double size(double until) const;

private:
    static constexpr double too_fast = std::numeric_limits<double>::infinity();
    static constexpr std::array<double, levels> halved = [] {
        std::array<double, levels> parts{};
        double part = 1;
        for (double& each : parts) each = part, part /= 2;
        return parts;
    }();

    /// The value of each part at some time.
    struct PartValues {
        std::vector<Complex> sines;
        std::vector<double> amounts;
        std::vector<std::array<Complex, 2>> resonances;  // the divided difference, and exp(mu tau)
        FreeParts free{};
    };
    /// The factors by which a time step changes each part.
    struct Turn {
        double tau;
        std::size_t row;
        Complex root;
        double along, moved, kept, bent;  // coefficients of the free motion
    };
    static constexpr std::uint8_t none = 255;

    /// The terms of the sum. Their initial values are in `start_`.
    struct Sum {
        std::vector<double> powers{}, way_powers{}, omega{}, rate{};
        std::vector<Resonance> resonances{};
        bool has_free = false;             // whether a free motion is part of it
        bool changed = true;               // whether frequencies or rates changed since the table was made
        std::size_t sines = 0, rates = 0;  // numbers of frequencies and rates in use

        void clear() {
            powers.clear(), way_powers.clear(), resonances.clear();
            sines = rates = 0;
            has_free = false;
        }
        /// Registers the next frequency or rate.
        void place_for(double value, std::size_t& count, std::vector<double>& values) {
            if (count == values.size()) {
                values.push_back(value);
                changed = true;
            } else if (values[count] != value) {
                values[count] = value;
                changed = true;
            }
            ++count;
        }
    };
    /// Cached factors of time steps, for each level and the latest other lengths, as motions repeat their steps.
    struct Table {
        double longest;             // length of the first level
        bool has_free = false;      // whether `turns` has factors of the free motion
        std::vector<Complex> mu{};  // exponents of the resonances
        std::array<std::uint8_t, levels> of_levels;
        std::array<std::uint8_t, 4> latest;
        std::size_t oldest = 0;  // index of the oldest entry of `latest`
        std::vector<Turn> turns{};
        std::vector<Complex> sine_rows{};
        std::vector<double> growth_rows{};
        std::vector<std::array<Complex, 2>> resonance_rows{};

        explicit Table(double longest_look) : longest(longest_look) { of_levels.fill(none), latest.fill(none); }
        void clear() {
            of_levels.fill(none), latest.fill(none);
            mu.clear(), turns.clear(), sine_rows.clear(), growth_rows.clear(), resonance_rows.clear();
        }
    };
    /// The last point of at() or jet().
    struct LastPoint {
        const PartValues* values;
        double place = 0;
        Jet jet{};  // derivatives there, as far as they were computed
        std::size_t jet_size = 0;
        double aside = 0;

        void set(const PartValues& there, double tau) { aside = 0, values = &there, place = tau; }
        /// The integral from `place` to `place + aside`, by the Taylor polynomial of `jet`.
        double further_way() const;
    };

    bool same_resonances() const;
    void make_table();
    std::uint8_t new_turn(double tau);
    void make_turn(double tau, Turn& to);
    /// The factors of a time step of any length.
    const Turn& turn_by(double tau) {
        for (const std::uint8_t slot : table_.latest) {
            if (slot != none && table_.turns[slot].tau == tau) return table_.turns[slot];
        }
        table_.oldest = (table_.oldest + 1) % table_.latest.size();
        std::uint8_t& slot = table_.latest[table_.oldest];
        if (slot == none) {
            slot = new_turn(tau);
        } else {
            make_turn(tau, table_.turns[slot]);
        }
        return table_.turns[slot];
    }
    /// Advances every part and sums them.
    Value turn(const PartValues& from, const Turn& by, PartValues& to, double place) const {
        Value y;
        const Complex *factor = table_.sine_rows.data() + by.row * sum_.sines, *part = from.sines.data();
        const double* omega = sum_.omega.data();
        Complex* turned = to.sines.data();
        for (std::size_t j = 0; j < sum_.sines; ++j) {
            const Complex z = product(part[j], factor[j]);
            turned[j] = z;
            y.f += z.imag();
            y.slope += omega[j] * z.real();
        }
        if (sum_.has_free) {
            const FreeParts free{by.along * from.free.first + by.moved * from.free.second,
                                 by.kept * from.free.second - by.bent * from.free.first};
            to.free = free;
            y.f += free_.velocity(free);
            y.slope += free_.acceleration(free);
        }
        if (!only_swings_) turn_others(from, by, to, place, y);
        return y;
    }
    void turn_others(const PartValues& from, const Turn& by, PartValues& to, double place, Value& y) const;
    Value powers(double tau) const;
    double growing_bound(double until) const;
    const Jet& derive(const Value& y);
    void derive_others(std::size_t from, std::size_t to);

    const LinearMotion& free_;
    Sum sum_;
    bool only_swings_ = true;  // whether the sum has no powers, exponentials and resonances
    double fastest_;
    double sines_fourth_ = 0, sines_size_ = 0;
    Table table_;

    PartValues start_, first_, second_, other_;  // two alternate for the walk, other_ is for at()
    const PartValues* now_ = &start_;
    PartValues* next_ = &first_;
    double place_ = 0, next_place_ = 0;
    Value here_, there_;
    LastPoint last_point_{&other_};
};

}  // namespace dinal::motion::exact
