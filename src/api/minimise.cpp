// minimise{ over, run }: the least value of a function of one or two parameters within limits. A coarse grid finds the
// valley; Brent's method (1973) follows it in one parameter, that of Nelder and Mead (1965) in two.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "api/sweep_options.hpp"
#include "api/sweep_parameters.hpp"
#include "lua/options.hpp"
#include "lua/vector.hpp"

namespace dinal::api {
namespace {

constexpr double accuracy = 1.5e-8;  // of the range: below it a function near its least value is rounding

struct Range {
    std::string name;
    double low = 0, high = 0;
    [[nodiscard]] double at(double part) const { return low + (high - low) * part; }
};

/// The place in parts of the ranges, and the value there.
struct Spot {
    std::array<double, 2> at{};
    double value = 0;
};
using Cost = std::function<double(const std::array<double, 2>& at)>;

/// Brent's method between two parts of the range: parabolas, and golden sections where these do not help.
Spot brent(const Cost& cost, double a, double b, double start, double value) {
    constexpr double golden_part = 0.3819660112501051;
    double x = start, w = start, v = start, fx = value, fw = value, fv = value, step = 0, before = 0;
    constexpr int most = 200;
    for (int i = 0; i < most; ++i) {
        const double middle = (a + b) / 2;
        if (std::fabs(x - middle) <= 2 * accuracy - (b - a) / 2) break;
        double r = (x - w) * (fx - fv), q = (x - v) * (fx - fw), p = (x - v) * q - (x - w) * r;
        q = 2 * (q - r);
        if (q > 0) p = -p;
        q = std::fabs(q);
        const bool parabola = std::fabs(before) > accuracy && std::fabs(p) < std::fabs(q * before / 2) &&
                              p > q * (a - x) && p < q * (b - x);
        before = parabola ? step : (x < middle ? b - x : a - x);
        step = parabola ? p / q : golden_part * before;
        const double u = x + (std::fabs(step) >= accuracy ? step : std::copysign(accuracy, step));
        const double fu = cost({u, 0});
        if (fu <= fx) {
            (u < x ? b : a) = x;
            v = w, w = x, x = u, fv = fw, fw = fx, fx = fu;
            continue;
        }
        (u < x ? a : b) = u;
        if (fu <= fw || w == x) {
            v = w, w = u, fv = fw, fw = fu;
        } else if (fu <= fv || v == x || v == w) {
            v = u, fv = fu;
        }
    }
    return {{x, 0}, fx};
}

/// The simplex of Nelder and Mead, kept within the ranges.
Spot nelder_mead(const Cost& cost, const Spot& start, double size) {
    const auto look = [&](std::array<double, 2> at) {
        for (double& x : at) x = std::clamp(x, 0.0, 1.0);
        return Spot{at, cost(at)};
    };
    std::array<Spot, 3> corner{start, {}, {}};
    for (std::size_t i = 0; i < 2; ++i) {
        std::array<double, 2> at = start.at;
        at[i] += at[i] + size <= 1 ? size : -size;
        corner[i + 1] = look(at);
    }
    constexpr int most = 400;
    for (int i = 0; i < most; ++i) {
        std::sort(corner.begin(), corner.end(), [](const Spot& a, const Spot& b) { return a.value < b.value; });
        double widest = 0;
        for (const Spot& other : corner) {
            for (std::size_t k = 0; k < 2; ++k) widest = std::max(widest, std::fabs(other.at[k] - corner[0].at[k]));
        }
        if (widest <= accuracy) break;
        const auto along = [&](double t) {
            std::array<double, 2> at{};
            for (std::size_t k = 0; k < 2; ++k) {
                const double middle = (corner[0].at[k] + corner[1].at[k]) / 2;
                at[k] = middle + t * (corner[2].at[k] - middle);
            }
            return look(at);
        };
        const Spot mirrored = along(-1);
        if (mirrored.value < corner[0].value) {
            const Spot farther = along(-2);
            corner[2] = farther.value < mirrored.value ? farther : mirrored;
            continue;
        }
        if (mirrored.value < corner[1].value) {
            corner[2] = mirrored;
            continue;
        }
        const Spot nearer = along(mirrored.value < corner[2].value ? -0.5 : 0.5);
        if (nearer.value < std::min(mirrored.value, corner[2].value)) {
            corner[2] = nearer;
            continue;
        }
        for (std::size_t c = 1; c < 3; ++c) {
            corner[c] = look({(corner[0].at[0] + corner[c].at[0]) / 2, (corner[0].at[1] + corner[c].at[1]) / 2});
        }
    }
    return *std::min_element(corner.begin(), corner.end(),
                             [](const Spot& a, const Spot& b) { return a.value < b.value; });
}

Spot least(const Cost& cost, std::size_t parameters) {
    const int parts = parameters == 1 ? 16 : 8;
    Spot best{{}, std::numeric_limits<double>::infinity()};
    for (int i = 0; i <= parts; ++i) {
        for (int j = 0; j <= (parameters == 1 ? 0 : parts); ++j) {
            const std::array<double, 2> at{static_cast<double>(i) / parts, static_cast<double>(j) / parts};
            const double value = cost(at);
            if (value < best.value || (i == 0 && j == 0)) best = {at, value};
        }
    }
    const double width = 1.0 / parts;
    if (parameters == 2) return nelder_mead(cost, best, width / 2);
    const double x = best.at[0];
    return brent(cost, std::max(0.0, x - width), std::min(1.0, x + width), x, best.value);
}

std::vector<Range> asked_ranges(lua_State* L, const lua::Options& options) {
    std::vector<Range> ranges;
    for (const DataColumn& parameter : take_parameters(L, minimise_call)) {
        const lua::Vector* limits = parameter.numbers();
        if (limits == nullptr || limits->size() != 2 || !(limits->begin()[0] < limits->begin()[1])) {
            options.fail("over",
                         fmt::format("over.{0} must be the two limits of {0}, such as {{ 0.1, 2 }}", parameter.name));
        }
        ranges.push_back({parameter.name, limits->begin()[0], limits->begin()[1]});
    }
    if (ranges.empty()) options.missing("over");
    if (ranges.size() > 2) options.fail("over", "over has more than two parameters; minimise takes one or two");
    for (const Range& range : ranges) {
        if (range.name != "value" && range.name != "calls") continue;
        options.fail("over", fmt::format("'{}' is a field of the result: give the parameter another name", range.name));
    }
    return ranges;
}

}  // namespace

int minimise(lua_State* L) {
    const lua::Options options(L, 1, minimise_call);
    const std::vector<Range> ranges = asked_ranges(L, options);
    const int function = push_function(L, options, "run");
    lua_Integer calls = 0;
    const Cost cost = [&](const std::array<double, 2>& at) {
        ++calls;
        lua_pushvalue(L, function);
        lua_createtable(L, 0, 2);
        std::string place;
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            const double x = ranges[i].at(at[i]);
            lua_pushnumber(L, x);
            lua_setfield(L, -2, ranges[i].name.c_str());
            place += fmt::format("{}{} = {:.6g}", i == 0 ? "" : ", ", ranges[i].name, x);
        }
        lua_call(L, 1, 1);
        const double value = lua_tonumber(L, -1);
        if (lua_type(L, -1) != LUA_TNUMBER || std::isnan(value)) {
            options.fail("run",
                         fmt::format("run returned {} at {}; it must return a number, math.huge if there is none",
                                     lua::describe(L, -1), place));
        }
        lua_pop(L, 1);
        return value;
    };
    const Spot best = least(cost, ranges.size());
    lua_createtable(L, 0, 4);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        lua_pushnumber(L, ranges[i].at(best.at[i]));
        lua_setfield(L, -2, ranges[i].name.c_str());
    }
    lua_pushnumber(L, best.value);
    lua_setfield(L, -2, "value");
    lua_pushinteger(L, calls);
    lua_setfield(L, -2, "calls");
    return 1;
}

}  // namespace dinal::api
