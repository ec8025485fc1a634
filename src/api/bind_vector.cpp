#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "api/cards.hpp"
#include "api/classes.hpp"
#include "api/vector_arithmetic.hpp"
#include "api/vector_queries.hpp"
#include "lua/vector.hpp"

namespace dinal::api {
namespace {

const lua::Vector& self_vector(lua_State* L, std::string_view call) {
    return lua::self<lua::Vector>(L, 1, call);
}

// ---- one number from many

/// Neumaier's sum: the rounding errors are collected and added at the end.
double sum_of(const lua::Vector& v) {
    double sum = 0;
    double lost = 0;
    for (const double x : v) {
        const double next = sum + x;
        lost += std::fabs(sum) >= std::fabs(x) ? (sum - next) + x : (x - next) + sum;
        sum = next;
    }
    return std::isfinite(lost) ? sum + lost : sum;
}

const lua::Vector& not_empty(lua_State* L, std::string_view call) {
    const lua::Vector& v = self_vector(L, call);
    if (v.size() == 0) {
        lua::raise(L, text::in_call(call, {"the vector is empty"}));
    }
    return v;
}

template <class Better>
int extreme(lua_State* L, std::string_view call, Better better) {
    const lua::Vector& v = not_empty(L, call);
    double best = *v.begin();
    for (const double x : v) {
        if (better(x, best) || std::isnan(x)) {
            best = x;
        }
    }
    lua_pushnumber(L, best);
    return 1;
}

int maximum(lua_State* L) {
    return extreme(L, "v:max()", [](double x, double best) { return x > best; });
}
int minimum(lua_State* L) {
    return extreme(L, "v:min()", [](double x, double best) { return x < best; });
}
int sum(lua_State* L) {
    lua_pushnumber(L, sum_of(self_vector(L, "v:sum()")));
    return 1;
}
int mean(lua_State* L) {
    const lua::Vector& v = not_empty(L, "v:mean()");
    lua_pushnumber(L, sum_of(v) / static_cast<double>(v.size()));
    return 1;
}

// ---- elements

/// The index from 0 of element i, counted from 1; none when there is no such one.
std::optional<std::size_t> position(const lua::Vector& v, lua_Integer i) {
    const auto n = static_cast<lua_Integer>(v.size());
    if (i < 1 || i > n) {
        return std::nullopt;
    }
    return static_cast<std::size_t>(i - 1);
}

int element(lua_State* L) {
    const auto* v = lua::test<lua::Vector>(L, 1);
    int is_integer = 0;
    const lua_Integer i = lua_tointegerx(L, 2, &is_integer);
    if (v != nullptr && lua::test<lua::Vector>(L, 2) != nullptr) {
        return vector_functions::pick(L);
    }
    if (v != nullptr && lua_isboolean(L, 2)) {
        return vector_functions::masked(L);
    }
    if (v == nullptr || lua_type(L, 2) != LUA_TNUMBER) {
        return 0;
    }
    if (is_integer != 0 && i < 0) {
        lua::raise(
            L, {.sentence = fmt::format("v[{}]: elements are counted from 1; the last one is v[#v]", i), .call = "v"});
    }
    if (const auto at = position(*v, i); is_integer != 0 && at) {
        lua_pushnumber(L, v->begin()[*at]);
    } else {
        lua_pushnil(L);
    }
    return 1;
}

int vector_length(lua_State* L) {
    lua_pushinteger(L, static_cast<lua_Integer>(self_vector(L, "#v").size()));
    return 1;
}

lua_Integer whole_argument(lua_State* L, int index, std::string_view name, lua_Integer otherwise) {
    if (lua_isnoneornil(L, index)) {
        return otherwise;
    }
    int is_integer = 0;
    const lua_Integer value = lua_tointegerx(L, index, &is_integer);
    if (is_integer == 0 || lua_type(L, index) != LUA_TNUMBER) {
        lua::raise_got(L, index, "v:slice(first, last, step)",
                       fmt::format("v:slice(first, last, step): {} must be a whole number", name));
    }
    return value;
}

int slice(lua_State* L) {
    const lua::Vector& v = self_vector(L, "v:slice(1, 10)");
    const auto n = static_cast<lua_Integer>(v.size());
    const lua_Integer first = whole_argument(L, 2, "first", 1);
    const lua_Integer last = whole_argument(L, 3, "last", n);
    const lua_Integer step = whole_argument(L, 4, "step", 1);
    if (first < 1 || last > n || step < 1) {
        lua::raise(L, text::in_call(fmt::format("v:slice({}, {}, {})", first, last, step),
                                    {fmt::format("the vector has elements 1 to {}, and step must be at least 1", n)}));
    }
    lua::make_room(L, v.size() * sizeof(double));
    std::vector<double> result;
    for (lua_Integer i = first; i <= last; i += std::min(step, n)) {
        result.push_back(v.begin()[i - 1]);
    }
    lua::push_vector(L, std::move(result));
    return 1;
}

int table(lua_State* L) {
    const lua::Vector& v = self_vector(L, "v:table()");
    lua_createtable(L, static_cast<int>(std::min<std::size_t>(v.size(), 1U << 30U)), 0);
    lua_Integer i = 0;
    for (const double x : v) {
        lua_pushnumber(L, x);
        lua_rawseti(L, -2, ++i);
    }
    return 1;
}

int vector_text(lua_State* L) {
    const lua::Vector& v = self_vector(L, "tostring(v)");
    constexpr std::size_t shown_whole = 10;
    constexpr std::size_t ends = 3;
    const auto list = [](std::span<const double> x) { return fmt::format("{:.6g}", fmt::join(x, ", ")); };
    std::string result;
    if (v.size() == 0) {
        result = "vector{}";
    } else if (v.size() <= shown_whole) {
        result = "vector{ " + list(v.values()) + " }";
    } else {
        result = fmt::format("vector{{ {}, ..., {} }}  -- {} numbers", list(v.values().first(ends)),
                             list(v.values().last(ends)), v.size());
    }
    return lua::push_text(L, result);
}

// ---- the class

constexpr lua::Member vector_members[] = {
    {lua::a_method<vector_functions::sine>,
     {"v:sin() -> vector", "Sine of every element (rad).", "print(vector{ 0, 1 }:sin())  --> vector{ 0, 0.841471 }"}},
    {lua::a_method<vector_functions::cosine>,
     {"v:cos() -> vector", "Cosine of every element (rad).", "print(vector{ 0, 1 }:cos())  --> vector{ 1, 0.540302 }"}},
    {lua::a_method<vector_functions::tangent>,
     {"v:tan() -> vector", "Tangent of every element (rad).", "print(vector{ 0, 1 }:tan())  --> vector{ 0, 1.55741 }"}},
    {lua::a_method<vector_functions::absolute>,
     {"v:abs() -> vector", "Absolute value of every element.", "print(vector{ -2, 3 }:abs())  --> vector{ 2, 3 }"}},
    {lua::a_method<vector_functions::square_root>,
     {"v:sqrt() -> vector", "Square root of every element; nan for negative ones.",
      "print(vector{ 4, 9 }:sqrt())  --> vector{ 2, 3 }"}},
    {lua::a_method<vector_functions::exponential>,
     {"v:exp() -> vector", "e to the power of every element.",
      "print(vector{ 0, 1 }:exp())  --> vector{ 1, 2.71828 }"}},
    {lua::a_method<vector_functions::logarithm>,
     {"v:log() -> vector", "Natural logarithm of every element; nan for negative ones.",
      "print(vector{ 1, 10 }:log())  --> vector{ 0, 2.30259 }"}},
    {lua::a_method<maximum>, {"v:max() -> number", "The greatest element.", "print(vector{ 1, 3, 2 }:max())  --> 3.0"}},
    {lua::a_method<minimum>, {"v:min() -> number", "The least element.", "print(vector{ 1, 3, -2 }:min())  --> -2.0"}},
    {lua::a_method<mean>,
     {"v:mean() -> number", "The sum divided by the number of elements.", "print(vector{ 1, 2, 6 }:mean())  --> 3.0"}},
    {lua::a_method<sum>,
     {"v:sum() -> number", "The sum of all elements (0 when there are none), accurate however many there are.",
      "print(vector{ 1e100, 1, -1e100 }:sum())  --> 1.0"}},
    {lua::a_method<slice>,
     {"v:slice(first = 1, last = #v, step = 1) -> vector", "The elements from first to last, every step-th of them.",
      "print(vector{ 10, 20, 30, 40, 50 }:slice(2, 5, 2))  --> vector{ 20, 40 }"}},
    {lua::a_method<table>,
     {"v:table() -> table", "An ordinary Lua table with the same numbers.",
      "print(table.concat(vector{ 1, 2 }:table(), \" \"))  --> 1.0 2.0"}},
    {lua::a_metamethod<vector_length>("__len"),
     {"#v -> integer", "How many elements there are. v[1] is the first one, v[#v] the last one; beyond them is nil.",
      "print(#vector{ 4, 5, 6 })  --> 3"}},
    {lua::a_metamethod<vector_functions::add>("__add"),
     {"v + w, v + number -> vector", "Element by element; two vectors must be equally long.",
      "print(vector{ 1, 2 } + vector{ 10, 20 })  --> vector{ 11, 22 }"}},
    {lua::a_metamethod<vector_functions::subtract>("__sub"),
     {"v - w, v - number -> vector", "Element by element.", "print(10 - vector{ 1, 2 })  --> vector{ 9, 8 }"}},
    {lua::a_metamethod<vector_functions::multiply>("__mul"),
     {"v * w, v * number -> vector", "Element by element.", "print(2 * vector{ 1, 2 })  --> vector{ 2, 4 }"}},
    {lua::a_metamethod<vector_functions::divide>("__div"),
     {"v / w, v / number -> vector", "Element by element.", "print(vector{ 1, 2 } / 4)  --> vector{ 0.25, 0.5 }"}},
    {lua::a_metamethod<vector_functions::power>("__pow"),
     {"v ^ w, v ^ number -> vector", "Element by element.", "print(vector{ 2, 3 } ^ 2)  --> vector{ 4, 9 }"}},
    {lua::a_metamethod<vector_functions::negated>("__unm"),
     {"-v -> vector", "Every element with the other sign.", "print(-vector{ 1, -2 })  --> vector{ -1, 2 }"}},
    {lua::a_metamethod<vector_functions::equal>("__eq"),
     {"v == w -> boolean", "True when both have the same elements.",
      "print(vector{ 1, 2 } == vector{ 1, 2 })  --> true"}},
    {lua::a_metamethod<vector_functions::less>("__lt"),
     {"v < w, v < number -> boolean",
      "True when it holds for every element; so v < 3 and v >= 3 can both be false. Also >.",
      "print(vector{ 1, 2 } < 3, vector{ 1, 5 } < 3)  --> true\tfalse"}},
    {lua::a_metamethod<vector_functions::less_or_equal>("__le"),
     {"v <= w, v <= number -> boolean", "True when it holds for every element. Also >=.",
      "print(vector{ 1, 2 } >= 1)  --> true"}},
    {lua::a_metamethod<vector_text>("__tostring"),
     {"tostring(v) -> string", "The elements to six digits; of a long vector its two ends and its length.",
      "print(vector.linspace(0, 1, 101))  --> vector{ 0, 0.01, 0.02, ..., 0.98, 0.99, 1 }  -- 101 numbers"}},
};

constexpr auto all_vector_members = [] {
    std::array<lua::Member, std::size(vector_members) + std::size(vector_query_members)> all{};
    std::copy(std::begin(vector_query_members), std::end(vector_query_members),
              std::copy(std::begin(vector_members), std::end(vector_members), all.begin()));
    return all;
}();

}  // namespace

const lua::Class vector_class{
    "vector",
    {"v",
     "Numbers in a row, such as a column of a run. It cannot be changed; "
     "arithmetic and mathematics act on all elements.",
     "v = vector{ 1, 2, 3 }\nprint(v[1], #v, 2 * v)  --> 1.0\t3\tvector{ 2, 4, 6 }"},
    all_vector_members,
    lua::guarded<element>,
    vector_card,
};

void register_vector(lua_State* L) {
    lua::add_class<lua::Vector>(L, vector_class);
    lua::add_module(L, vector_module);
}

}  // namespace dinal::api
