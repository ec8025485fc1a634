#include "api/vector_queries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lua/interrupt.hpp"
#include "lua/user_function.hpp"
#include "lua/vector.hpp"

namespace dinal::api::vector_functions {
namespace {

const lua::Vector& own(lua_State* L, const char* call) {
    return lua::self<lua::Vector>(L, 1, call);
}

const lua::Vector& other(lua_State* L, int index, const char* call, const char* name) {
    const auto* found = lua::test<lua::Vector>(L, index);
    if (found == nullptr) {
        lua::raise(L, {.sentence = fmt::format("{}: {} must be a vector, got {}", call, name, lua::describe(L, index)),
                       .call = call,
                       .culprit = lua::written(L, index)});
    }
    return *found;
}

[[noreturn]] void unequal(lua_State* L, const char* call, std::size_t n, std::size_t m) {
    lua::raise(
        L, {.sentence = fmt::format("{}: the vectors have {} and {} numbers; they must be equally long", call, n, m),
            .call = call});
}

void check_function(lua_State* L, const char* call) {
    if (!lua::is_callable(L, 2)) {
        lua::raise(L, {.sentence = fmt::format("{} takes a function of an element, got {}", call, lua::describe(L, 2)),
                       .call = call,
                       .culprit = lua::written(L, 2)});
    }
}

/// Leaves f(x, i) on the top of the stack.
void ask(lua_State* L, double x, std::size_t i) {
    lua_pushvalue(L, 2);
    lua_pushnumber(L, x);
    lua_pushinteger(L, static_cast<lua_Integer>(i) + 1);
    lua_call(L, 2, 1);
}

template <class Better>
int place(lua_State* L, const char* call, Better better) {
    const lua::Vector& v = own(L, call);
    if (v.size() == 0) {
        lua::raise(L, text::in_call(call, {"the vector is empty"}));
    }
    std::size_t best = 0;
    for (std::size_t i = 1; i < v.size(); ++i) {
        if (better(v.begin()[i], v.begin()[best]) || std::isnan(v.begin()[best])) best = i;
    }
    lua_pushinteger(L, static_cast<lua_Integer>(best) + 1);
    return 1;
}

}  // namespace

int map(lua_State* L) {
    const lua::Vector v = own(L, "v:map(f)");
    check_function(L, "v:map");
    std::vector<double> result = lua::new_numbers(L, v.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
        ask(L, v.begin()[i], i);
        if (!lua_isboolean(L, -1) && lua_type(L, -1) != LUA_TNUMBER) {
            lua::raise(L, {.sentence = fmt::format("v:map: f must return a number, true or false, but f({:.6g}) is {}",
                                                   v.begin()[i], lua::describe(L, -1)),
                           .call = "v:map"});
        }
        result[i] = lua_isboolean(L, -1) ? static_cast<double>(lua_toboolean(L, -1)) : lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
    lua::push_vector(L, std::move(result));
    return 1;
}

int find(lua_State* L) {
    const lua::Vector v = own(L, "v:find(f)");
    check_function(L, "v:find");
    std::vector<double> places;
    for (std::size_t i = 0; i < v.size(); ++i) {
        ask(L, v.begin()[i], i);
        if (lua_toboolean(L, -1) != 0) places.push_back(static_cast<double>(i + 1));
        lua_pop(L, 1);
    }
    lua::push_vector(L, std::move(places));
    return 1;
}

int quantile(lua_State* L) {
    const lua::Vector& v = own(L, "v:quantile(p)");
    const double p = lua::finite_argument(L, 2, "v:quantile(p): p");
    if (!(p >= 0 && p <= 1)) {
        lua::raise(L, text::in_call("v:quantile(p)", {fmt::format("p = {:.6g} must lie between 0 and 1", p)}));
    }
    if (v.size() == 0) lua::raise(L, text::in_call("v:quantile(p)", {"the vector is empty"}));
    std::vector<double> values(v.begin(), v.end());
    if (std::any_of(values.begin(), values.end(), [](double x) { return std::isnan(x); })) {
        lua_pushnumber(L, std::nan(""));
        return 1;
    }
    const double place = p * static_cast<double>(values.size() - 1), below = std::floor(place);
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(below);
    std::nth_element(values.begin(), nth, values.end());
    double value = *nth;
    if (place > below) value += (place - below) * (*std::min_element(nth + 1, values.end()) - value);
    lua_pushnumber(L, value);
    return 1;
}

int deviation(lua_State* L) {
    const lua::Vector& v = own(L, "v:std()");
    if (v.size() < 2) {
        lua::raise(L, text::in_call("v:std()", {"two numbers are needed at least"}));
    }
    double mean = 0, squares = 0;
    std::size_t n = 0;
    for (const double x : v) {  // Welford: no difference of large sums
        const double off = x - mean;
        mean += off / static_cast<double>(++n);
        squares += off * (x - mean);
    }
    lua_pushnumber(L, std::sqrt(squares / static_cast<double>(n - 1)));
    return 1;
}

int place_of_maximum(lua_State* L) {
    return place(L, "v:argmax()", [](double x, double best) { return x > best; });
}
int place_of_minimum(lua_State* L) {
    return place(L, "v:argmin()", [](double x, double best) { return x < best; });
}

int cumulated(lua_State* L) {
    const lua::Vector& v = own(L, "v:cumsum()");
    std::vector<double> sums = lua::new_numbers(L, v.size());
    double sum = 0, lost = 0;  // Neumaier's sum, as v:sum() has
    for (std::size_t i = 0; i < v.size(); ++i) {
        const double x = v.begin()[i], next = sum + x;
        lost += std::fabs(sum) >= std::fabs(x) ? (sum - next) + x : (x - next) + sum;
        sum = next;
        sums[i] = std::isfinite(lost) ? sum + lost : sum;
    }
    lua::push_vector(L, std::move(sums));
    return 1;
}

int differences(lua_State* L) {
    const lua::Vector& v = own(L, "v:diff()");
    std::vector<double> result = lua::new_numbers(L, v.size() == 0 ? 0 : v.size() - 1);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = v.begin()[i + 1] - v.begin()[i];
    lua::push_vector(L, std::move(result));
    return 1;
}

int interpolated(lua_State* L) {
    const char* const call = "v:interp(x, y)";
    const lua::Vector& v = own(L, call);
    const lua::Vector& x = other(L, 2, call, "x");
    const lua::Vector& y = other(L, 3, call, "y");
    if (x.size() != y.size()) unequal(L, call, x.size(), y.size());
    if (x.size() == 0) lua::raise(L, text::in_call(call, {"there are no points"}));
    const auto* const step = std::adjacent_find(x.begin(), x.end(), [](double a, double b) { return !(a < b); });
    if (step != x.end()) {
        lua::raise(L, text::in_call(call, {fmt::format("x[{}] = {} is not after x[{}] = {}; x must increase",
                                                       step - x.begin() + 2, step[1], step - x.begin() + 1, *step)}));
    }
    std::vector<double> result = lua::new_numbers(L, v.size());
    std::transform(v.begin(), v.end(), result.begin(), [&](double at) {
        if (std::isnan(at)) return at;
        const auto i = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
        if (i == 0) return y.begin()[0];
        if (i == x.size()) return y.begin()[i - 1];
        const double* const a = x.begin() + i - 1;
        const double* const b = y.begin() + i - 1;
        return b[0] + (b[1] - b[0]) * ((at - a[0]) / (a[1] - a[0]));
    });
    lua::push_vector(L, std::move(result));
    return 1;
}

int joined(lua_State* L) {
    std::vector<double> all;
    for (const int index : {1, 2}) {
        if (const auto* vector = lua::test<lua::Vector>(L, index)) {
            lua::make_room(L, (all.size() + vector->size()) * sizeof(double));
            all.insert(all.end(), vector->begin(), vector->end());
        } else if (lua_type(L, index) == LUA_TNUMBER) {
            all.push_back(lua_tonumber(L, index));
        } else {
            lua::raise(L, fmt::format("a vector .. {} is not possible; the other side must be a number or a vector{}",
                                      lua::describe(L, index),
                                      lua_type(L, index) == LUA_TSTRING ? " (tostring(v) is its text)" : ""));
        }
    }
    lua::push_vector(L, std::move(all));
    return 1;
}

int pick(lua_State* L) {
    const lua::Vector& v = own(L, "v[w]");
    const lua::Vector& w = other(L, 2, "v[w]", "w");
    const bool mask =
        w.size() == v.size() && std::all_of(w.begin(), w.end(), [](double x) { return x == 0 || x == 1; });
    std::vector<double> picked;
    for (std::size_t i = 0; i < w.size(); ++i) {
        const double x = w.begin()[i];
        if (mask) {
            if (x == 1) picked.push_back(v.begin()[i]);
            continue;
        }
        if (x != std::floor(x) || !(x >= 1 && x <= static_cast<double>(v.size()))) {
            lua::raise(L, {.sentence = fmt::format("v[w]: w[{}] = {:.6g} is no place in a vector of {} numbers; a w of "
                                                   "0 and 1 must be as long as v",
                                                   i + 1, x, v.size())});
        }
        picked.push_back(v.begin()[static_cast<std::size_t>(x) - 1]);
    }
    lua::push_vector(L, std::move(picked));
    return 1;
}

int dot(lua_State* L) {
    const lua::Vector& v = own(L, "v:dot(w)");
    const lua::Vector& w = other(L, 2, "v:dot(w)", "w");
    if (v.size() != w.size()) unequal(L, "v:dot(w)", v.size(), w.size());
    double sum = 0, lost = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
        const double x = v.begin()[i] * w.begin()[i], next = sum + x;
        lost += std::fabs(sum) >= std::fabs(x) ? (sum - next) + x : (x - next) + sum;
        sum = next;
    }
    lua_pushnumber(L, std::isfinite(lost) ? sum + lost : sum);
    return 1;
}

int arctangent(lua_State* L) {
    const lua::Vector& v = own(L, "v:atan(w)");
    const bool number = lua_isnoneornil(L, 2) || lua_type(L, 2) == LUA_TNUMBER;
    const double all = lua_isnoneornil(L, 2) ? 1 : lua_tonumber(L, 2);
    const lua::Vector* w = number ? nullptr : &other(L, 2, "v:atan(w)", "w");
    if (w != nullptr && w->size() != v.size()) unequal(L, "v:atan(w)", v.size(), w->size());
    std::vector<double> result = lua::new_numbers(L, v.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
        result[i] = std::atan2(v.begin()[i], w != nullptr ? w->begin()[i] : all);
    }
    lua::push_vector(L, std::move(result));
    return 1;
}

int sorted(lua_State* L) {
    const lua::Vector& v = own(L, "v:sort()");
    std::vector<double> result = lua::new_numbers(L, v.size());
    std::copy(v.begin(), v.end(), result.begin());
    std::sort(result.begin(), result.end(), [](double a, double b) { return std::isnan(b) ? !std::isnan(a) : a < b; });
    lua::push_vector(L, std::move(result));
    return 1;
}

}  // namespace dinal::api::vector_functions
