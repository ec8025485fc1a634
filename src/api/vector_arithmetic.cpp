#include "api/vector_arithmetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "errors/source_text.hpp"
#include "lua/interrupt.hpp"
#include "lua/memory_limit.hpp"
#include "lua/tokens.hpp"
#include "lua/vector.hpp"

namespace dinal::api::vector_functions {

namespace {

/// Calls work(i) for all i below n; a stop is noticed in between.
template <class Work>
void for_each_index(lua_State* L, std::size_t n, Work work) {
    constexpr std::size_t block = std::size_t{1} << 16U;
    for (std::size_t begin = 0; begin < n; begin += block) {
        if (lua::interrupt_requested()) {
            lua::raise_interrupted(L);
        }
        const std::size_t end = std::min(n, begin + block);
        for (std::size_t i = begin; i < end; ++i) {
            work(i);
        }
    }
}

template <class Function>
int mapped(lua_State* L, std::string_view call, Function f) {
    const auto& v = lua::self<lua::Vector>(L, 1, call);
    std::vector<double> result = lua::new_numbers(L, v.size());
    for_each_index(L, v.size(), [&](std::size_t i) { result[i] = f(v.begin()[i]); });
    lua::push_vector(L, std::move(result));
    return 1;
}

/// One side of an operator: a vector, or a number that stands for as many as the other side has.
struct Operand {
    const lua::Vector* vector = nullptr;
    double number = 0;
    double operator[](std::size_t i) const { return vector != nullptr ? vector->begin()[i] : number; }
};

Operand operand(lua_State* L, int index, const char* symbol) {
    if (const auto* vector = lua::test<lua::Vector>(L, index)) {
        return {vector};
    }
    if (lua_type(L, index) != LUA_TNUMBER) {
        lua::raise(L, fmt::format("a vector {} {} is not possible; the other side must be a number or a vector", symbol,
                                  lua::describe(L, index)));
    }
    return {nullptr, lua_tonumber(L, index)};
}

std::size_t common_size(lua_State* L, const Operand& a, const Operand& b, const char* symbol) {
    if (a.vector != nullptr && b.vector != nullptr && a.vector->size() != b.vector->size()) {
        lua::raise(L, fmt::format("the vectors in v {} w have {} and {} numbers; they must be equally long", symbol,
                                  a.vector->size(), b.vector->size()));
    }
    if (a.vector == nullptr && b.vector == nullptr) {  // debug.getmetatable leads here
        lua::raise(L, fmt::format("x {} y of vectors needs a vector on one side", symbol));
    }
    return a.vector != nullptr ? a.vector->size() : b.vector->size();
}

template <class Function>
int combined(lua_State* L, const char* symbol, Function f) {
    const Operand a = operand(L, 1, symbol);
    const Operand b = operand(L, 2, symbol);
    std::vector<double> result = lua::new_numbers(L, common_size(L, a, b, symbol));
    for_each_index(L, result.size(), [&](std::size_t i) { result[i] = f(a[i], b[i]); });
    lua::push_vector(L, std::move(result));
    return 1;
}

// Lua turns the result of v > 0 into true or false. So that v[v > 0] can work, the comparison is remembered here, with
// the line of the script that made it; v[true] in that line means it.
struct Comparison {
    const void* function = nullptr;
    int line = 0;
    int count = 0;  // how many comparisons this line has made since the last v[...]
    bool all = false;
    std::vector<bool> mask = {};
};
thread_local Comparison last_comparison;
const char comparing_function = 0;  // registry key: the function lives as long as its address is compared with

/// The function that runs, and its line.
std::pair<const void*, int> running_line(lua_State* L) {
    lua_Debug caller{};
    if (lua_getstack(L, 1, &caller) == 0 || lua_getinfo(L, "lf", &caller) == 0) return {nullptr, 0};
    const void* function = lua_topointer(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &comparing_function);
    return {function, caller.currentline};
}

/// Whether the function has a variable of that name from outside of it.
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

/// Why v[v > 0] cannot be trusted in this statement; "" if it can. With `and` and `or` Lua leaves out the second
/// comparison, so the mask would be that of the first. Lua before 5.4.7 compiles v[v > 0] wrongly if v is a variable of
/// an outer function: it indexes another register.
std::string fault_of_mask(lua_State* L, lua_Debug& caller, std::string_view statement) {
    const std::vector<lua::Token> all = lua::tokens(statement);
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

/// The same for the line that runs. A line is read once as long as no other one asks.
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

/// True when it holds for every element.
template <class Function>
int holds(lua_State* L, const char* symbol, Function f) {
    const Operand a = operand(L, 1, symbol);
    const Operand b = operand(L, 2, symbol);
    const std::size_t n = common_size(L, a, b, symbol);
    lua::make_room(L, n / 8 + 1);
    std::vector<bool> mask(n);
    for (std::size_t i = 0; i < n; ++i) mask[i] = f(a[i], b[i]);
    const bool all = std::find(mask.begin(), mask.end(), false) == mask.end();
    const auto [function, line] = running_line(L);
    const bool again = function == last_comparison.function && line == last_comparison.line;
    last_comparison = {function, line, again ? last_comparison.count + 1 : 1, all, std::move(mask)};
    lua_pushboolean(L, all ? 1 : 0);
    return 1;
}

}  // namespace

int sine(lua_State* L) {
    return mapped(L, "v:sin()", [](double x) { return std::sin(x); });
}
int cosine(lua_State* L) {
    return mapped(L, "v:cos()", [](double x) { return std::cos(x); });
}
int tangent(lua_State* L) {
    return mapped(L, "v:tan()", [](double x) { return std::tan(x); });
}
int absolute(lua_State* L) {
    return mapped(L, "v:abs()", [](double x) { return std::fabs(x); });
}
int square_root(lua_State* L) {
    return mapped(L, "v:sqrt()", [](double x) { return std::sqrt(x); });
}
int exponential(lua_State* L) {
    return mapped(L, "v:exp()", [](double x) { return std::exp(x); });
}
int logarithm(lua_State* L) {
    return mapped(L, "v:log()", [](double x) { return std::log(x); });
}
int negated(lua_State* L) {
    return mapped(L, "-v", [](double x) { return -x; });
}

int add(lua_State* L) {
    return combined(L, "+", [](double a, double b) { return a + b; });
}
int subtract(lua_State* L) {
    return combined(L, "-", [](double a, double b) { return a - b; });
}
int multiply(lua_State* L) {
    return combined(L, "*", [](double a, double b) { return a * b; });
}
int divide(lua_State* L) {
    return combined(L, "/", [](double a, double b) { return a / b; });
}
int power(lua_State* L) {
    return combined(L, "^", [](double a, double b) { return b == 2 ? a * a : std::pow(a, b); });
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
    const bool wanted = (lua_toboolean(L, 2) != 0) == last_comparison.all;  // v[not (v > 0)]
    lua::make_room(L, v.size() * sizeof(double));
    std::vector<double> result;
    for (std::size_t i = 0; i < v.size(); ++i) {
        if (last_comparison.mask[i] == wanted) result.push_back(v.begin()[i]);
    }
    lua::push_vector(L, std::move(result));
    return 1;
}

int less(lua_State* L) {
    return holds(L, "<", [](double a, double b) { return a < b; });
}
int less_or_equal(lua_State* L) {
    return holds(L, "<=", [](double a, double b) { return a <= b; });
}
int equal(lua_State* L) {
    const auto* a = lua::test<lua::Vector>(L, 1);
    const auto* b = lua::test<lua::Vector>(L, 2);
    const bool same =
        a != nullptr && b != nullptr && a->size() == b->size() && std::equal(a->begin(), a->end(), b->begin());
    lua_pushboolean(L, same ? 1 : 0);
    return 1;
}

}  // namespace dinal::api::vector_functions
