// The module `vector`: evenly spaced and random numbers.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "api/classes.hpp"
#include "lua/options.hpp"
#include "lua/values.hpp"
#include "lua/vector.hpp"

namespace dinal::api {
namespace {

constexpr double most_numbers = 1e9;

int vector_make(lua_State* L) {
    if (lua_gettop(L) != 2 || (lua_type(L, 2) != LUA_TTABLE && lua::test<lua::Vector>(L, 2) == nullptr)) {
        lua::raise(L,
                   {.sentence = "vector takes one table of numbers, for example vector{ 1, 2, 3 }", .call = "vector"});
    }
    return lua::push_vector(L, lua::numbers_at(L, 2, "vector"));
}

std::vector<double> spaced(lua_State* L, double from, double to, std::size_t n) {
    std::vector<double> values = lua::new_numbers(L, n);
    for (std::size_t i = 0; i < n; ++i) {
        // A weighted mean of the ends with integer weights, so that round numbers are exact.
        const long double last = n - 1, weight = i;
        values[i] = static_cast<double>((from * (last - weight) + to * weight) / last);
    }
    return values;
}

using Numbers = std::vector<double>;

std::optional<text::Error> wrong_count(double n) {
    if (text::is_whole(n, 2, most_numbers)) return {};
    return text::Error{fmt::format("n = {} must be a whole number from 2 to {}", n, most_numbers)};
}

text::Expected<Numbers> vector_linspace(lua_State* L, double from, double to, double n) {
    if (const auto wrong = wrong_count(n)) return *wrong;
    return spaced(L, from, to, static_cast<std::size_t>(n));
}

text::Expected<Numbers> vector_range(lua_State* L, double from, double to, std::optional<double> given) {
    const double step = given.value_or(1), ratio = (to - from) / step;
    if (step == 0 || (to - from) * step < 0) {
        return text::Error{fmt::format("step = {:.6g} does not lead from {:.6g} to {:.6g}", step, from, to)};
    }
    if (ratio >= most_numbers) return text::Error{fmt::format("{:.3g} numbers are more than {}", ratio, most_numbers)};
    constexpr double rounding = 1e-9;  // tolerance, as a part of a step: 0 to 0.3 by 0.1 includes its end
    Numbers values = lua::new_numbers(L, static_cast<std::size_t>(std::floor(ratio + rounding)) + 1);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = from + static_cast<double>(i) * step;
    return values;
}

text::Expected<Numbers> vector_logspace(lua_State* L, double from, double to, double n) {
    if (const auto wrong = wrong_count(n)) return *wrong;
    if (!(from > 0) || !(to > 0)) {
        return text::Error{fmt::format(
            "from = {} and to = {} must be positive: they are the ends themselves, not powers of ten", from, to)};
    }
    Numbers values = spaced(L, std::log(from), std::log(to), static_cast<std::size_t>(n));
    for (double& x : values) x = std::exp(x);
    values.front() = from;
    values.back() = to;
    return values;
}

// ---- random numbers

struct UniformNumbers {
    double n = 0, seed = 0, from = 0, to = 1;
};
struct NormalNumbers {
    double n = 0, seed = 0, mean = 0, std = 1;
};
constexpr text::Range count_range{"be a whole number from 1 to 1e9",
                                  [](double x) { return text::is_whole(x, 1, most_numbers); }};
constexpr text::Range seed_range{"be a whole number from 0 to 2^53",
                                 [](double x) { return text::is_whole(x, 0, 9007199254740992.0); }};
constexpr const char* seed_meaning = "the same seed gives the same numbers on every machine";

constexpr text::Option uniform_options[] = {
    {"n", "", text::needed, count_range, "how many", text::fills<&UniformNumbers::n>},
    {"seed", "", text::needed, seed_range, seed_meaning, text::fills<&UniformNumbers::seed>},
    {.name = "from", .meaning = "lower limit", .filled = text::fills<&UniformNumbers::from>},
    {.name = "to", .meaning = "upper limit, excluded", .filled = text::fills<&UniformNumbers::to>},
};
constexpr text::Call uniform_call{"vector.random", "vector.random{ n = 100, seed = 1 }", uniform_options};
constexpr text::Option normal_options[] = {
    {"n", "", text::needed, count_range, "how many", text::fills<&NormalNumbers::n>},
    {"seed", "", text::needed, seed_range, seed_meaning, text::fills<&NormalNumbers::seed>},
    {.name = "mean", .meaning = "their mean", .filled = text::fills<&NormalNumbers::mean>},
    {"std", "", text::its_own, text::not_negative, "their standard deviation", text::fills<&NormalNumbers::std>},
};
constexpr text::Call normal_call{"vector.normal", "vector.normal{ n = 100, seed = 1, std = 0.02 }", normal_options};

/// A number in [0, 1). NOTE: the standard library's distributions differ between implementations.
double unit(std::mt19937_64& engine) {
    return static_cast<double>(engine() >> 11U) * 0x1p-53;
}

std::mt19937_64 engine_of(double seed) {
    return std::mt19937_64(static_cast<std::uint64_t>(seed));
}

int vector_random(lua_State* L) {
    const lua::Options options(L, 1, uniform_call);
    UniformNumbers asked;
    options.fill(asked);
    if (asked.from > asked.to) {
        options.fail(options.has("from") ? "from" : "to",
                     fmt::format("from = {:.6g} must not be greater than to = {:.6g}", asked.from, asked.to));
    }
    std::mt19937_64 engine = engine_of(asked.seed);
    std::vector<double> values = lua::new_numbers(L, static_cast<std::size_t>(asked.n));
    for (double& x : values) x = asked.from + (asked.to - asked.from) * unit(engine);
    return lua::push_vector(L, std::move(values));
}

/// Normal numbers in pairs by the method of Box and Muller.
int vector_normal(lua_State* L) {
    const auto asked = lua::read<NormalNumbers>(L, 1, normal_call);
    std::mt19937_64 engine = engine_of(asked.seed);
    std::vector<double> values = lua::new_numbers(L, static_cast<std::size_t>(asked.n));
    for (std::size_t i = 0; i < values.size(); i += 2) {
        const double radius = asked.std * std::sqrt(-2 * std::log(1 - unit(engine)));
        const double angle = 2 * std::numbers::pi * unit(engine);
        values[i] = asked.mean + radius * std::cos(angle);
        if (i + 1 < values.size()) values[i + 1] = asked.mean + radius * std::sin(angle);
    }
    return lua::push_vector(L, std::move(values));
}

constexpr lua::Member vector_module_members[] = {
    {lua::a_metamethod<vector_make>("__call"),
     {"vector{ ... } -> vector", "A vector of these finite numbers.", "print(#vector{ 1, 2, 3 })  --> 3"}},
    {lua::a_typed_function<vector_range>,
     {"vector.range(from, to [, step]) -> vector",
      "from, from + step, ... up to to, as Lua's for counts; step is 1 unless given. Whole numbers stay whole.",
      "print(vector.range(1, 4), vector.range(0, 1, 0.25))  --> vector{ 1, 2, 3, 4 }\tvector{ 0, 0.25, 0.5, 0.75, "
      "1 }"}},
    {lua::a_typed_function<vector_linspace>,
     {"vector.linspace(from, to, n) -> vector", "n >= 2 numbers with even gaps; the ends are exact.",
      "print(vector.linspace(0, 1, 5))  --> vector{ 0, 0.25, 0.5, 0.75, 1 }"}},
    {lua::a_typed_function<vector_logspace>,
     {"vector.logspace(from, to, n) -> vector",
      "n >= 2 positive numbers with even ratios; the ends, which are exact, are the numbers themselves and not powers "
      "of ten.",
      "print(vector.logspace(0.1, 10, 3))  --> vector{ 0.1, 1, 10 }"}},
    {lua::a_function<vector_normal>,
     {"vector.normal{ OPTIONS } -> vector",
      "Random numbers of the normal distribution, such as noise on a record.",
      "v = vector.normal{ n = 10000, seed = 1, std = 0.02 }\nprint(math.abs(v:std() - 0.02) < 0.0005)  --> true",
      {&normal_call}}},
    {lua::a_function<vector_random>,
     {"vector.random{ OPTIONS } -> vector",
      "Random numbers, uniformly distributed between two limits.",
      "v = vector.random{ n = 1000, seed = 1, from = 2, to = 3 }\nprint(v >= 2, v < 3)  --> true\ttrue",
      {&uniform_call}}},
};

}  // namespace

const lua::Class vector_module{
    "vector",
    {"vector{ ... } -> vector", "Makes vectors.", "print(vector{ 1, 2, 3 }:sum())  --> 6.0"},
    vector_module_members,
};

}  // namespace dinal::api
