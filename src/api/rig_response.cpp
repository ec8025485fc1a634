// rig:response{ over, at }: the steady motion of several bodies over a list of values.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "api/data.hpp"
#include "api/steady_answer.hpp"
#include "api/sweep_parameters.hpp"
#include "lua/vector.hpp"

namespace dinal::api {
namespace {

using Point = std::vector<double>;  // a value of each parameter

/// The one or two names under `over`, and their values.
std::vector<DataColumn> varied(lua_State* L, const lua::Options& options) {
    options.push("over");
    if (!lua_istable(L, -1)) options.wrong("over", options.row("over").wanted);
    std::vector<DataColumn> parameters = parameters_in(L, lua_gettop(L), rig_response_call);
    lua_pop(L, 1);
    if (parameters.empty()) options.wrong("over", options.row("over").wanted);
    if (parameters.size() > 2) {
        options.fail("over", fmt::format("over has {} names: a response varies one or two, and sweep varies more",
                                         parameters.size()));
    }
    check_parameters(L, rig_response_call, parameters);
    for (const DataColumn& parameter : parameters) {
        if (parameter.numbers() == nullptr)
            options.fail("over", fmt::format("over.{} must be a list of numbers", parameter.name));
    }
    return parameters;
}

/// All of them, the last parameter fastest.
std::vector<Point> points_of(const std::vector<DataColumn>& parameters) {
    std::vector<Point> points{{}};
    for (const DataColumn& parameter : parameters) {
        std::vector<Point> longer;
        for (const Point& point : points) {
            for (const double x : parameter.numbers()->values()) {
                longer.push_back(point);
                longer.back().push_back(x);
            }
        }
        points = std::move(longer);
    }
    return points;
}

/// Options theta0 and velocity0 at `options`, from a motion that was found nearby, where the user gives neither.
void start_near(lua_State* L, int options, const analysis::RigMotion& near, const model::Assembly& system) {
    for (const char* name : {"theta0", "velocity0"}) {
        const bool given = lua_getfield(L, options, name) != LUA_TNIL;
        lua_pop(L, 1);
        if (given) return;
    }
    for (const auto& [name, values] :
         {std::pair("theta0", &near.drive.theta0), std::pair("velocity0", &near.drive.velocity0)}) {
        lua_createtable(L, 0, static_cast<int>(values->size()));
        for (std::size_t i = 0; i < values->size(); ++i) {
            lua::set_number(L, system.bodies[i].name.c_str(), (*values)[i]);
        }
        lua_setfield(L, options, name);
    }
}

/// What at(point) says, as options of rig:steady, with the system where that is another one: system, options.
void push_point(lua_State* L, const lua::Options& options, const std::vector<DataColumn>& parameters,
                const Point& point) {
    lua_pushvalue(L, 1);
    options.push("at");
    lua_newtable(L);
    for (std::size_t i = 0; i < point.size(); ++i) lua::set_number(L, parameters[i].name.c_str(), point[i]);
    lua_call(L, 1, 1);
    if (!lua_istable(L, -1)) {
        options.fail("at",
                     fmt::format("at returned {} for {} = {:.6g}; it must return a table of options of rig:steady, "
                                 "such as {{ belt = {{ load = p.speed }} }}",
                                 lua::describe(L, -1), parameters.back().name, point.back()));
    }
    lua_newtable(L);  // a copy: the user's table stays as it is
    for (lua_pushnil(L); lua_next(L, -3) != 0;) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, -4);
    }
    lua_remove(L, -2);
    if (lua_getfield(L, -1, "system") != LUA_TNIL) {
        if (lua::test<AssemblyHandle>(L, -1) == nullptr) {
            options.fail(
                "at", fmt::format("at must return a system of several bodies as system, got {}", lua::describe(L, -1)));
        }
        lua_replace(L, -3);
        lua_pushnil(L);
        lua_setfield(L, -2, "system");
    } else {
        lua_pop(L, 1);
    }
}

}  // namespace

int response_of_rig(lua_State* L) {
    const AssemblyHandle first = lua::self<AssemblyHandle>(L, 1, rig_response_call.example);
    const lua::Options options(L, 2, rig_response_call);
    options.push("at");
    if (!lua::is_callable(L, -1)) {
        lua_isnil(L, -1) ? options.missing("at") : options.wrong("at", options.row("at").wanted);
    }
    lua_pop(L, 1);
    const std::vector<DataColumn> parameters = varied(L, options);
    const std::vector<Point> points = points_of(parameters);
    if (!first->named) options.fail("over", "a response is of several bodies, or of one with constant Rd and Re");
    constexpr std::array<const char*, 5> kinds{"amplitude", "peak", "lag", "stops", "stuck"};
    std::vector<std::vector<double>> numbers(kinds.size() * first->joints.size());
    std::vector<double> stable;
    std::vector<std::string> status;
    SteadyHandle near;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i % parameters.back().size() == 0) near = nullptr;
        push_point(L, options, parameters, points[i]);
        const int asked = lua_gettop(L);
        if (near) start_near(L, asked, near->rig->motion, *first);
        lua_pushcfunction(L, lua::guarded<steady_of_rig>);
        lua_insert(L, -3);
        lua_call(L, 2, 1);
        const int found = lua_gettop(L);
        const SteadyHandle s = *lua::test<SteadyHandle>(L, found);
        const model::Assembly& system = *s->rig->question.system;
        near = s->motion.status == analysis::SteadyStatus::steady && s->rig->run != nullptr ? s : nullptr;
        for (std::size_t j = 0; j < first->joints.size(); ++j) {
            if (system.joints.size() != first->joints.size() || system.joints[j].name != first->joints[j].name) {
                options.fail("at", "at must return systems with the same bodies and links");
            }
            lua_getfield(L, found, first->joints[j].name.c_str());
            for (std::size_t k = 0; k < kinds.size(); ++k) {
                lua_getfield(L, -1, kinds[k]);
                const bool grows = s->motion.status == analysis::SteadyStatus::grows && k < 2;
                const double none =
                    grows ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
                numbers[j * kinds.size() + k].push_back(lua_isnil(L, -1) ? none : lua_tonumber(L, -1));
                lua_pop(L, 1);
            }
            lua_pop(L, 1);
        }
        stable.push_back(is_found(*s) && s->motion.stable ? 1 : 0);
        status.emplace_back(analysis::name(s->motion.status));
        lua_settop(L, 2);
    }
    Data data;
    const ColumnUnits in(first->units);
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        std::vector<double> values(points.size());
        std::transform(points.begin(), points.end(), values.begin(), [k](const Point& point) { return point[k]; });
        data.columns.push_back(column_of(parameters[k].name, std::move(values)));
        if (parameters.size() > 1) data.parameters.push_back(parameters[k].name);
    }
    for (std::size_t j = 0; j < first->joints.size(); ++j) {
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            data.columns.push_back(column_of(fmt::format("{}.{}", first->joints[j].name, kinds[k]),
                                             std::move(numbers[j * kinds.size() + k]),
                                             k < 2    ? in.theta
                                             : k == 2 ? "rad"
                                                      : ""));
        }
    }
    data.columns.push_back(column_of("stable", std::move(stable)));
    data.columns.push_back(column_of("status", std::move(status)));
    push_data(L, std::move(data));
    return 1;
}

}  // namespace dinal::api
