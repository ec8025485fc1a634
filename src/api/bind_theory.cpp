// theory.NAME{...}: closed forms. Each option is a number or a vector; results have the same shape.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "api/bodies.hpp"
#include "api/classes.hpp"
#include "lua/interrupt.hpp"
#include "lua/options.hpp"
#include "lua/vector.hpp"
#include "model/laws/coulomb.hpp"
#include "model/oscillator.hpp"
#include "motion/rk4/rk4.hpp"
#include "text/option.hpp"
#include "theory/forced.hpp"
#include "theory/theory_free.hpp"

namespace dinal::api {

namespace {

// ---- options, one row each, and the calls that use them

namespace theory_options {

using text::Call;
using text::needed;
using text::Option;
using text::Range;

constexpr Range swinging{"be from 0 to less than 1: without a swing there is no next extreme",
                         [](double x) { return x >= 0 && x < 1; }};
constexpr Range at_most_ten_million{"be a whole number from 0 to 1e+07",
                                    [](double x) { return text::is_whole(x, 0, 1e7); }};
constexpr Range den_hartog_r{"be 0 or from 0.0001 to 1e6", [](double x) {
                                 return x == 0 || (x >= theory::DenHartog::slowest && x <= theory::DenHartog::fastest);
                             }};
constexpr Range at_least_one{"be at least 1: breakaway takes no less than kinetic friction",
                             [](double x) { return x >= 1; }};

// Options of most functions, each a number or a vector.
constexpr Option r{.name = "r", .otherwise = needed, .range = text::not_negative, .meaning = "omega/omega0"};
constexpr Option sliding_r{.name = "r", .otherwise = needed, .range = den_hartog_r, .meaning = "omega/omega0"};
constexpr Option zeta{"zeta", "", "0", text::not_negative, "viscous damping ratio"};
constexpr Option friction_ratio{"friction_ratio", "", needed, text::not_negative, "Rd/M0"};
constexpr Option breakaway_ratio{"breakaway_ratio", "", "friction_ratio", text::not_negative, "Re/M0"};
constexpr Option theta0{"theta0", "rad", "0", text::any_finite, "initial angle"};
constexpr Option velocity0{"velocity0", "rad per time unit", "0", text::any_finite, "initial velocity"};
constexpr const char* a_system = "a system such as system{ I = 1, k = 39.5 }";
constexpr Option system{
    .name = "system", .otherwise = needed, .meaning = "what moves", .object = "system", .wanted = a_system};

constexpr Option free_response_options[] = {
    {"t", "time units", needed, text::any_finite, "times; not negative with dry friction"}, system, theta0, velocity0};
constexpr Call free_response{"theory.free_response",
                             "theory.free_response{ system = sys, theta0 = 1, t = vector.linspace(0, 5, 501) }",
                             free_response_options};

struct ExtremesOptions {
    double theta0 = 0;
    double velocity0 = 0;
    std::optional<double> count = {};
};
constexpr Option extremes_options[] = {
    system,
    {"theta0", "rad", "0", text::any_finite, theta0.meaning, text::fills<&ExtremesOptions::theta0>},
    {"velocity0", velocity0.unit, "0", text::any_finite, velocity0.meaning, text::fills<&ExtremesOptions::velocity0>},
    text::option<&ExtremesOptions::count>("count",
                                          "the largest number of extremes; needed if the motion never comes to rest",
                                          {.range = at_most_ten_million})};
constexpr Call extremes{"theory.extremes", "theory.extremes{ system = sys, theta0 = 1 }", extremes_options};

constexpr Option start_options[] = {system, theta0, velocity0};
constexpr Call time_to_rest{"theory.time_to_rest", "theory.time_to_rest{ system = sys, theta0 = 1 }", start_options};
constexpr Call rest_position{"theory.rest_position", "theory.rest_position{ system = sys, theta0 = 1 }", start_options};

constexpr Option logarithmic_decrement_options[] = {{"zeta", "", needed, swinging, zeta.meaning}};
constexpr Call logarithmic_decrement{"theory.logarithmic_decrement", "theory.logarithmic_decrement{ zeta = 0.1 }",
                                     logarithmic_decrement_options};

constexpr Option identify_options[] = {{"X0", "rad", needed, text::not_zero, "an extreme"},
                                       {"X1", "rad", needed, text::any_finite, "the next one"},
                                       {"X2", "rad", needed, text::any_finite, "the one after that"}};
constexpr Call identify{"theory.identify", "theory.identify{ X0 = 1, X1 = -0.7, X2 = 0.45 }", identify_options};

constexpr Option r_and_zeta[] = {r, zeta};
constexpr Call magnification{"theory.magnification", "theory.magnification{ r = 0.5, zeta = 0.1 }", r_and_zeta};
constexpr Call phase_lag{"theory.phase_lag", "theory.phase_lag{ r = 0.5, zeta = 0.1 }", r_and_zeta};
constexpr Option linearised_options[] = {r, friction_ratio, zeta};
constexpr Call linearised{"theory.linearised", "theory.linearised{ r = 0.5, friction_ratio = 0.1 }",
                          linearised_options};

constexpr Option den_hartog_options[] = {sliding_r, friction_ratio, zeta, breakaway_ratio};
constexpr Call den_hartog{"theory.den_hartog", "theory.den_hartog{ r = 0.75, friction_ratio = 0.5 }",
                          den_hartog_options};
constexpr Call den_hartog_fundamental{"theory.den_hartog_fundamental",
                                      "theory.den_hartog_fundamental{ r = 0.75, friction_ratio = 0.5 }",
                                      den_hartog_options};

constexpr Option stop_boundary_options[] = {
    sliding_r, zeta, {"Re_over_Rd", "", "1", at_least_one, "breakaway over kinetic friction"}};
constexpr Call stop_boundary{"theory.stop_boundary", "theory.stop_boundary{ r = 0.75, zeta = 0.1 }",
                             stop_boundary_options};

constexpr Option step_limit_options[] = {system};
constexpr Call step_limit{"theory.step_limit", "theory.step_limit{ system = sys }", step_limit_options};

}  // namespace theory_options

// ---- arguments and results

/// The result where a closed form does not hold: nil for numbers, nan in a vector.
constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// A number or a vector of numbers.
class Quantity {
public:
    explicit Quantity(double number) : Quantity(std::vector{number}) {}
    explicit Quantity(std::vector<double> values)
        : values_(std::make_shared<const std::vector<double>>(std::move(values))) {}
    double operator[](std::size_t i) const { return (*values_)[values_->size() == 1 ? 0 : i]; }

private:
    std::shared_ptr<const std::vector<double>> values_;
};

/// The option `system`. Raises an error if no closed form applies to it.
model::Oscillator asked_system(const lua::Options& options) {
    model::Oscillator system = options.value_or_fail(oscillator_of(**options.object<SystemHandle>("system")));
    const model::Friction& friction = system.friction();
    const char* lacks = !system.has_spring() ? "need a spring, and this system has k = 0"
                        : system.walls()     ? "do not include walls; simulate this system"
                        : !system.spring().none()
                            ? "include only the spring k theta, and this system has a second spring; simulate it"
                        : !friction.none() && friction.as<model::laws::Coulomb>() == nullptr
                            ? "include only Coulomb friction with one Rd and one Re; simulate this system"
                            : nullptr;
    if (lacks != nullptr) options.fail("system", "the closed forms {}", lacks);
    return system;
}

class TheoryArguments {
public:
    TheoryArguments(lua_State* L, const text::Call& call) : L_(L), call_(call), options_(L, 1, call) {
        luaL_checkstack(L, 10, "too many values");
    }

    const lua::Options& options() const { return options_; }

    /// A number or a vector within the range of its row. Vectors and tables must have equal lengths. A nan in a vector
    /// is accepted, with the result nan. An absent option has its default, a number or another option.
    Quantity quantity(std::string_view name) {
        if (options_.has(name)) {
            return given(name);
        }
        const char* otherwise = options_.row(name).otherwise;
        if (otherwise == text::needed) {
            options_.missing(name);
        }
        double number = 0;
        const auto read = std::from_chars(otherwise, otherwise + std::strlen(otherwise), number);
        return read.ptr != otherwise ? Quantity(number) : quantity(otherwise);
    }

    /// All options, for calls with numbers only.
    template <std::size_t n>
    std::array<Quantity, n> quantities() {
        return quantities(std::make_index_sequence<n>());
    }

    /// Raises "CALL: NAME[i] = VALUE MUST" for element i from 0 (without [i] if NAME is a number).
    [[noreturn]] void refuse(std::string_view name, std::size_t i, double value, std::string_view must) const {
        options_.push(name);
        const bool is_number = lua_type(L_, -1) == LUA_TNUMBER || lua_isnil(L_, -1);
        const std::string element = is_number ? "" : fmt::format("[{}]", i + 1);
        options_.fail(name, "{}{} = {:.6g} {}", name, element, value, must);
    }

    /// Pushes f(i), an array of results, for each element i from 0: numbers if all options are numbers, otherwise
    /// vectors.
    template <class Function>
    int push_results(Function f) const {
        constexpr std::size_t count = std::tuple_size_v<decltype(f(0))>;
        std::array<std::vector<double>, count> columns;
        for (auto& column : columns) column.resize(size_, no_value);
        for (std::size_t i = 0; i < size_; ++i) {
            if (lua::interrupt_requested()) lua::raise_interrupted(L_);
            if (has_nan(i)) continue;
            const auto results = f(i);
            for (std::size_t j = 0; j < count; ++j) columns[j][i] = results[j];
        }
        for (auto& column : columns) {
            if (!sized_by_.empty()) {
                lua::push_vector(L_, std::move(column));
            } else if (std::isnan(column[0])) {
                lua_pushnil(L_);
            } else {
                lua_pushnumber(L_, column[0]);
            }
        }
        return static_cast<int>(count);
    }
    /// The same for a single result.
    template <class Function>
    int push_result(Function f) const {
        return push_results([&](std::size_t i) { return std::array{static_cast<double>(f(i))}; });
    }

private:
    template <std::size_t... i>
    std::array<Quantity, sizeof...(i)> quantities(std::index_sequence<i...> /*places*/) {
        return {quantity(call_.options[i].name)...};
    }

    Quantity given(std::string_view name) {
        options_.push(name);
        const bool number = lua_type(L_, -1) == LUA_TNUMBER;
        if (!number && !lua_istable(L_, -1) && lua::test<lua::Vector>(L_, -1) == nullptr) {
            options_.wrong(name, "a finite number or a vector");
        }
        std::vector<double> values =
            number ? std::vector{options_.number(name)} : lua::numbers_with_gaps_at(L_, -1, options_.call(), name);
        lua_pop(L_, 1);
        if (!number) {
            check_size(name, values.size());
            check(name, options_.row(name).range, values);
        }
        return quantities_.emplace_back(std::move(values));
    }

    bool has_nan(std::size_t i) const {
        return std::ranges::any_of(quantities_, [&](const Quantity& x) { return std::isnan(x[i]); });
    }

    void check_size(std::string_view name, std::size_t size) {
        if (!sized_by_.empty() && size != size_) {
            options_.fail(name, "{} and {} have {} and {} numbers; they must be equally long", sized_by_, name, size_,
                          size);
        }
        size_ = size;
        sized_by_ = name;
    }

    void check(std::string_view name, const text::Range& range, std::span<const double> values) const {
        const auto bad = std::ranges::find_if(values, [&](double x) { return !std::isnan(x) && !range.holds(x); });
        if (bad != values.end()) {
            refuse(name, static_cast<std::size_t>(bad - values.begin()), *bad, fmt::format("must {}", range.must));
        }
    }

    lua_State* L_;
    const text::Call& call_;
    lua::Options options_;
    std::vector<Quantity> quantities_;
    std::size_t size_ = 1;
    std::string_view sized_by_;  // the first option that is a vector
};

/// theory.NAME for a function that takes the call's options as numbers, in their order, and returns a number or an
/// array.
template <const text::Call& call, auto function>
int closed_form(lua_State* L) {
    TheoryArguments arguments(L, call);
    const auto quantities = arguments.quantities<call.options.size()>();
    return arguments.push_results([&](std::size_t i) {
        const auto result = std::apply([i](const auto&... quantity) { return function(quantity[i]...); }, quantities);
        if constexpr (std::is_arithmetic_v<std::decay_t<decltype(result)>>) {
            return std::array{static_cast<double>(result)};
        } else {
            return result;
        }
    });
}

// ---- functions of more than one formula

namespace theory_functions {

using namespace theory;
namespace options = theory_options;

/// The free motions that start at t = 0 with the options system, theta0 and velocity0.
class Starts {
public:
    explicit Starts(TheoryArguments& arguments)
        : system_(asked_system(arguments.options())),
          theta0_(arguments.quantity("theta0")),
          velocity0_(arguments.quantity("velocity0")) {}
    FreeMotion operator[](std::size_t i) const { return {system_, {theta0_[i], velocity0_[i]}}; }
    bool slow_down_by_friction() const { return !system_.friction().none(); }

private:
    model::Oscillator system_;
    Quantity theta0_, velocity0_;
};

/// The number of extremes that extremes{...} returns.
double asked_count(const lua::Options& options, std::optional<double> count, const FreeMotion& motion) {
    constexpr double most = 1e7;
    const double all = motion.extremes();
    if (!count && std::isinf(all)) {
        options.fail("count", "count is needed, because this motion never comes to rest");
    }
    if (!count && all > most) {
        options.fail("count", "count is needed, because there are {:.6g} extremes until rest", all);
    }
    return std::min(count.value_or(all), all);
}

int free_response(lua_State* L) {
    TheoryArguments arguments(L, options::free_response);
    const Quantity t = arguments.quantity("t");
    const Starts starts(arguments);
    return arguments.push_results([&](std::size_t i) {
        if (t[i] < 0 && starts.slow_down_by_friction()) {
            arguments.refuse("t", i, t[i],
                             "must not be negative: with dry friction the past of a motion is not determined");
        }
        const model::State state = starts[i].at(t[i]);
        return std::array{state.theta, state.velocity};
    });
}

int extremes(lua_State* L) {
    const lua::Options table(L, 1, options::extremes);
    const model::Oscillator system = asked_system(table);
    options::ExtremesOptions asked;
    table.fill(asked);
    const FreeMotion motion(system, {asked.theta0, asked.velocity0});
    const auto n = static_cast<std::size_t>(asked_count(table, asked.count, motion));
    std::vector<double> times(n), angles(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Extreme extreme = motion.extreme(static_cast<double>(i));
        times[i] = extreme.t;
        angles[i] = extreme.theta;
    }
    lua::push_vector(L, std::move(times));
    lua::push_vector(L, std::move(angles));
    return 2;
}

int time_to_rest(lua_State* L) {
    TheoryArguments arguments(L, options::time_to_rest);
    const Starts starts(arguments);
    return arguments.push_result([&](std::size_t i) { return starts[i].time_to_rest(); });
}

int rest_position(lua_State* L) {
    TheoryArguments arguments(L, options::rest_position);
    const Starts starts(arguments);
    return arguments.push_result([&](std::size_t i) { return starts[i].rest_position().value_or(no_value); });
}

std::array<double, 2> identify(double X0, double X1, double X2) {
    const auto found = theory::identify(X0, X1, X2);
    return found ? std::array{found->zeta, found->friction_shift} : std::array{no_value, no_value};
}

/// den_hartog{...} and den_hartog_fundamental{...}: amplitude and lag of the motion.
template <const text::Call& call, auto amplitude, auto lag>
int sliding_motion(lua_State* L) {
    TheoryArguments arguments(L, call);
    const auto given = arguments.quantities<4>();
    return arguments.push_results([&](std::size_t i) {
        const auto& [r, gamma, zeta, Re] = given;
        if (Re[i] < gamma[i]) {
            arguments.refuse("breakaway_ratio", i, Re[i],
                             fmt::format("must be at least friction_ratio = {}", gamma[i]));
        }
        const auto motion = DenHartog(r[i], zeta[i]).motion(gamma[i], Re[i]);
        return motion ? std::array{(*motion).*amplitude, (*motion).*lag} : std::array{no_value, no_value};
    });
}

std::array<double, 2> linearised(double r, double friction_ratio, double zeta) {
    const auto motion = linearised_friction(r, zeta, friction_ratio);
    return motion ? std::array{motion->amplitude, motion->lag} : std::array{no_value, no_value};
}

double stop_boundary(double r, double zeta, double factor) {
    return DenHartog(r, zeta).stop_boundary(factor);
}

int step_limit(lua_State* L) {
    const lua::Options table(L, 1, options::step_limit);
    lua_pushnumber(L, motion::rk4::stability_limit(asked_system(table)));
    return 1;
}

}  // namespace theory_functions

// ---- the members

namespace f = theory_functions;
namespace o = theory_options;

/// The member theory.NAME with the options of the call.
template <const text::Call& call, lua_CFunction function>
constexpr lua::Member row(const char* signature, const char* summary, const char* sample) {
    return {lua::a_function<function>, {signature, summary, sample, {&call}}};
}
template <const text::Call& call, auto function>
constexpr lua::Member formula(const char* signature, const char* summary, const char* sample) {
    return row<call, closed_form<call, function>>(signature, summary, sample);
}

constexpr lua::Member theory_module_members[] = {
    row<o::free_response, f::free_response>(
        "theory.free_response{ OPTIONS } -> theta, velocity",
        "The free motion at the times t, from theta0 (rad) and velocity0 (rad per time unit) at t = 0: exact at any "
        "damping, and with the dry friction of the system.",
        "sys = nondimensional{ friction_ratio = 0.167 }\n"
        "print(string.format(\"%.9f %.1f\", theory.free_response{ system = sys, velocity0 = 2*math.pi, t = 5 }))\n"
        "--> 0.155151392 0.0"),
    row<o::extremes, f::extremes>(
        "theory.extremes{ OPTIONS } -> t, theta",
        "The times and angles at which the velocity of a free motion is zero, by the half-cycle map: two vectors; "
        "the last is the place of rest. If the motion starts with velocity 0, the start is the first.",
        "sys = nondimensional{ friction_ratio = 0.1 }\n"
        "print(theory.extremes{ system = sys, theta0 = 0.55 })  --> vector{ 0, 0.5, 1, 1.5 }\t"
        "vector{ 0.55, -0.35, 0.15, 0.05 }"),
    row<o::time_to_rest, f::time_to_rest>(
        "theory.time_to_rest{ OPTIONS } -> number or vector",
        "The time when a free motion ends; math.huge if it never stops (no dry friction, or an overdamped creep).",
        "sys = nondimensional{ friction_ratio = 0.167 }\n"
        "print(string.format(\"%.9f\", theory.time_to_rest{ system = sys, velocity0 = 2*math.pi }))  --> 1.723664157"),
    row<o::rest_position, f::rest_position>(
        "theory.rest_position{ OPTIONS } -> number or nil, or vector",
        "The place of rest of a free motion, or its limit (rad); nil, or nan in a vector, if it "
        "swings for ever.",
        "sys = nondimensional{ friction_ratio = 0.1 }\n"
        "print(theory.rest_position{ system = sys, theta0 = { 0.05, 0.15, 1.05 } })  --> vector{ 0.05, 0.05, -0.05 }"),
    formula<o::logarithmic_decrement, theory::logarithmic_decrement>(
        "theory.logarithmic_decrement{ OPTIONS } -> number or vector",
        "ln(X0/X2) of extremes a full cycle apart, by viscous damping alone: 2 pi zeta/sqrt(1 - zeta^2), zeta < 1.",
        "print(string.format(\"%.6f\", theory.logarithmic_decrement{ zeta = 0.119 }))  --> 0.753050"),
    formula<o::identify, f::identify>(
        "theory.identify{ OPTIONS } -> zeta, x_f",
        "Both dampings from three successive extremes of a free motion (signs do not count), rest not among them: q "
        "= (X1 - X2)/(X0 - X1), zeta/sqrt(1 - zeta^2) = -(ln q)/pi, x_f = Rd/k = (q X0 - X1)/(1 + q). nil unless X0 "
        "> X1 > X2. A negative result means that the extremes are too inaccurate to tell this damping from none.",
        "t, X = theory.extremes{ system = nondimensional{ zeta = 0.119, friction_ratio = 0.06 }, theta0 = 1 }\n"
        "print(string.format(\"%.6f %.6f\", theory.identify{ X0 = X[1], X1 = X[2], X2 = X[3] }))"
        "  --> 0.119000 0.060000"),
    formula<o::magnification, theory::magnification>(
        "theory.magnification{ OPTIONS } -> number or vector",
        "The steady amplitude under M0 sin(omega t) without dry friction, in units of M0/k: 1/sqrt((1 - r^2)^2 + 4 "
        "zeta^2 r^2), r = omega/omega0. math.huge at r = 1 without damping.",
        "print(theory.magnification{ r = { 0, 0.5, 2 } })  --> vector{ 1, 1.33333, 0.333333 }"),
    formula<o::phase_lag, theory::phase_lag>(
        "theory.phase_lag{ OPTIONS } -> number or vector",
        "The lag of that motion behind its load, rad: atan2(2 zeta r, 1 - r^2), from 0 to pi; pi/2 at r = 1.",
        "print(theory.phase_lag{ r = { 0.5, 1, 2 }, zeta = 0.1 })  --> vector{ 0.132552, 1.5708, 3.00904 }"),
    formula<o::linearised, f::linearised>(
        "theory.linearised{ OPTIONS } -> amplitude, lag",
        "The steady motion with dry friction replaced by its equivalent damping, added to zeta: amplitude in units of "
        "M0/k, sqrt(1 - (4 gamma/pi)^2)/|1 - r^2| for zeta = 0, and lag in rad. For small gamma only; theory.den_hartog "
        "is exact. nil, or nan in a vector, from gamma = pi/4 on.",
        "print(string.format(\"%.4f %.4f\", theory.linearised{ r = 1.35, friction_ratio = 0.5 }))  --> 0.9376 2.4515"),
    row<o::den_hartog,
        f::sliding_motion<o::den_hartog, &theory::SlidingMotion::amplitude, &theory::SlidingMotion::lag>>(
        "theory.den_hartog{ OPTIONS } -> amplitude, lag",
        "The exact steady motion under M0 sin(omega t) with dry friction and without stops (Den Hartog 1931): amplitude "
        "in units of M0/k and lag of its peak in rad; r = omega/omega0, friction_ratio = Rd/M0, breakaway_ratio = Re/M0. "
        "nil, or nan in a vector, beyond theory.stop_boundary, where the mass stops in each cycle. At r = 1 with "
        "zeta = 0 the motion grows without bound: math.huge and pi/2. At r = 1/2, 1/4, ... with zeta = 0 the steady "
        "motion depends on its start; this is the symmetric one of them. r is 0 or from 0.0001 to 1e6.",
        "print(string.format(\"%.9f %.4f\", theory.den_hartog{ r = 0.75, friction_ratio = 0.5 }))"
        "  --> 1.972601445 0.5296\n"
        "print(theory.den_hartog{ r = { 0.75, 0.75 }, friction_ratio = { 0.7, 0.8 } })\n"
        "--> vector{ 1.61591, nan }\tvector{ 0.785606, nan }"),
    row<o::den_hartog_fundamental,
        f::sliding_motion<o::den_hartog_fundamental, &theory::SlidingMotion::fundamental_amplitude,
                          &theory::SlidingMotion::fundamental_lag>>(
        "theory.den_hartog_fundamental{ OPTIONS } -> "
        "amplitude, lag",
        "The fundamental of that motion: amplitude in units of M0/k and lag in rad.",
        "amplitude, lag = theory.den_hartog_fundamental{ r = 1.35, friction_ratio = 0.5 }\n"
        "print(string.format(\"%.4f, %.2f degrees\", amplitude, math.deg(lag)))  --> 0.8649, 140.69 degrees"),
    formula<o::stop_boundary, f::stop_boundary>(
        "theory.stop_boundary{ OPTIONS } -> number or vector",
        "The friction ratio Rd/M0 up to which the steady motion under M0 sin(omega t) "
        "has no stops; r is 0 or from 0.0001 to 1e6.",
        "print(theory.stop_boundary{ r = { 0.5, 1, 3 } })  --> vector{ 0.333333, 0.785398, 0.5625 }"),
    row<o::step_limit, f::step_limit>(
        "theory.step_limit{ OPTIONS } -> number",
        "The greatest step (time units), beyond which integrator.rk4 amplifies a free motion.",
        "print(string.format(\"%.4f\", theory.step_limit{ system = nondimensional{ zeta = 0.02387 } }))  --> 0.4573"),
};

}  // namespace

const lua::Class theory_module = {
    "theory",
    {"theory.NAME{ ... } -> numbers or vectors",
     "Closed forms to compare a run with. Any number may be a vector or a table of numbers; the results are then "
     "vectors. Where a formula does not hold, the result is nil, or nan in a vector. docs/theory.md has the "
     "formulas. For a system under M0 sin(omega t): r = omega/sys.omega0, zeta = sys.zeta, friction_ratio = "
     "sys:friction_ratio(M0).",
     "r = vector.linspace(0.5, 2, 4)\n"
     "print(theory.magnification{ r = r, zeta = 0.1 })  --> vector{ 1.32164, 5, 0.77791, 0.330409 }"},
    theory_module_members,
    lua::add_module};

}  // namespace dinal::api
