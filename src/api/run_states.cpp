// run:at(t), and the columns of a run's own states.
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "api/bodies.hpp"
#include "lua/lua_text.hpp"
#include "lua/user_function.hpp"
#include "lua/vector.hpp"
#include "model/lowered.hpp"
#include "text/suggest.hpp"

namespace dinal::api {

namespace {

/// The answer to a name that is no state of the run: the metamethod __index of run.states.
int no_such_state(lua_State* L) {
    const std::string wanted(lua_type(L, 2) == LUA_TSTRING ? lua::text_at(L, 2) : luaL_typename(L, 2));
    std::vector<std::string> names;
    for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1)) {
        if (lua_type(L, -2) == LUA_TSTRING) names.emplace_back(lua::text_at(L, -2));
    }
    if (names.empty()) {
        lua::raise(L, fmt::format("run.states has no '{}': the run has no states", wanted));
    }
    std::sort(names.begin(), names.end());
    const std::vector<std::string_view> known(names.begin(), names.end());
    lua::raise(L, fmt::format("run.states has no '{}', only {}{}", wanted, fmt::join(names, ", "),
                              text::did_you_mean(wanted, known)));
}

}  // namespace

int run_at(lua_State* L) {
    const RunHandle run =
        lua::self<RunHandle>(L, 1, "run:at(t)");  // kept: the user's function may drop the last reference
    const double t = lua::finite_argument(L, 2, "run:at(t): t");
    lua::CallState call(L);  // between rows the integrator asks the excitation again
    const auto state = run->trajectory.at(t);
    if (call.failed()) {
        call.raise_error();
    }
    if (!state) {
        lua::raise(L, text::in_call("run:at(t)", state.error()));
    }
    lua_pushnumber(L, state->theta);
    lua_pushnumber(L, state->velocity);
    const motion::Trajectory& trajectory = run->trajectory;
    if (trajectory.state_count() == 0 || trajectory.course == nullptr) {
        return 2;
    }
    const std::vector<double> states = trajectory.course->states_at(t);
    lua_createtable(L, 0, static_cast<int>(states.size()));
    for (std::size_t i = 0; i < states.size(); ++i) {
        lua_pushnumber(L, states[i]);
        lua_setfield(L, -2, trajectory.names()[motion::column_count + i].c_str());
    }
    return 3;
}

/// From the equation of motion at the rows.
int run_acceleration(lua_State* L) {
    const RunHandle run = lua::self<RunHandle>(L, 1, "run.acceleration");
    const motion::Trajectory& trajectory = run->trajectory;
    if (run->whole && !run->whole->system->is_link(run->joint)) {
        const bool empty = run->whole->run.table.size() == 0;
        const auto values = empty ? std::span<const double>()
                                  : run->whole->run.table.column(acceleration_column(*run->whole, run->joint));
        lua::push(L, lua::Vector(run, values.data(), values.size()));
        return 1;
    }
    if (!run->origin) {
        if (const auto own = trajectory.find("acceleration")) {
            const auto values = trajectory.rows.col(*own);
            lua::push(L, lua::Vector(run, values.data(), static_cast<std::size_t>(values.size())));
        } else {
            lua_pushnil(L);
        }
        return 1;
    }
    const source::Task& task = *run->origin;
    const model::Lowered system(task.system);
    const auto& walls = task.system.walls();
    using motion::Column;
    const auto t = trajectory.column(Column::t), theta = trajectory.column(Column::theta),
               velocity = trajectory.column(Column::velocity), M = trajectory.column(Column::M),
               friction = trajectory.column(Column::friction), damping = trajectory.column(Column::damping);
    std::vector<double> values = lua::new_numbers(L, static_cast<std::size_t>(trajectory.size()));
    lua::CallState call(L);  // the spring and the base may be functions
    for (Eigen::Index i = 0; i < trajectory.size(); ++i) {
        const bool leans = walls && velocity[i] == 0 && (theta[i] <= walls->lower || theta[i] >= walls->upper);
        const double torque = M[i] - system.pull_back(theta[i]) + friction[i] + damping[i];
        const double base = task.extras.base.components().empty() ? 0 : task.extras.base.value(t[i]);
        values[static_cast<std::size_t>(i)] = leans ? 0 : torque / task.system.inertia() - base + 0.0;
        if (call.failed()) call.raise_error();
    }
    lua::push_vector(L, std::move(values));
    return 1;
}

int run_states(lua_State* L) {
    const RunHandle& run = lua::self<RunHandle>(L, 1, "run.states");
    // In a file, too, what stands after the columns that every run has are states.
    const std::vector<std::string>& names = run->trajectory.names();
    const std::vector<std::string>& always = motion::column_names();
    const bool has_all = names.size() >= always.size() && std::equal(always.begin(), always.end(), names.begin());
    const std::size_t count = has_all ? names.size() - always.size() : 0;
    lua_createtable(L, 0, static_cast<int>(count));
    for (std::size_t i = 0; i < count; ++i) {
        const auto values = run->trajectory.rows.col(static_cast<Eigen::Index>(motion::column_count + i));
        lua::push(L, lua::Vector(run, values.data(), static_cast<std::size_t>(values.size())));
        lua_setfield(L, -2, names[motion::column_count + i].c_str());
    }
    lua_createtable(L, 0, 1);
    lua_pushcfunction(L, lua::guarded<no_such_state>);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
    return 1;
}

}  // namespace dinal::api
