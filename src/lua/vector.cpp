#include "lua/vector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lua/lua_text.hpp"

namespace dinal::lua {

std::vector<double> new_numbers(lua_State* L, std::size_t n) {
    make_room(L, n * sizeof(double));
    return std::vector<double>(n);
}

int push_vector(lua_State* L, std::vector<double> values) {
    const std::size_t bytes = values.size() * sizeof(double);
    push(L, Vector(std::move(values)));
    note_external_memory(L, bytes);
    return 1;
}

std::string key_beside_list(lua_State* L, int index) {
    index = lua_absindex(L, index);
    const auto n = static_cast<lua_Integer>(lua_rawlen(L, index));
    std::string key;
    lua_pushnil(L);
    while (lua_next(L, index) != 0) {
        const bool listed = lua_isinteger(L, -2) != 0 && lua_tointeger(L, -2) >= 1 && lua_tointeger(L, -2) <= n;
        const bool named = lua_type(L, -2) == LUA_TSTRING && is_name(text_at(L, -2));
        const std::string own = listed ? "" : (named ? std::string(text_at(L, -2)) : "[" + describe(L, -2) + "]");
        // the alphabetically first key, because tables are unordered
        if (!listed && (key.empty() || own < key)) key = own;
        lua_pop(L, 1);
    }
    return key;
}

namespace {

/// Raises "sys:simulate: times[2] = inf must be finite" about the value at `index`.
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
    if (const std::string key = key_beside_list(L, index); !key.empty()) {
        refuse(L, index, call, option, fmt::format(" must be a list such as {{ 1, 2, 3 }}, but it has {}", key));
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
    const auto bad = std::ranges::find_if_not(numbers, allowed);
    if (bad != numbers.end()) {
        const std::string number = std::isnan(*bad) ? "nan" : fmt::format("{}", *bad);  // without its sign
        refuse(L, index, call, option, fmt::format("[{}] = {} must be finite", bad - numbers.begin() + 1, number));
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
