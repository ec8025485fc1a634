// rig:response{ over, at }: the steady motion of several bodies over a list of values.
#include <fmt/format.h>

#include <limits>

#include "api/data.hpp"
#include "api/steady_answer.hpp"
#include "lua/vector.hpp"

namespace dinal::api {
namespace {

/// The name under `over`, and its values.
std::pair<std::string, std::vector<double>> varied(lua_State* L, const lua::Options& options) {
    options.push("over");
    if (!lua_istable(L, -1)) options.wrong("over", options.row("over").wanted);
    lua_pushnil(L);
    if (lua_next(L, -2) == 0 || lua_type(L, -2) != LUA_TSTRING) options.wrong("over", options.row("over").wanted);
    std::string name = lua_tostring(L, -2);
    std::vector<double> values = lua::numbers_at(L, -1, rig_response_call.name, "over." + name);
    lua_pop(L, 1);
    if (lua_next(L, -2) != 0) {
        options.fail("over", "over has more than one name: a response varies one, and sweep varies several");
    }
    lua_pop(L, 1);
    return {std::move(name), std::move(values)};
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
void push_point(lua_State* L, const lua::Options& options, const std::string& name, double x) {
    lua_pushvalue(L, 1);
    options.push("at");
    lua_createtable(L, 0, 1);
    lua::set_number(L, name.c_str(), x);
    lua_call(L, 1, 1);
    if (!lua_istable(L, -1)) {
        options.fail("at",
                     fmt::format("at returned {} for {} = {:.6g}; it must return a table of options of rig:steady, "
                                 "such as {{ belt = {{ load = p.speed }} }}",
                                 lua::describe(L, -1), name, x));
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
    const auto [name, values] = varied(L, options);
    if (!first->named) options.fail("over", "a response is of several bodies, or of one with constant Rd and Re");
    constexpr std::array<const char*, 5> kinds{"amplitude", "peak", "lag", "stops", "stuck"};
    std::vector<std::vector<double>> numbers(kinds.size() * first->joints.size());
    std::vector<double> stable;
    std::vector<std::string> status;
    SteadyHandle near;
    for (const double x : values) {
        push_point(L, options, name, x);
        const int point = lua_gettop(L);
        if (near) start_near(L, point, near->rig->motion, *first);
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
    data.columns.push_back(column_of(name, values));
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
