// Encloses an excitation of native terms over a range of times. Between two breaks, terms with a closed form are
// evaluated by it.
#include <algorithm>

#include "model/bounds.hpp"

namespace dinal::model::bounds {
namespace {

template <class Number>
Number exactly(double x) {
    return {x, {}};
}
template <>
Interval exactly(double x) {
    return {x, x};
}

Interval calculated(Op op, const Interval& a, const Interval& b) {
    return image(op, a, b);
}
Disc calculated(Op op, const Disc& a, const Disc& b) {
    double c = 0;
    if (!apply(op, a.c, b.c, c)) c = std::numeric_limits<double>::quiet_NaN();
    return image(op, a, b, c);
}

/// Adds up the terms on one smooth piece, over the times given to the constructor; see closed_form.hpp.
template <class Number>
class Values {
public:
    explicit Values(const Number& times) : times_(times) {}

    void set_gain(double gain) { gain_ = exactly<Number>(gain); }
    void add(const Number& x) { sum_ = of(Op::add, sum_, of(Op::multiply, gain_, x)); }
    const Number& sum() const { return sum_; }
    /// The greatest magnitude of an intermediate result, for the rounding error.
    double greatest() const { return greatest_; }

    // Called by the terms' closed_form().
    void add_constant(double level) { add(exactly<Number>(level)); }
    void add_line(double at, double level, double slope) {
        add(plus(times(exactly<Number>(slope), since(at)), exactly<Number>(level)));
    }
    void add_powers(double at, std::span<const double> coefficients) {
        const Number x = since(at);
        Number sum = exactly<Number>(0);
        for (std::size_t n = coefficients.size(); n-- > 0;) sum = plus(times(sum, x), exactly<Number>(coefficients[n]));
        add(sum);
    }
    void add_sine(double amplitude, double omega, double at, double phase) {
        add_sine_of(amplitude, plus(times(exactly<Number>(omega), since(at)), exactly<Number>(phase)));
    }
    void add_exponential(double amplitude, double rate, double at) {
        add_exponential_of(amplitude, times(exactly<Number>(rate), since(at)));
    }
    // Terms without a closed form.
    void add(const Gaussian& bump) {
        const Number x = of(Op::divide, since(bump.at), exactly<Number>(bump.sigma));
        const Number square = of(Op::power, x, exactly<Number>(2));
        add_exponential_of(bump.amplitude, times(exactly<Number>(-0.5), square));
    }
    void add(const Chirp& sine, double inside) {
        const Number tau = since(sine.at);
        Number cycles = times(exactly<Number>(sine.from), tau);
        if (inside >= sine.at + sine.duration) {
            const Number late = plus(tau, exactly<Number>(-sine.duration));
            const double before = sine.duration * (0.5 * (sine.from + sine.to));
            cycles = plus(exactly<Number>(before), times(exactly<Number>(sine.to), late));
        } else if (inside >= sine.at) {
            const double bend = 0.5 * (sine.to - sine.from) / sine.duration;
            cycles = times(tau, plus(exactly<Number>(sine.from), times(exactly<Number>(bend), tau)));
        }
        const Number angle = times(exactly<Number>(terms::two_pi), cycles);
        add_sine_of(sine.amplitude, plus(angle, exactly<Number>(sine.phase)));
    }

private:
    Number of(Op op, const Number& a, const Number& b) {
        const Number result = calculated(op, a, b);
        if constexpr (std::is_same_v<Number, Interval>) {
            greatest_ = std::max({greatest_, std::fabs(result.lo), std::fabs(result.hi)});
        }
        return result;
    }
    Number plus(const Number& a, const Number& b) { return of(Op::add, a, b); }
    Number times(const Number& a, const Number& b) { return of(Op::multiply, a, b); }
    Number since(double at) { return of(Op::subtract, times_, exactly<Number>(at)); }
    void add_sine_of(double amplitude, const Number& angle) {
        add(times(exactly<Number>(amplitude), of(Op::sin, angle, angle)));
    }
    /// Adds the rounding error of the exponent first.
    void add_exponential_of(double amplitude, Number exponent) {
        if constexpr (std::is_same_v<Number, Interval>) {
            constexpr double some = 4 * std::numeric_limits<double>::epsilon();
            exponent.lo -= some * std::fabs(exponent.lo), exponent.hi += some * std::fabs(exponent.hi);
        }
        add(times(exactly<Number>(amplitude), of(Op::exp, exponent, exponent)));
    }

    Number times_, gain_ = exactly<Number>(1), sum_ = exactly<Number>(0);
    double greatest_ = 0;
};

/// Adds the component on the smooth piece that contains the time `inside`.
template <class Number>
void add(const Component& c, double inside, Values<Number>& sum) {
    if (c.gain == 0 || inside < c.from || inside >= c.to) return;
    sum.set_gain(c.gain);
    std::visit(
        [&](const auto& term) {
            using Term = std::decay_t<decltype(term)>;
            if constexpr (std::is_same_v<Term, Gaussian>) {
                sum.add(term);
            } else if constexpr (std::is_same_v<Term, Chirp>) {
                sum.add(term, inside);
            } else if constexpr (terms::NativeTerm<Term>) {
                term.closed_form(inside, sum);
            }
        },
        c.term);
}

}  // namespace

Interval image(const Excitation& excitation, const Interval& times) {
    constexpr double few = 16 * std::numeric_limits<double>::epsilon();
    Values<Interval> sum(times);
    for (const Component& c : excitation.components()) {
        if (next_break(c, times.lo) > times.hi) {
            add(c, times.lo, sum);
            continue;
        }
        const double most = std::visit([](const auto& term) { return term.most(); }, c.term);
        sum.set_gain(c.gain);
        sum.add(Interval{-most, most});
    }
    const Interval found = sum.sum();
    if (found.is_anything()) return found;
    return {found.lo - few * sum.greatest(), found.hi + few * sum.greatest()};
}

double radius(const Excitation& excitation, const Disc& times) {
    Values<Disc> sum(times);
    for (const Component& c : excitation.components()) add(c, times.c, sum);
    return sum.sum().r;
}

}  // namespace dinal::model::bounds
