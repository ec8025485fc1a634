// A sum of powers, sines, exponentials, a free motion and resonances as a curve over time: walked along in looks, each
// with a bound of what it hides.
//
// It is the velocity on an arc, or the load on a mass at rest.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "motion/exact/free_motion.hpp"
#include "motion/exact/resonance.hpp"

namespace dinal::motion::exact {

class WalkedCurve {
public:
    explicit WalkedCurve(const LinearMotion& free);
    WalkedCurve(const WalkedCurve&) = delete;
    WalkedCurve& operator=(const WalkedCurve&) = delete;

    struct Value {
        double f = 0, slope = 0;
    };
    /// At the end of a stretch.
    struct End {
        double f = 0, slope = 0, bend = 0;
    };
    /// A value and its derivatives, each over the factorial of its order.
    static constexpr std::size_t jet_order = 6;
    using Jet = std::array<double, jet_order + 1>;

    // What it is made of, told anew for each arc. As a rule these are the frequencies and rates of the arc before.
    void clear() {
        powers_.clear(), way_powers_.clear(), resonances_.clear();
        sines_ = rates_ = 0;
        free_part_ = false;
    }
    void add_power(double c) { powers_.push_back(c); }
    /// Of a velocity: the powers of the way, which are integrals of its own but for the constant one.
    void add_way_power(double c) { way_powers_.push_back(c); }
    /// Im(turning exp(i omega tau))
    void add_sine(double omega, Complex turning) {
        place_for(omega, sines_, omega_);
        if (start_.sines.size() < sines_) start_.sines.resize(sines_);
        start_.sines[sines_ - 1] = turning;
    }
    void add_exponential(double rate, double amount) {
        place_for(rate, rates_, rate_);
        if (start_.amounts.size() < rates_) start_.amounts.resize(rates_);
        start_.amounts[rates_ - 1] = amount;
    }
    void add_resonance(const Resonance& resonance) { resonances_.push_back(resonance); }
    /// The velocity of a free motion from this state.
    void add_free(double theta, double velocity) { start_.free = free_.parts(theta, velocity), free_part_ = true; }
    /// All is there: the walk begins at 0.
    void begin();

    /// Anywhere, to rounding; the walk stays where it is.
    Value at(double tau) {
        aside_ = 0;
        asked_ = &other_, asked_place_ = tau;
        return turn(start_, turn_by(tau), other_, tau);
    }
    /// The same with three derivatives, and then with the others.
    const Jet& jet(double tau) { return derive(at(tau)); }
    const Jet& further_jet();
    /// The same by a look ahead of this length: what looks round is in it.
    const Jet& jet_ahead(double length) {
        next_place_ = place_ + length;
        there_ = turn(*now_, turn_by(length), *next_, next_place_);
        aside_ = 0;
        asked_ = next_, asked_place_ = next_place_;
        return derive(there_);
    }
    [[nodiscard]] bool asked_ahead() const { return asked_ != &other_; }
    /// Where jet() was asked last, and this little further on: there way() is told.
    void step_aside(double further) { aside_ = further; }
    /// Of a velocity: the way since the beginning, where at() or jet() was asked last.
    [[nodiscard]] double way() const;

    // The walk.
    [[nodiscard]] double place() const { return place_; }
    [[nodiscard]] const Value& here() const { return here_; }
    /// Looks ahead by a length of the table, or any length; and goes there.
    static constexpr int levels = 40;
    [[nodiscard]] double length(int level) const { return longest_ * halved[static_cast<std::size_t>(level)]; }
    const Value& look(int level) {
        std::uint8_t& slot = slots_[static_cast<std::size_t>(level)];
        if (slot == none) slot = new_turn(length(level));
        next_place_ = place_ + length(level);
        return there_ = turn(*now_, turns_[slot], *next_, next_place_);
    }
    const Value& look_at(double tau) {
        next_place_ = tau;
        return there_ = turn(start_, turn_by(tau), *next_, tau);
    }
    void go() {
        now_ = next_;
        next_ = next_ == &first_ ? &second_ : &first_;
        place_ = next_place_;
        here_ = there_;
    }
    /// h^4/384 for the length of a level: the cubic through both ends of a look is no farther off, times max|f''''|.
    [[nodiscard]] double hides(int level) const {
        const double square = length(level) * length(level);
        return square * square * (1.0 / 384);
    }
    /// What |f''''| does not exceed from here to there.
    [[nodiscard]] double fourth_bound(double until) const {
        const double bound = free_part_ ? sines_fourth_ + free_.fourth_bound(now_->free) : sines_fourth_;
        return may_grow() ? bound + growing_bound(until) : bound;
    }
    /// Whether that grows with `until`.
    [[nodiscard]] bool may_grow() const { return !only_swings_; }
    /// How much faster than that its next derivatives grow, about.
    [[nodiscard]] double fastest() const {
        if (powers_.size() > jet_order + 1) return too_fast;
        return fastest_;
    }
    /// What the sixth derivative does not exceed, where the fourth does not exceed `fourth_bound`. Near resonance it
    /// has the sum of six products of five factors each where the fourth has four of three.
    [[nodiscard]] double sixth_bound(double fourth_bound) const {
        if (powers_.size() > 6) return too_fast;
        return fourth_bound * fastest_ * fastest_ * (resonances_.empty() ? 1 : 2);
    }
    /// The size of the numbers that it is the sum of, from here to there.
    [[nodiscard]] double size(double until) const;

private:
    static constexpr double too_fast = std::numeric_limits<double>::infinity();
    static constexpr std::array<double, levels> halved = [] {
        std::array<double, levels> parts{};
        double part = 1;
        for (double& each : parts) each = part, part /= 2;
        return parts;
    }();

    /// What each part has become by some time.
    struct Moment {
        std::vector<Complex> sines;
        std::vector<double> amounts;
        std::vector<std::array<Complex, 2>> resonances;  // the divided difference, and exp(mu tau)
        FreeParts free{};
    };
    /// What a time does to each part; to sines, exponentials and resonances in a row of each.
    struct Turn {
        double tau;
        std::size_t row;
        Complex root;
        double along, moved, kept, bent;  // of the free motion
    };
    static constexpr std::uint8_t none = 255;
    static constexpr std::size_t habits = 4;

    /// The next of these frequencies or rates is `rate`.
    void place_for(double rate, std::size_t& count, std::vector<double>& rates) {
        if (count == rates.size()) {
            rates.push_back(rate);
            changed_ = true;
        } else if (rates[count] != rate) {
            rates[count] = rate;
            changed_ = true;
        }
        ++count;
    }
    [[nodiscard]] bool same_resonances() const;
    void make_table();
    std::uint8_t new_turn(double tau);
    void make_turn(double tau, Turn& to);
    /// A turn from the beginning; the last few are kept, as motions have habits.
    const Turn& turn_by(double tau) {
        for (const std::uint8_t slot : kept_) {
            if (slot != none && turns_[slot].tau == tau) return turns_[slot];
        }
        oldest_ = (oldest_ + 1) % habits;
        std::uint8_t& slot = kept_[oldest_];
        if (slot == none) {
            slot = new_turn(tau);
        } else {
            make_turn(tau, turns_[slot]);
        }
        return turns_[slot];
    }
    /// Turns every part, and sums up at the new place.
    Value turn(const Moment& from, const Turn& by, Moment& to, double place) const {
        Value y;
        const Complex *factor = sine_rows_.data() + by.row * sines_, *part = from.sines.data();
        const double* omega = omega_.data();
        Complex* turned = to.sines.data();
        for (std::size_t j = 0; j < sines_; ++j) {
            const Complex z = times(part[j], factor[j]);
            turned[j] = z;
            y.f += z.imag();
            y.slope += omega[j] * z.real();
        }
        if (free_part_) {
            const FreeParts free{by.along * from.free.first + by.moved * from.free.second,
                                 by.kept * from.free.second - by.bent * from.free.first};
            to.free = free;
            y.f += free_.velocity(free);
            y.slope += free_.acceleration(free);
        }
        if (!only_swings_) turn_others(from, by, to, place, y);
        return y;
    }
    void turn_others(const Moment& from, const Turn& by, Moment& to, double place, Value& y) const;
    [[nodiscard]] Value powers(double tau) const;
    [[nodiscard]] double growing_bound(double until) const;
    const Jet& derive(const Value& y);
    void derive_others(std::size_t from, std::size_t to);

    const LinearMotion& free_;
    std::vector<double> powers_, way_powers_, omega_, rate_;
    std::vector<Resonance> resonances_;
    bool free_part_ = false;
    bool turns_free_ = false;  // the turns are made for free motions, too: since the first one
    bool only_swings_ = true;  // it has no powers, exponentials and resonances
    bool changed_ = true;      // since the turns were made
    std::size_t sines_ = 0, rates_ = 0;
    double sines_fourth_ = 0, sines_size_ = 0;

    double longest_;
    double fastest_;
    std::vector<Complex> table_mu_;
    // By the length of each level, made when it is wanted first, and the last others.
    std::array<std::uint8_t, levels> slots_;
    std::array<std::uint8_t, habits> kept_;
    std::vector<Turn> turns_;
    std::vector<Complex> sine_rows_;
    std::vector<double> growth_rows_;
    std::vector<std::array<Complex, 2>> resonance_rows_;
    std::size_t oldest_ = 0;

    Moment start_, first_, second_, other_;  // two for the walk, which take turns, and one for at()
    const Moment* now_ = &start_;
    Moment* next_ = &first_;
    const Moment* asked_ = &other_;  // of which jet() and way() tell
    double place_ = 0, next_place_ = 0, asked_place_ = 0;
    Jet jet_{};  // of asked_, as far as it was asked for
    std::size_t jet_size_ = 0;
    double aside_ = 0;
    Value here_, there_;
};

}  // namespace dinal::motion::exact
