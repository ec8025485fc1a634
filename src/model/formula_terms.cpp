// A formula that is a sum of native terms of t, found by calculating with such sums in place of numbers.
#include <cmath>
#include <numbers>

#include "model/formula.hpp"
#include "model/terms.hpp"

namespace dinal::model {
namespace {

constexpr std::size_t most_powers = 4;

/// c[0] + c[1] x + ... + sines + exponentials, where x is the time since the beginning of a piece. Powers of t itself
/// would cancel on a short piece far from t = 0.
struct TermSum {
    struct Grown {
        double amplitude, rate;
    };
    std::vector<double> powers{};
    std::vector<Harmonic> sines{};
    std::vector<Grown> exponentials{};
    Excitation others{};  ///< terms given as functions of t itself

    bool is_polynomial() const { return sines.empty() && exponentials.empty() && others.components().empty(); }
    bool is_line() const { return is_polynomial() && powers.size() <= 2; }
    bool is_constant() const { return is_polynomial() && powers.size() <= 1; }
    double power(std::size_t n) const { return n < powers.size() ? powers[n] : 0; }

    void add(const TermSum& other, double gain) {
        powers.resize(std::max(powers.size(), other.powers.size()));
        for (std::size_t i = 0; i < other.powers.size(); ++i) powers[i] += gain * other.powers[i];
        for (Harmonic sine : other.sines) {
            sine.amplitude *= gain;
            add(sine);
        }
        for (const Grown& one : other.exponentials) exponentials.push_back({gain * one.amplitude, one.rate});
        if (!other.others.components().empty()) others = others + other.others.scaled(gain);
    }
    /// Sines of the same frequency are combined.
    void add(const Harmonic& sine) {
        for (Harmonic& own : sines) {
            if (own.omega != sine.omega) continue;
            const double along = own.amplitude + sine.amplitude * std::cos(sine.phase - own.phase);
            const double across = sine.amplitude * std::sin(sine.phase - own.phase);
            own.amplitude = std::hypot(along, across), own.phase += std::atan2(across, along);
            return;
        }
        sines.push_back(sine);
    }
};

std::optional<TermSum> product_of(const TermSum& a, const TermSum& b) {
    if (a.is_constant() || b.is_constant()) {
        TermSum made;
        made.add(a.is_constant() ? b : a, (a.is_constant() ? a : b).power(0));
        return made;
    }
    if (!a.is_polynomial() || !b.is_polynomial() || a.powers.size() + b.powers.size() > most_powers + 1) return {};
    TermSum made{.powers = std::vector<double>(a.powers.size() + b.powers.size() - 1)};
    for (std::size_t i = 0; i < a.powers.size(); ++i) {
        for (std::size_t j = 0; j < b.powers.size(); ++j) made.powers[i + j] += a.powers[i] * b.powers[j];
    }
    return made;
}

std::optional<TermSum> result_of(Op op, const TermSum& a, const TermSum& b) {
    TermSum made = a;
    switch (op) {
        case Op::move:
        case Op::exact:
            return a;
        case Op::add:
            made.add(b, 1);
            return made;
        case Op::subtract:
            made.add(b, -1);
            return made;
        case Op::negate:
            return product_of(a, {.powers = {-1}});
        case Op::multiply:
            return product_of(a, b);
        case Op::divide:
            if (!b.is_constant()) return {};
            return product_of(a, {.powers = {1 / b.power(0)}});
        case Op::power:
            if (!b.is_constant() || b.power(0) != 2) return {};
            return product_of(a, a);
        case Op::sin:
        case Op::cos: {
            if (!a.is_line()) return {};
            const double sign = a.power(1) < 0 ? -1 : 1, quarter = op == Op::cos ? std::numbers::pi / 2 : 0;
            return TermSum{.sines = {{.amplitude = op == Op::cos ? 1 : sign,
                                      .omega = sign * a.power(1),
                                      .phase = sign * a.power(0) + quarter}}};
        }
        case Op::exp: {
            // A growing exponential with a tiny first value would lose its digits, or underflow.
            constexpr double faintest = 1e-200;
            const double first = std::exp(a.power(0)), rate = a.power(1);
            if (!a.is_line() || (rate > 0 && first < faintest)) return {};
            return TermSum{.exponentials = {{first, rate}}};
        }
        default:
            return {};
    }
}

/// Growth per period: x(t + period) = x(t) + slope period. A period of 0 fits any period.
struct Repeating {
    double slope = 0, period = 0;
    std::optional<double> constant = {};
    bool operator==(const Repeating&) const = default;
};

/// The least common period; empty if it exceeds `most_beats` times the longer period.
std::optional<double> common_period(double a, double b) {
    if (a == 0 || b == 0) return a + b;
    constexpr int most_beats = 60;
    for (int n = 1; n <= most_beats; ++n) {
        const double common = n * std::max(a, b), times = common / std::min(a, b);
        if (std::fabs(times - std::round(times)) <= 1e-12 * times) return common;
    }
    return {};
}

/// The same growth with a period that raises x by a multiple of `step`.
std::optional<Repeating> in_steps(Repeating x, double step) {
    if (x.slope == 0) return x;
    const auto common = common_period(x.period, std::fabs(step / x.slope));
    if (!common) return {};
    x.period = *common;
    return x;
}

/// The period of an excitation: empty if it has none, 0 if it is constant.
std::optional<double> period_of(const Excitation& excitation) {
    std::optional<double> all = 0;
    for (const Component& c : excitation.components()) {
        const double own = std::visit([](const auto& term) { return terms::period_of(term); }, c.term);
        if (!all || (own == 0 && constant_from(c) != -never) || c.from != -never || c.to != never) return {};
        all = common_period(*all, own);
    }
    return all;
}

std::optional<Repeating> repeats(Op op, const Repeating& a, const Repeating& b) {
    const auto common = common_period(a.period, b.period);
    if (!common) return {};
    switch (op) {
        case Op::move:
        case Op::exact:
            return a;
        case Op::add:
            return Repeating{a.slope + b.slope, *common};
        case Op::subtract:
            return Repeating{a.slope - b.slope, *common};
        case Op::negate:
            return Repeating{-a.slope, a.period};
        case Op::multiply:
            if (a.constant) return Repeating{*a.constant * b.slope, b.period};
            if (b.constant) return Repeating{a.slope * *b.constant, a.period};
            break;
        case Op::divide:
        case Op::floor_divide: {
            if (!b.constant || *b.constant == 0) break;
            const Repeating quotient{a.slope / *b.constant, a.period};
            return op == Op::divide ? quotient : in_steps(quotient, 1);
        }
        case Op::floor:
        case Op::ceil:
            return in_steps(a, 1);
        case Op::modulo: {
            const auto turned = b.constant && *b.constant != 0 ? in_steps(a, *b.constant) : std::nullopt;
            if (!turned) break;
            return Repeating{0, turned->period};
        }
        case Op::sin:
        case Op::cos:
        case Op::tan:
        case Op::native: {
            const auto turn = op == Op::native ? period_of(to_excitation(*b.constant)) : 2 * std::numbers::pi;
            if (turn == 0) return Repeating{};
            const auto turned = turn ? in_steps(a, *turn) : std::nullopt;
            if (!turned) return {};
            return Repeating{0, turned->period};
        }
        default:
            break;
    }
    if (a.slope != 0 || b.slope != 0) return {};
    return Repeating{0, *common};
}

}  // namespace

double Formula::period() const {
    using Registers = std::vector<std::optional<Repeating>>;
    if (motion_ || state_count_ != 0) return 0;
    std::map<std::size_t, Registers> ways;  // the registers with which a step is reached
    std::optional<double> all = 0;
    const auto take = [&all](const std::optional<Repeating>& x) {
        all = all && x && x->slope == 0 ? common_period(*all, x->period) : std::nullopt;
    };
    const auto lead = [&ways](std::size_t to, const Registers& now) {
        Registers& there = ways.try_emplace(to, now).first->second;
        for (std::size_t i = 0; i < now.size(); ++i) {
            if (there[i] == now[i]) continue;
            const bool alike = there[i] && now[i] && there[i]->slope == now[i]->slope;
            const auto common = alike ? common_period(there[i]->period, now[i]->period) : std::nullopt;
            there[i] = common ? std::optional(Repeating{now[i]->slope, *common}) : std::nullopt;
        }
    };
    lead(0, Registers(registers_.size(), Repeating{}));
    ways[0][0] = Repeating{.slope = 1};
    std::vector<char> written(registers_.size(), 0);
    written[0] = 1;
    for (const Step& s : steps_) {
        if (s.op < Op::less) written[s.to] = 1;
    }
    while (!ways.empty() && all) {
        const std::size_t at = ways.begin()->first;
        auto now = std::move(ways.begin()->second);
        ways.erase(ways.begin());
        const Step& s = steps_[at];
        const auto read = [&](std::size_t i) {
            if (written[i] != 0) return now[i];
            return std::optional(Repeating{.constant = registers_[i]});
        };
        const auto a = read(s.a), b = read(s.b);
        if (s.op >= Op::less && s.op < Op::jump) {
            take(a && b ? repeats(Op::subtract, *a, *b) : std::nullopt);
            lead(s.yes, now), lead(s.no, now);
        } else if (s.op == Op::jump) {
            lead(s.yes, now);
        } else if (s.op == Op::give) {
            take(a);
        } else if (s.op != Op::fail) {
            now[s.to] = a && b ? repeats(s.op, *a, *b) : std::nullopt;
            lead(at + 1, now);
        }
    }
    return all.value_or(0);
}

namespace {

/// Returns the excitation evaluated at `time` as a sum, if the time is t plus a constant; otherwise empty.
std::optional<TermSum> delayed(const Excitation& excitation, const TermSum& time, double from) {
    if (!time.is_line() || time.power(1) != 1) return {};
    const double by = from - time.power(0);
    return TermSum{.others = by == 0 ? excitation : excitation.delayed(by)};
}

}  // namespace

std::optional<Excitation> Formula::terms(double from, double inside) const {
    if (motion_ || state_count_ != 0) return {};
    std::vector<std::optional<TermSum>> registers;
    for (const double x : registers_) registers.push_back(TermSum{.powers = {x}});
    registers[0] = TermSum{.powers = {from, 1}};
    std::vector<double> r = registers_;
    r[0] = inside;
    TermSum sum;
    for (std::size_t at = 0;;) {
        const Step& s = steps_[at];
        const double x = r[s.a], y = r[s.b];
        const auto &a = registers[s.a], &b = registers[s.b];
        if (s.op == Op::give) {
            if (!a) return {};
            sum = *a;
            break;
        }
        if (s.op == Op::fail) return {};
        double result = 0;
        if (s.op >= Op::less) {
            at = s.op == Op::jump || apply(s.op, x, y, result) ? s.yes : s.no;
            continue;
        }
        if (!apply(s.op, x, y, result)) return {};
        std::optional<TermSum> made;
        const bool staircase = s.op == Op::floor || s.op == Op::ceil || s.op == Op::floor_divide;
        if (staircase) {
            made = TermSum{.powers = {result}};  // constant on this piece
        } else if (a && s.op == Op::abs) {
            made = product_of(*a, {.powers = {x < 0 ? -1.0 : 1.0}});
        } else if (a && b && (s.op == Op::modulo || s.op == Op::fmod)) {
            if (!b->is_constant()) return {};
            made = a;
            made->add({.powers = {decision_of(s.op, x, y, result) * y}}, -1);
        } else if (a && s.op == Op::native && !a->is_constant()) {
            made = delayed(to_excitation(y), *a, from);
        } else if (a && b) {
            made = result_of(s.op, *a, *b);
        }
        // A value computed from constants alone is kept bit for bit.
        if (!made && a && b && a->is_constant() && b->is_constant()) made = TermSum{.powers = {result}};
        registers[s.to] = made;
        r[s.to] = result;
        ++at;
    }
    std::vector<Term> made;
    const bool alone = sum.others.components().empty();
    if (sum.is_constant()) {
        made.emplace_back(Constant{sum.power(0)});
    } else if (sum.powers.size() > 1 || sum.power(0) != 0) {
        made.emplace_back(Polynomial{.coefficients = sum.powers, .at = from});
    }
    for (Harmonic sine : sum.sines) {
        sine.at = from;
        made.emplace_back(sine);
    }
    for (const auto& [amplitude, rate] : sum.exponentials) {
        made.emplace_back(Exponential{.amplitude = amplitude, .tau = -1 / rate, .at = from});
    }
    if (made.empty() && alone) return {};
    Excitation all = sum.others;
    for (const Term& term : made) {
        const auto one = Excitation::make(term);
        if (!one) return {};
        all = all + *one;
    }
    return all;
}

}  // namespace dinal::model
