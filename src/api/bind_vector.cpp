// The class of vectors: arithmetic, mathematics and queries; and the module `vector`, which makes them: evenly spaced
// and random numbers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "api/cards.hpp"
#include "api/classes.hpp"
#include "errors/error_remarks.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/memory_limit.hpp"
#include "lua/options.hpp"
#include "lua/values.hpp"
#include "lua/vector.hpp"
#include "motion/clock.hpp"
#include "text/words.hpp"

namespace dinal::api::vectors {
namespace {

using lua::Vector;
using Values = std::span<const double>;

using Numbers = std::vector<double>;  // used for new vectors
using text::Error;
using text::Expected;

Error unequal_sizes(std::size_t n, std::size_t m) {
    return {fmt::format("the vectors have {} and {} numbers; they must be equally long", n, m)};
}

/// Calls work(i) for i < n; checks for a stop in between.
template <class Work>
void for_each_index(lua_State* L, std::size_t n, Work work) {
    constexpr std::size_t block = std::size_t{1} << 16U;
    for (std::size_t begin = 0; begin < n; begin += block) {
        if (lua::interrupt_requested()) lua::raise_interrupted(L);
        const std::size_t end = std::min(n, begin + block);
        for (std::size_t i = begin; i < end; ++i) work(i);
    }
}

// ---- families of methods: f of each element, of all elements, of two vectors

template <auto f>
Numbers of_each(lua_State* L, const Vector& v) {
    Numbers result = lua::new_numbers(L, v.size());
    for_each_index(L, v.size(), [&](std::size_t i) { result[i] = f(v.begin()[i]); });
    return result;
}

/// A value computed from at least `least` elements.
template <auto f, std::size_t least = 1>
auto of_all(const Vector& v) -> Expected<decltype(f(Values()))> {
    if (v.size() < least) return Error{least == 1 ? "the vector is empty" : "two numbers are needed at least"};
    return f(v.values());
}

/// A vector of equal length filled by f.
template <auto f>
Numbers filled(lua_State* L, const Vector& v) {
    Numbers result = lua::new_numbers(L, v.size());
    f(v.values(), result);
    return result;
}

/// The text of an operator, for errors.
struct Symbol {
    char text[8] = {};
    template <std::size_t n>
    constexpr Symbol(const char (&words)[n]) {  // NOLINT(google-explicit-constructor)
        std::copy_n(words, n, text);
    }
};

/// One side of an operator: a vector, or a number repeated to the other's length.
struct Operand {
    const Vector* vector = nullptr;
    double number = 0;
    double operator[](std::size_t i) const { return vector != nullptr ? vector->begin()[i] : number; }
};

struct Operands {
    Operand a, b;
    std::size_t size;
};

Operands operands(lua_State* L, const char* symbol) {
    const auto at = [&](int index) -> Operand {
        if (const auto* vector = lua::test<Vector>(L, index)) return {vector};
        if (lua_type(L, index) != LUA_TNUMBER) {
            lua::raise(L, "a vector {} {} is not possible; the other side must be a number or a vector", symbol,
                       lua::describe(L, index));
        }
        return {nullptr, lua_tonumber(L, index)};
    };
    const Operand a = at(1), b = at(2);
    if (a.vector != nullptr && b.vector != nullptr && a.vector->size() != b.vector->size()) {
        lua::raise(L, "the vectors in v {} w have {} and {} numbers; they must be equally long", symbol,
                   a.vector->size(), b.vector->size());
    }
    if (a.vector == nullptr && b.vector == nullptr) {  // possible only through debug.getmetatable
        lua::raise(L, "x {} y of vectors needs a vector on one side", symbol);
    }
    return {a, b, (a.vector != nullptr ? a : b).vector->size()};
}

template <Symbol symbol, auto f>
int combined(lua_State* L) {
    const Operands of = operands(L, symbol.text);
    std::vector<double> result = lua::new_numbers(L, of.size);
    for_each_index(L, of.size, [&](std::size_t i) { result[i] = f(of.a[i], of.b[i]); });
    return lua::push_vector(L, std::move(result));
}

// Lua converts the result of v > 0 to true or false. To support v[v > 0], the comparison is stored here with its script
// line; v[true] in that line refers to it.
struct Comparison {
    const void* function = nullptr;
    int line = 0;
    int count = 0;  // comparisons by this line since the last v[...]
    bool all = false;
    std::vector<bool> mask = {};
};
thread_local Comparison last_comparison;
const char comparing_function = 0;  // registry key: keeps the function alive while its address is compared

std::pair<const void*, int> running_line(lua_State* L) {
    lua_Debug caller{};
    if (lua_getstack(L, 1, &caller) == 0 || lua_getinfo(L, "lf", &caller) == 0) return {nullptr, 0};
    const void* function = lua_topointer(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &comparing_function);
    return {function, caller.currentline};
}

bool is_upvalue(lua_State* L, lua_Debug& caller, std::string_view wanted) {
    lua_getinfo(L, "f", &caller);
    bool found = false;
    for (int i = 1; const char* name = lua_getupvalue(L, -1, i); ++i) {
        found = found || name == wanted;
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return found;
}

/// Returns why v[v > 0] is unreliable in this statement; "" if it is reliable. `and` and `or` skip the second
/// comparison, so the mask would be the first's. Lua before 5.4.7 compiles v[v > 0] wrongly if v is an upvalue: it
/// indexes another register.
std::string fault_of_mask(lua_State* L, lua_Debug& caller, std::string_view statement) {
    const lua::Tokens all = lua::tokens(statement);
    int depth = 0;
    bool compares = false, joins = false;
    std::string_view owner;
    for (std::size_t i = 0; i < all.size(); ++i) {
        depth += all[i].is("[") ? 1 : all[i].is("]") ? -1 : 0;
        if (all[i].is("[") && depth == 1) {
            compares = joins = false;
            const bool alone = i > 0 && (i < 2 || !(all[i - 2].is(".") || all[i - 2].is(":")));
            owner = alone ? all[i - 1].text : std::string_view();
        }
        if (depth == 0) continue;
        compares = compares || all[i].is("<") || all[i].is(">") || all[i].is("<=") || all[i].is(">=");
        joins = joins || all[i].is("and") || all[i].is("or");
        if (compares && joins) return "and or or is not possible there";
        if (compares && is_upvalue(L, caller, owner)) {
            return fmt::format("{0} belongs to an outer function: write local own = {0} before, and own[...]", owner);
        }
    }
    return "";
}

/// The same for the running line, cached for the last line.
std::string fault_of_mask_here(lua_State* L, const void* function) {
    thread_local std::pair<const void*, int> known;
    thread_local std::string fault;
    lua_Debug caller{};
    if (lua_getstack(L, 1, &caller) == 0 || lua_getinfo(L, "Sl", &caller) == 0) return "";
    if (known != std::pair(function, caller.currentline)) {
        const auto source = errors::source_of_frame(L, caller);
        fault = source ? fault_of_mask(L, caller, source->statement(caller.currentline)) : "";
        known = {function, caller.currentline};
    }
    return fault;
}

int masked(lua_State* L) {
    const lua::Vector& v = *lua::test<lua::Vector>(L, 1);
    const auto [function, line] = running_line(L);
    const bool known =
        last_comparison.function == function && last_comparison.line == line && last_comparison.count == 1;
    last_comparison.count = 0;
    if (const std::string fault = fault_of_mask_here(L, function); !fault.empty()) {
        lua::raise(L, {.sentence = "v[v > 0]: " + fault, .call = "v"});
    }
    if (!known || last_comparison.mask.size() != v.size()) {
        lua::raise(L,
                   {.sentence = "v[v > 0] takes one comparison (< <= > >=) with as many elements as v, written in the "
                                "brackets; for more use v[v:find(function(x) return x > 0 and x < 1 end)]",
                    .call = "v"});
    }
    const bool wanted = (lua_toboolean(L, 2) != 0) == last_comparison.all;  // false for v[not (v > 0)]
    lua::make_room(L, v.size() * sizeof(double));
    std::vector<double> result;
    for (std::size_t i = 0; i < v.size(); ++i) {
        if (last_comparison.mask[i] == wanted) result.push_back(v.begin()[i]);
    }
    return lua::push_vector(L, std::move(result));
}

/// Pushes whether the relation holds for every element.
template <Symbol symbol, auto f>
int holds(lua_State* L) {
    const Operands of = operands(L, symbol.text);
    lua::make_room(L, of.size / 8 + 1);
    std::vector<bool> mask(of.size);
    for (std::size_t i = 0; i < of.size; ++i) mask[i] = f(of.a[i], of.b[i]);
    const bool all = !text::contains(mask, false);
    const auto [function, line] = running_line(L);
    const bool again = function == last_comparison.function && line == last_comparison.line;
    last_comparison = {function, line, again ? last_comparison.count + 1 : 1, all, std::move(mask)};
    lua_pushboolean(L, all ? 1 : 0);
    return 1;
}

// ---- sums and extremes

double sum_of(Values v) {
    motion::AccurateSum sum;
    for (const double x : v) sum.add(x);
    return sum.value();
}

double mean_of(Values v) {
    return sum_of(v) / static_cast<double>(v.size());
}

/// The greatest element, or for sign -1 the least; nan if there is any.
template <int sign>
double extreme(Values v) {
    double best = v.front();
    for (const double x : v) {
        if (sign * x > sign * best || std::isnan(x)) best = x;
    }
    return best;
}

/// The index from 1 of the extreme, ignoring nan.
template <int sign>
std::size_t place_of_extreme(Values v) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < v.size(); ++i) {
        if (sign * v[i] > sign * v[best] || std::isnan(v[best])) best = i;
    }
    return best + 1;
}

/// Welford's recurrence avoids the difference of large sums.
double deviation(Values v) {
    double mean = 0, squares = 0, n = 0;
    for (const double x : v) {
        const double off = x - mean;
        mean += off / ++n;
        squares += off * (x - mean);
    }
    return std::sqrt(squares / (n - 1));
}

void cumulate(Values v, std::vector<double>& sums) {
    motion::AccurateSum sum;
    for (std::size_t i = 0; i < v.size(); ++i) {
        sum.add(v[i]);
        sums[i] = sum.value();
    }
}

void subtract_previous(Values v, std::vector<double>& result) {
    if (!v.empty()) result.pop_back();
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = v[i + 1] - v[i];
}

void sort(Values v, std::vector<double>& result) {
    std::ranges::copy(v, result.begin());
    std::ranges::sort(result, [](double a, double b) { return std::isnan(b) ? !std::isnan(a) : a < b; });
}

// ---- methods with an argument

/// Pushes f(x, i).
void push_result_of(lua_State* L, double x, std::size_t i) {
    lua_pushvalue(L, 2);
    lua_pushnumber(L, x);
    lua_pushinteger(L, static_cast<lua_Integer>(i) + 1);
    lua_call(L, 2, 1);
}

Expected<Numbers> map(lua_State* L, const Vector& v, lua::Callable /*f*/) {
    Numbers result = lua::new_numbers(L, v.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
        push_result_of(L, v.begin()[i], i);
        if (!lua_isboolean(L, -1) && lua_type(L, -1) != LUA_TNUMBER) {
            return text::error("f must return a number, true or false, but f({:.6g}) is {}", v.begin()[i],
                               lua::describe(L, -1));
        }
        result[i] = lua_isboolean(L, -1) ? static_cast<double>(lua_toboolean(L, -1)) : lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
    return result;
}

Numbers find(lua_State* L, const Vector& v, lua::Callable /*f*/) {
    Numbers places;
    for (std::size_t i = 0; i < v.size(); ++i) {
        push_result_of(L, v.begin()[i], i);
        if (lua_toboolean(L, -1) != 0) places.push_back(static_cast<double>(i + 1));
        lua_pop(L, 1);
    }
    return places;
}

Expected<double> quantile(const Vector& v, double p) {
    if (!(p >= 0 && p <= 1)) return text::error("p = {:.6g} must lie between 0 and 1", p);
    if (v.size() == 0) return Error{"the vector is empty"};
    Numbers values(v.begin(), v.end());
    if (std::ranges::any_of(values, [](double x) { return std::isnan(x); })) return std::nan("");
    const double place = p * static_cast<double>(values.size() - 1), below = std::floor(place);
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(below);
    std::nth_element(values.begin(), nth, values.end());
    double value = *nth;
    if (place > below) value += (place - below) * (*std::min_element(nth + 1, values.end()) - value);
    return value;
}

Expected<Numbers> interpolated(lua_State* L, const Vector& v, const Vector& x, const Vector& y) {
    if (x.size() != y.size()) return unequal_sizes(x.size(), y.size());
    if (x.size() == 0) return Error{"there are no points"};
    const auto* const step = std::adjacent_find(x.begin(), x.end(), [](double a, double b) { return !(a < b); });
    if (step != x.end()) {
        return text::error("x[{}] = {} is not after x[{}] = {}; x must increase", step - x.begin() + 2, step[1],
                           step - x.begin() + 1, *step);
    }
    Numbers result = lua::new_numbers(L, v.size());
    std::ranges::transform(v, result.begin(), [&](double at) {
        if (std::isnan(at)) return at;
        const auto i = static_cast<std::size_t>(std::ranges::upper_bound(x, at) - x.begin());
        if (i == 0) return y.begin()[0];
        if (i == x.size()) return y.begin()[i - 1];
        const double* const a = x.begin() + i - 1;
        const double* const b = y.begin() + i - 1;
        return b[0] + (b[1] - b[0]) * ((at - a[0]) / (a[1] - a[0]));
    });
    return result;
}

int joined(lua_State* L) {
    std::vector<double> all;
    for (const int index : {1, 2}) {
        if (const auto* vector = lua::test<Vector>(L, index)) {
            lua::make_room(L, (all.size() + vector->size()) * sizeof(double));
            all.insert(all.end(), vector->begin(), vector->end());
        } else if (lua_type(L, index) == LUA_TNUMBER) {
            all.push_back(lua_tonumber(L, index));
        } else {
            lua::raise(L, "a vector .. {} is not possible; the other side must be a number or a vector{}",
                       lua::describe(L, index), lua_type(L, index) == LUA_TSTRING ? " (tostring(v) is its text)" : "");
        }
    }
    return lua::push_vector(L, std::move(all));
}

int pick(lua_State* L) {
    const Vector& v = *lua::test<Vector>(L, 1);
    const Vector& w = *lua::test<Vector>(L, 2);
    const bool mask = w.size() == v.size() && std::ranges::all_of(w, [](double x) { return x == 0 || x == 1; });
    std::vector<double> picked;
    for (std::size_t i = 0; i < w.size(); ++i) {
        const double x = w.begin()[i];
        if (mask) {
            if (x == 1) picked.push_back(v.begin()[i]);
            continue;
        }
        if (x != std::floor(x) || !(x >= 1 && x <= static_cast<double>(v.size()))) {
            lua::raise(L,
                       "v[w]: w[{}] = {:.6g} is not an index of a vector of {} numbers; a w of 0 and 1 must be as long "
                       "as v",
                       i + 1, x, v.size());
        }
        picked.push_back(v.begin()[static_cast<std::size_t>(x) - 1]);
    }
    return lua::push_vector(L, std::move(picked));
}

Expected<double> dot(const Vector& v, const Vector& w) {
    if (v.size() != w.size()) return unequal_sizes(v.size(), w.size());
    motion::AccurateSum sum;
    for (std::size_t i = 0; i < v.size(); ++i) sum.add(v.begin()[i] * w.begin()[i]);
    return sum.value();
}

int arctangent(lua_State* L) {
    if (lua_isnoneornil(L, 2)) {
        lua_settop(L, 1);
        lua_pushnumber(L, 1);
    }
    return combined<"atan", [](double a, double b) { return std::atan2(a, b); }>(L);
}

int equal(lua_State* L) {
    const auto* a = lua::test<Vector>(L, 1);
    const auto* b = lua::test<Vector>(L, 2);
    lua_pushboolean(L, a != nullptr && b != nullptr && std::ranges::equal(*a, *b) ? 1 : 0);
    return 1;
}

// ---- elements

int element(lua_State* L) {
    const auto* v = lua::test<Vector>(L, 1);
    int is_integer = 0;
    const lua_Integer i = lua_tointegerx(L, 2, &is_integer);
    if (v != nullptr && lua::test<Vector>(L, 2) != nullptr) {
        return pick(L);
    }
    if (v != nullptr && lua_isboolean(L, 2)) {
        return masked(L);
    }
    if (v == nullptr || lua_type(L, 2) != LUA_TNUMBER) {
        return 0;
    }
    if (is_integer != 0 && i < 0) {
        lua::raise(
            L, {.sentence = fmt::format("v[{}]: elements are counted from 1; the last one is v[#v]", i), .call = "v"});
    }
    const bool there = is_integer != 0 && i >= 1 && i <= static_cast<lua_Integer>(v->size());
    there ? lua_pushnumber(L, v->begin()[i - 1]) : lua_pushnil(L);
    return 1;
}

Expected<Numbers> slice(lua_State* L, const Vector& v, std::optional<lua_Integer> from, std::optional<lua_Integer> to,
                        std::optional<lua_Integer> every) {
    const auto n = static_cast<lua_Integer>(v.size());
    const lua_Integer first = from.value_or(1), last = to.value_or(n), step = every.value_or(1);
    if (first < 1 || last > n || step < 1) {
        return text::error("the vector has elements 1 to {}, and step must be at least 1", n);
    }
    lua::make_room(L, v.size() * sizeof(double));
    Numbers result;
    for (lua_Integer i = first; i <= last; i += std::min(step, n)) result.push_back(v.begin()[i - 1]);
    return result;
}

// ---- the class

constexpr lua::Member vector_members[] = {
    {lua::a_typed_method<of_each<[](double x) { return std::sin(x); }>>,
     {"v:sin() -> vector", "Sine of every element (rad).", "print(vector{ 0, 1 }:sin())  --> vector{ 0, 0.841471 }"}},
    {lua::a_typed_method<of_each<[](double x) { return std::cos(x); }>>,
     {"v:cos() -> vector", "Cosine of every element (rad).", "print(vector{ 0, 1 }:cos())  --> vector{ 1, 0.540302 }"}},
    {lua::a_typed_method<of_each<[](double x) { return std::tan(x); }>>,
     {"v:tan() -> vector", "Tangent of every element (rad).", "print(vector{ 0, 1 }:tan())  --> vector{ 0, 1.55741 }"}},
    {lua::a_typed_method<of_each<[](double x) { return std::fabs(x); }>>,
     {"v:abs() -> vector", "Absolute value of every element.", "print(vector{ -2, 3 }:abs())  --> vector{ 2, 3 }"}},
    {lua::a_typed_method<of_each<[](double x) { return std::sqrt(x); }>>,
     {"v:sqrt() -> vector", "Square root of every element; nan for negative ones.",
      "print(vector{ 4, 9 }:sqrt())  --> vector{ 2, 3 }"}},
    {lua::a_typed_method<of_each<[](double x) { return std::exp(x); }>>,
     {"v:exp() -> vector", "e to the power of every element.",
      "print(vector{ 0, 1 }:exp())  --> vector{ 1, 2.71828 }"}},
    {lua::a_typed_method<of_each<[](double x) { return std::log(x); }>>,
     {"v:log() -> vector", "Natural logarithm of every element; nan for negative ones.",
      "print(vector{ 1, 10 }:log())  --> vector{ 0, 2.30259 }"}},
    {lua::a_typed_method<of_all<extreme<1>>>,
     {"v:max() -> number", "The greatest element.", "print(vector{ 1, 3, 2 }:max())  --> 3.0"}},
    {lua::a_typed_method<of_all<extreme<-1>>>,
     {"v:min() -> number", "The least element.", "print(vector{ 1, 3, -2 }:min())  --> -2.0"}},
    {lua::a_typed_method<of_all<mean_of>>,
     {"v:mean() -> number", "The sum divided by the number of elements.", "print(vector{ 1, 2, 6 }:mean())  --> 3.0"}},
    {lua::a_typed_method<of_all<sum_of, 0>>,
     {"v:sum() -> number", "The sum of all elements (0 when there are none), accurate however many there are.",
      "print(vector{ 1e100, 1, -1e100 }:sum())  --> 1.0"}},
    {lua::a_typed_method<slice>,
     {"v:slice(first = 1, last = #v, step = 1) -> vector", "The elements from first to last, every step-th of them.",
      "print(vector{ 10, 20, 30, 40, 50 }:slice(2, 5, 2))  --> vector{ 20, 40 }"}},
    {lua::a_typed_method<of_all<[](Values v) { return v; }, 0>>,
     {"v:table() -> table", "An ordinary Lua table with the same numbers.",
      "print(table.concat(vector{ 1, 2 }:table(), \" \"))  --> 1.0 2.0"}},
    {lua::a_metamethod<lua::detail::called<of_all<[](Values v) { return v.size(); }, 0>>>("__len"),
     {"#v -> integer", "How many elements there are. v[1] is the first one, v[#v] the last one; beyond them is nil.",
      "print(#vector{ 4, 5, 6 })  --> 3"}},
    {lua::a_metamethod<combined<"+", [](double a, double b) { return a + b; }>>("__add"),
     {"v + w, v + number -> vector", "Element by element; two vectors must be equally long.",
      "print(vector{ 1, 2 } + vector{ 10, 20 })  --> vector{ 11, 22 }"}},
    {lua::a_metamethod<combined<"-", [](double a, double b) { return a - b; }>>("__sub"),
     {"v - w, v - number -> vector", "Element by element.", "print(10 - vector{ 1, 2 })  --> vector{ 9, 8 }"}},
    {lua::a_metamethod<combined<"*", [](double a, double b) { return a * b; }>>("__mul"),
     {"v * w, v * number -> vector", "Element by element.", "print(2 * vector{ 1, 2 })  --> vector{ 2, 4 }"}},
    {lua::a_metamethod<combined<"/", [](double a, double b) { return a / b; }>>("__div"),
     {"v / w, v / number -> vector", "Element by element.", "print(vector{ 1, 2 } / 4)  --> vector{ 0.25, 0.5 }"}},
    {lua::a_metamethod<combined<"^", [](double a, double b) { return b == 2 ? a * a : std::pow(a, b); }>>("__pow"),
     {"v ^ w, v ^ number -> vector", "Element by element.", "print(vector{ 2, 3 } ^ 2)  --> vector{ 4, 9 }"}},
    {lua::a_metamethod<lua::detail::called<of_each<[](double x) { return -x; }>>>("__unm"),
     {"-v -> vector", "Every element with the other sign.", "print(-vector{ 1, -2 })  --> vector{ -1, 2 }"}},
    {lua::a_metamethod<equal>("__eq"),
     {"v == w -> boolean", "True when both have the same elements.",
      "print(vector{ 1, 2 } == vector{ 1, 2 })  --> true"}},
    {lua::a_metamethod<holds<"<", [](double a, double b) { return a < b; }>>("__lt"),
     {"v < w, v < number -> boolean",
      "True when it holds for every element; so v < 3 and v >= 3 can both be false. Also >.",
      "print(vector{ 1, 2 } < 3, vector{ 1, 5 } < 3)  --> true\tfalse"}},
    {lua::a_metamethod<holds<"<=", [](double a, double b) { return a <= b; }>>("__le"),
     {"v <= w, v <= number -> boolean", "True when it holds for every element. Also >=.",
      "print(vector{ 1, 2 } >= 1)  --> true"}},
    {lua::a_text<Vector, [](const Vector& v) { return vector_text(v, 10, 3); }>,
     {"tostring(v) -> string", "The elements to six digits; of a long vector its two ends and its length.",
      "print(vector.linspace(0, 1, 101))  --> vector{ 0, 0.01, 0.02, ..., 0.98, 0.99, 1 }  -- 101 numbers"}},
    {lua::a_typed_method<map>,
     {"v:map(f) -> vector", "f(x, i) for every element x with index i: a number, or true for 1 and false for 0.",
      "print(vector{ 1, 2, 3 }:map(function(x) return 10 * x end))  --> vector{ 10, 20, 30 }"}},
    {lua::a_typed_method<find>,
     {"v:find(f) -> vector", "The indices of the elements x for which f(x, i) is true; v[v:find(f)] has the elements.",
      "print(vector{ 5, 1, 7 }:find(function(x) return x > 3 end))  --> vector{ 1, 3 }"}},
    {lua::a_typed_method<of_all<deviation, 2>>,
     {"v:std() -> number", "The standard deviation: the root of the sum of squares about the mean over #v - 1.",
      "print(vector{ 1, 2, 3 }:std())  --> 1.0"}},
    {lua::a_typed_method<quantile>,
     {"v:quantile(p) -> number",
      "The value below which the fraction p of the elements lies; 0.5 gives the median. Linear between the sorted "
      "elements.",
      "print(vector{ 4, 1, 3, 2 }:quantile(0.5), vector{ 1, 2, 6 }:quantile(1))  --> 2.5\t6.0"}},
    {lua::a_typed_method<of_all<place_of_extreme<1>>>,
     {"v:argmax() -> integer", "The index of the greatest element, the first of equal ones.",
      "print(vector{ 1, 3, 2 }:argmax())  --> 2"}},
    {lua::a_typed_method<of_all<place_of_extreme<-1>>>,
     {"v:argmin() -> integer", "The index of the least element, the first of equal ones.",
      "print(vector{ 1, 3, -2 }:argmin())  --> 3"}},
    {lua::a_typed_method<filled<cumulate>>,
     {"v:cumsum() -> vector", "The sums of the first, the first two, ... of all elements.",
      "print(vector{ 1, 2, 3 }:cumsum())  --> vector{ 1, 3, 6 }"}},
    {lua::a_typed_method<filled<subtract_previous>>,
     {"v:diff() -> vector", "Each element minus the one before it: one number fewer.",
      "print(vector{ 1, 4, 9 }:diff())  --> vector{ 3, 5 }"}},
    {lua::a_typed_method<interpolated>,
     {"v:interp(x, y) -> vector",
      "Linear interpolation at each element through the points x, y; x must increase. Beyond its ends the first "
      "and the last y hold.",
      "print(vector{ 0.5, 1.5, 9 }:interp(vector{ 0, 1, 2 }, vector{ 0, 10, 30 }))  --> vector{ 5, 20, 30 }"}},
    {lua::a_typed_method<dot>,
     {"v:dot(w) -> number", "The sum of the products of elements in the same place.",
      "print(vector{ 1, 2 }:dot(vector{ 3, 4 }))  --> 11.0"}},
    {lua::a_method<arctangent>,
     {"v:atan(w = 1) -> vector", "The angle of each point (w, v), rad, from -pi to pi; w is a vector or a number.",
      "print(vector{ 1, 1 }:atan(vector{ 1, -1 }))  --> vector{ 0.785398, 2.35619 }"}},
    {lua::a_typed_method<filled<sort>>,
     {"v:sort() -> vector", "The elements from the least to the greatest, nan last.",
      "print(vector{ 3, 1, 2 }:sort())  --> vector{ 1, 2, 3 }"}},
    {lua::a_metamethod<joined>("__concat"),
     {"v .. w, v .. number -> vector", "The elements of v, then those of w.",
      "print(vector{ 1, 2 } .. vector{ 3 } .. 4)  --> vector{ 1, 2, 3, 4 }"}},
    {lua::a_metamethod<pick>("__index"),
     {"v[w], v[v > 0] -> vector",
      "Some of the elements. A comparison (< <= > >=) in the brackets selects those for which it holds, also of "
      "another vector of the same length: run.t[run.theta > 0.5]. A vector w of 0 and 1 as long as v selects those "
      "with 1; any other w contains indices, such as v:find(function(x) return x > 0 and x < 1 end).",
      "v = vector{ 5, -1, 7 }\nprint(v[v > 0], v[vector{ 3, 1 }])  --> vector{ 5, 7 }\tvector{ 7, 5 }"}},
};

}  // namespace
}  // namespace dinal::api::vectors

namespace dinal::api {

const lua::Class vector_class{
    "vector",
    {"v",
     "Numbers in a row, such as a column of a run. It cannot be changed; "
     "arithmetic and mathematics act on all elements.",
     "v = vector{ 1, 2, 3 }\nprint(v[1], #v, 2 * v)  --> 1.0\t3\tvector{ 2, 4, 6 }"},
    vectors::vector_members,
    lua::add_class<lua::Vector>,
    lua::guarded<vectors::element>,
    vector_card,
};

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
    return text::error("n = {} must be a whole number from 2 to {}", n, most_numbers);
}

text::Expected<Numbers> vector_linspace(lua_State* L, double from, double to, double n) {
    if (const auto wrong = wrong_count(n)) return *wrong;
    return spaced(L, from, to, static_cast<std::size_t>(n));
}

text::Expected<Numbers> vector_range(lua_State* L, double from, double to, std::optional<double> given) {
    const double step = given.value_or(1), ratio = (to - from) / step;
    if (step == 0 || (to - from) * step < 0) {
        return text::error("step = {:.6g} does not lead from {:.6g} to {:.6g}", step, from, to);
    }
    if (ratio >= most_numbers) return text::error("{:.3g} numbers are more than {}", ratio, most_numbers);
    constexpr double rounding = 1e-9;  // tolerance, as a part of a step: 0 to 0.3 by 0.1 includes its end
    Numbers values = lua::new_numbers(L, static_cast<std::size_t>(std::floor(ratio + rounding)) + 1);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = from + static_cast<double>(i) * step;
    return values;
}

text::Expected<Numbers> vector_logspace(lua_State* L, double from, double to, double n) {
    if (const auto wrong = wrong_count(n)) return *wrong;
    if (!(from > 0) || !(to > 0)) {
        return text::error("from = {} and to = {} must be positive: they are the ends themselves, not powers of ten",
                           from, to);
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
    text::option<&UniformNumbers::from>("from", "lower limit"),
    text::option<&UniformNumbers::to>("to", "upper limit, excluded"),
};
constexpr text::Call uniform_call{"vector.random", "vector.random{ n = 100, seed = 1 }", uniform_options};
constexpr text::Option normal_options[] = {
    {"n", "", text::needed, count_range, "how many", text::fills<&NormalNumbers::n>},
    {"seed", "", text::needed, seed_range, seed_meaning, text::fills<&NormalNumbers::seed>},
    text::option<&NormalNumbers::mean>("mean", "their mean"),
    text::option<&NormalNumbers::std>("std", "their standard deviation", {.range = text::not_negative}),
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
        options.fail(options.has("from") ? "from" : "to", "from = {:.6g} must not be greater than to = {:.6g}",
                     asked.from, asked.to);
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
    lua::add_module,
};

}  // namespace dinal::api
