#include "api/vector_arithmetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lua/interrupt.hpp"
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

/// True when it holds for every element.
template <class Function>
int holds(lua_State* L, const char* symbol, Function f) {
    const Operand a = operand(L, 1, symbol);
    const Operand b = operand(L, 2, symbol);
    const std::size_t n = common_size(L, a, b, symbol);
    bool all = true;
    for (std::size_t i = 0; i < n && all; ++i) {
        all = f(a[i], b[i]);
    }
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
