// Discs and intervals hold what a program gives: random programs at random places, in more digits.

#include <array>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include "model/bounds.hpp"
#include "support/catch.hpp"

namespace dinal::bounds_test {

namespace {

using model::Formula;
using model::Op;
namespace bounds = model::bounds;
using Number = std::complex<long double>;

constexpr std::size_t inputs = 3, constants = 4, steps = 10;

struct Program {
    std::vector<Formula::Step> list;
    std::vector<double> registers;
};

class Lot {
public:
    explicit Lot(unsigned seed) : random_(seed) {}
    double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
    std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
    template <std::size_t n>
    Op one_of(const std::array<Op, n>& ops) {
        return ops[below(n)];
    }
    /// Registers hold t, theta, velocity, then constants, then one result after the other. A result is used soon.
    Program program(const auto& ops) {
        Program made;
        made.registers.assign(inputs, 0);
        for (const double x : {2.0, -3.0, between(-2, 2), 0.5}) made.registers.push_back(x);
        for (std::size_t k = 0; k < steps; ++k) {
            const std::size_t last = made.registers.size() - 1;
            const auto any = [&] {
                return below(3) == 0 ? below(last + 1) : std::min(last, below(2) == 0 ? last : below(inputs));
            };
            Formula::Step s{.op = one_of(ops)};
            s.to = static_cast<std::uint16_t>(last + 1), s.a = static_cast<std::uint16_t>(any());
            const bool constant_power = s.op == Op::power && below(4) > 0;
            s.b = static_cast<std::uint16_t>(constant_power ? inputs + below(constants) : any());
            const bool of_two = s.op < Op::negate || s.op == Op::atan2 || s.op == Op::fmod;
            if (!of_two) s.b = s.a;
            made.list.push_back(s);
            made.registers.push_back(0);
        }
        made.list.push_back({.op = Op::give, .a = static_cast<std::uint16_t>(made.registers.size() - 1)});
        return made;
    }

private:
    std::mt19937 random_;
};

constexpr std::array smooth = {Op::add, Op::subtract, Op::multiply, Op::multiply, Op::divide, Op::power, Op::negate,
                               Op::sin, Op::cos,      Op::tan,      Op::asin,     Op::acos,   Op::atan2, Op::exp,
                               Op::exp, Op::log,      Op::log2,     Op::log10,    Op::sqrt};
constexpr std::array all = {Op::add,  Op::subtract, Op::multiply, Op::divide, Op::power, Op::negate, Op::sin,
                            Op::cos,  Op::tan,      Op::asin,     Op::acos,   Op::atan2, Op::exp,    Op::log,
                            Op::log2, Op::log10,    Op::sqrt,     Op::abs,    Op::fmod,  Op::modulo, Op::floor_divide};

Number apply(Op op, const Number& a, const Number& b) {
    switch (op) {
        case Op::add:
            return a + b;
        case Op::subtract:
            return a - b;
        case Op::multiply:
            return a * b;
        case Op::divide:
            return a / b;
        case Op::power:
            if (b == Number(std::round(b.real())) && std::abs(b) < 100) {
                Number product = 1;
                for (int k = 0; k < std::abs(static_cast<int>(b.real())); ++k) product *= a;
                return b.real() < 0 ? Number(1) / product : product;
            }
            return std::exp(b * std::log(a));
        case Op::negate:
            return -a;
        case Op::sin:
            return std::sin(a);
        case Op::cos:
            return std::cos(a);
        case Op::tan:
            return std::tan(a);
        case Op::asin:
            return std::asin(a);
        case Op::acos:
            return std::acos(a);
        case Op::atan2:
            return std::atan(a / b);
        case Op::exp:
            return std::exp(a);
        case Op::log:
            return std::log(a);
        case Op::log2:
            return std::log(a) / std::log(2.0L);
        case Op::log10:
            return std::log(a) / std::log(10.0L);
        default:
            return std::sqrt(a);
    }
}

}  // namespace

TEST_CASE("a disc contains the values of a program for the complex numbers in its arguments") {
    Lot lot(1);
    int samples = 0, tight = 0;
    double most = 0;
    for (int n = 0; n < 20000; ++n) {
        Program made = lot.program(smooth);
        const Formula formula(made.list, made.registers, true, inputs, 0);
        made.list.pop_back();
        bounds::Walk walk;
        walk.begin(formula, nullptr, false);
        std::array<bounds::Disc, inputs> from;
        for (std::size_t i = 0; i < inputs; ++i) {
            from[i] = {lot.between(-3, 3), std::pow(10, lot.between(-8, 0))};
            walk.set(i, from[i], {});
        }
        const bounds::Disc disc = walk.run().disc;
        if (!(disc.r < 1e6) || !std::isfinite(disc.c)) continue;
        for (int k = 0; k < 3; ++k) {
            std::vector<Number> z(made.registers.begin(), made.registers.end());
            // What hangs on constants only is what doubles make of them.
            std::vector<char> constant(z.size(), 1);
            for (std::size_t i = 0; i < inputs; ++i) {
                const long double far = k == 0 ? lot.between(0, 1) : 1, way = lot.between(-3.15, 3.15);
                z[i] = Number(from[i].c) + std::polar(from[i].r * far * (1 - 1e-18L), way);
                constant[i] = 0;
            }
            for (const Formula::Step& s : made.list) {
                constant[s.to] = static_cast<char>(constant[s.a] != 0 && constant[s.b] != 0);
                double plain = 0;
                model::apply(s.op, static_cast<double>(z[s.a].real()), static_cast<double>(z[s.b].real()), plain);
                z[s.to] = constant[s.to] != 0 ? Number(plain) : apply(s.op, z[s.a], z[s.b]);
            }
            const long double off = std::abs(z.back() - Number(disc.c));
            INFO("program " << n);
            REQUIRE(off <= disc.r);
            ++samples;
            tight += off > 0.3L * disc.r ? 1 : 0;
            most = std::max(most, static_cast<double>(off / disc.r));
        }
    }
    CHECK(samples > 15000);
    CHECK(tight > 3000);  // as a rule no disc is far greater than it must be
    CHECK(most > 0.99);
}

TEST_CASE("an interval contains the values of a program, and its decisions are those at each point") {
    Lot lot(2);
    int known = 0;
    for (int n = 0; n < 20000; ++n) {
        Program made = lot.program(all);
        Formula formula(made.list, made.registers, true, inputs, 0);
        bounds::Walk walk;
        walk.begin(formula, nullptr, true);
        std::array<bounds::Interval, inputs> from;
        for (std::size_t i = 0; i < inputs; ++i) {
            const double c = lot.between(-3, 3), r = std::pow(10, lot.between(-6, 0));
            from[i] = {c - r, c + r};
            walk.set(i, {c, 3 * r}, from[i]);
        }
        const auto told = walk.run();
        if (told.range.is_anything() || !std::isfinite(told.disc.c)) continue;
        ++known;
        for (int k = 0; k < 5; ++k) {
            std::array<double, inputs> x{};
            for (std::size_t i = 0; i < inputs; ++i) {
                x[i] = k == 0 ? from[i].lo : k == 1 ? from[i].hi : lot.between(from[i].lo, from[i].hi);
            }
            const double value = formula.value(x[0], {x[1], x[2]}, {});
            INFO("program " << n);
            REQUIRE(value >= told.range.lo);
            REQUIRE(value <= told.range.hi);
            REQUIRE(std::fabs(value - told.disc.c) <= (told.disc.r + told.apart) * (1 + 1e-12));
        }
    }
    CHECK(known > 3000);
}

TEST_CASE("the rate of a condition's margin is its derivative along the motion") {
    Lot lot(4);
    int known = 0;
    for (int n = 0; n < 20000; ++n) {
        Program made = lot.program(all);
        const auto last = static_cast<std::uint16_t>(made.registers.size() - 1);
        const auto condition = static_cast<std::uint32_t>(made.list.size() - 1);
        made.list.back() = {.op = Op::less, .a = last, .b = inputs, .yes = condition + 1, .no = condition + 2};
        made.list.push_back({.op = Op::give, .a = last});
        made.list.push_back({.op = Op::give, .a = inputs});
        Formula formula(made.list, made.registers, true, inputs, 0);
        const std::array at{lot.between(-3, 3), lot.between(-3, 3), lot.between(-3, 3)};
        const std::array way{1.0, lot.between(-2, 2), lot.between(-2, 2)};
        model::terms::Piece piece;
        formula.decide(piece, at[0], {at[1], at[2]}, {}, ~std::uint64_t{0});
        if (piece.conditions.empty() || piece.conditions.back().step != condition) continue;
        const auto margin = [&](double h) {
            std::vector<double> margins;
            (void)formula.value_on(piece, at[0] + h, {at[1] + h * way[1], at[2] + h * way[2]}, {}, &margins);
            return margins.back();
        };
        const auto slope = [&](double h) {
            return (8 * (margin(h) - margin(-h)) - margin(2 * h) + margin(-2 * h)) / (12 * h);
        };
        const double fine = slope(1e-4), coarse = slope(2e-4), size = std::fabs(fine) + 1e-3 * std::fabs(margin(0));
        if (!std::isfinite(fine - coarse) || size < 1e-6 || std::fabs(fine - coarse) > 1e-7 * size) continue;
        const double rate =
            formula.margin_rate(piece, piece.conditions.size() - 1, at[0], {at[1], at[2]}, {}, {way[1], way[2]}, {});
        if (std::isnan(rate)) continue;  // unknown, as that of the root of a constant 0
        INFO("program " << n << ": rate " << rate << ", difference " << fine);
        REQUIRE(std::fabs(rate - fine) <= 1e-6 * size);
        ++known;
    }
    CHECK(known > 2000);
}

TEST_CASE("whole powers, waves and sums of exponentials have tight bounds") {
    // (t - 1)^2 exp(-t) on a disc of 1 about 1: 0 there, and at most e^0 = 1 (1^2 e^(1 - 1)).
    const std::vector<double> registers{0, 1, 2, 0, 0, 0, 0, 0};
    const Formula formula({{.op = Op::subtract, .to = 3, .a = 0, .b = 1},
                           {.op = Op::power, .to = 4, .a = 3, .b = 2},
                           {.op = Op::negate, .to = 5, .a = 0, .b = 0},
                           {.op = Op::exp, .to = 6, .a = 5, .b = 5},
                           {.op = Op::multiply, .to = 7, .a = 4, .b = 6},
                           {.op = Op::give, .a = 7}},
                          registers, false, 1, 0);
    bounds::Walk walk;
    walk.begin(formula, nullptr, true);
    walk.set(0, {1, 1}, {0, 2});
    const auto told = walk.run();
    CHECK(told.disc.c == 0);
    CHECK(told.disc.r == Approx(1).epsilon(1e-12));
    CHECK(told.range.lo == 0);
    CHECK(told.range.hi == Approx(1).epsilon(1e-12));
    const Formula square({{.op = Op::multiply, .to = 1, .a = 0, .b = 0}, {.op = Op::give, .a = 1}}, {0, 0}, false, 1,
                         0);
    walk.begin(square, nullptr, true);
    walk.set(0, {0.5, 1.5}, {-1, 2});
    CHECK(walk.run().range.lo == 0);
    CHECK(walk.run().range.hi == Approx(4).epsilon(1e-12));
}

}  // namespace dinal::bounds_test
