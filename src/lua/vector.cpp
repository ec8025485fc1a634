#include "lua/vector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lua/gaps.hpp"

namespace dinal::lua {

std::vector<double> new_numbers(lua_State* L, std::size_t n) {
    make_room(L, n * sizeof(double));
    return std::vector<double>(n);
}

void push_vector(lua_State* L, std::vector<double> values) {
    const std::size_t bytes = values.size() * sizeof(double);
    push(L, Vector(std::move(values)));
    note_external_memory(L, bytes);
}

namespace {

/// "sys:simulate: times[2] = inf must be finite"; `index` is that of the value.
[[noreturn]] void refuse(lua_State* L, int index, std::string_view call, std::string_view option,
                         const std::string& complaint) {
    raise(L, {.sentence = fmt::format("{}{}{}{}", call, option.empty() ? "" : ": ", option, complaint),
              .call = std::string(call),
              .option = std::string(option),
              .culprit = written(L, index)});
}

std::vector<double> numbers_of_table(lua_State* L, int index, std::string_view call, std::string_view option) {
    const std::size_t n = lua_rawlen(L, index);
    make_room(L, n * sizeof(double));
    std::vector<double> numbers;
    numbers.reserve(n);
    for (std::size_t i = 1; i <= n; ++i) {
        if (lua_rawgeti(L, index, static_cast<lua_Integer>(i)) != LUA_TNUMBER) {
            refuse(L, -1, call, option, fmt::format("[{}] must be a finite number, got {}", i, describe(L, -1)));
        }
        numbers.push_back(lua_tonumber(L, -1));
        lua_pop(L, 1);
    }
    return numbers;
}

template <class Allowed>
std::vector<double> numbers_that_are(lua_State* L, int index, std::string_view call, std::string_view option,
                                     Allowed allowed) {
    index = lua_absindex(L, index);
    std::vector<double> numbers;
    if (const auto* vector = test<Vector>(L, index)) {
        make_room(L, vector->size() * sizeof(double));
        numbers.assign(vector->begin(), vector->end());
    } else if (lua_type(L, index) == LUA_TTABLE) {
        numbers = numbers_of_table(L, index, call, option);
    } else {
        refuse(L, index, call, option,
               fmt::format(" must be a table of numbers or a vector, got {}", describe(L, index)));
    }
    const auto bad = std::find_if_not(numbers.begin(), numbers.end(), allowed);
    if (bad != numbers.end()) {
        refuse(L, index, call, option, fmt::format("[{}] = {} must be finite", bad - numbers.begin() + 1, *bad));
    }
    return numbers;
}

}  // namespace

std::vector<double> numbers_at(lua_State* L, int index, std::string_view call, std::string_view option) {
    return numbers_that_are(L, index, call, option, [](double x) { return std::isfinite(x); });
}

std::vector<double> numbers_with_gaps_at(lua_State* L, int index, std::string_view call, std::string_view option) {
    return numbers_that_are(L, index, call, option, [](double x) { return !std::isinf(x); });
}

}  // namespace dinal::lua
