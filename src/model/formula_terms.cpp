// A formula that is a sum of native terms of t, found by calculating with such sums in place of numbers.
#include <cmath>
#include <numbers>

#include "model/formula.hpp"
#include "model/terms.hpp"

namespace dinal::model {
namespace {

constexpr std::size_t most_powers = 4;

/// c[0] + c[1] t + ... + sines + exponentials.
struct TermSum {
    struct Grown {
        double amplitude, rate;
    };
    std::vector<double> powers{};
    std::vector<Harmonic> sines{};
    std::vector<Grown> exponentials{};

    [[nodiscard]] bool is_polynomial() const { return sines.empty() && exponentials.empty(); }
    [[nodiscard]] bool is_line() const { return is_polynomial() && powers.size() <= 2; }
    [[nodiscard]] bool is_constant() const { return is_polynomial() && powers.size() <= 1; }
    [[nodiscard]] double power(std::size_t n) const { return n < powers.size() ? powers[n] : 0; }

    void add(const TermSum& other, double gain) {
        powers.resize(std::max(powers.size(), other.powers.size()));
        for (std::size_t i = 0; i < other.powers.size(); ++i) powers[i] += gain * other.powers[i];
        for (Harmonic sine : other.sines) {
            sine.amplitude *= gain;
            add(sine);
        }
        for (const Grown& one : other.exponentials) exponentials.push_back({gain * one.amplitude, one.rate});
    }
    /// Sines of one pace are one.
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
        case Op::exp:
            if (!a.is_line()) return {};
            return TermSum{.exponentials = {{std::exp(a.power(0)), a.power(1)}}};
        default:
            return {};
    }
}

}  // namespace

std::vector<Term> Formula::terms(double from) const {
    if (has_conditions_) return {};
    std::vector<std::optional<TermSum>> registers;
    for (const double x : registers_) registers.push_back(TermSum{.powers = {x}});
    registers[0] = TermSum{.powers = {0, 1}};
    if (motion_) registers[1] = registers[2] = std::nullopt;
    if (state_count_ != 0) return {};
    TermSum sum;
    for (std::size_t at = 0;; ++at) {
        const Step& s = steps_[at];
        if (s.op == Op::give_whole) {
            sum.powers = {static_cast<double>(to_whole(registers_[s.a]))};
            break;
        }
        if (s.op >= Op::less || !registers[s.a] || !registers[s.b]) {
            if (s.op != Op::give || !registers[s.a]) return {};
            sum = *registers[s.a];
            break;
        }
        registers[s.to] = result_of(s.op, *registers[s.a], *registers[s.b]);
    }
    std::vector<Term> made;
    if (sum.is_constant()) {
        made.emplace_back(Constant{sum.power(0)});
    } else if (sum.powers.size() > 1 || sum.power(0) != 0) {
        made.emplace_back(Polynomial{.coefficients = sum.powers});
    }
    for (const Harmonic& sine : sum.sines) made.emplace_back(sine);
    for (const auto& [amplitude, rate] : sum.exponentials) {
        made.emplace_back(Exponential{.amplitude = amplitude * std::exp(rate * from), .tau = -1 / rate, .at = from});
    }
    return made;
}

}  // namespace dinal::model
