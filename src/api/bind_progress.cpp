// progress(n, label): a for loop with a progress line.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "api/classes.hpp"
#include "lua/vector.hpp"
#include "lua/worker_state.hpp"
#include "terminal/progress.hpp"

namespace dinal::api {

namespace {

constexpr const char* example = "for i in progress(100, \"sweep\") do ... end";

/// The state of a loop over progress(...). Its user value is the list it iterates, if any.
struct Loop {
    std::unique_ptr<terminal::Progress> progress;  // null when the loop has ended
    lua_Integer steps = 0;
    bool list = false;
};

Loop& loop_self(lua_State* L) {
    auto* loop = lua::test<Loop>(L, 1);
    if (loop == nullptr) {
        lua::raise(L, {.sentence = fmt::format("progress is for loops: {}", example), .call = "progress"});
    }
    return *loop;
}

/// The iterator of the for loop; receives the Loop and the number of the previous step.
int next_step(lua_State* L) {
    Loop& loop = loop_self(L);
    const lua_Integer step = lua_tointeger(L, 2) + 1;
    if (step < 1 || step > loop.steps || loop.progress == nullptr) {
        loop.progress.reset();
        return 0;
    }
    loop.progress->advance(static_cast<double>(step - 1));
    lua_pushinteger(L, step);
    if (!loop.list) {
        return 1;
    }
    lua_getiuservalue(L, 1, 1);
    lua_geti(L, -1, step);
    lua_remove(L, -2);
    return 2;
}

int close_loop(lua_State* L) {
    loop_self(L).progress.reset();
    return 0;
}

/// The number of steps given by the first argument; none if it is not a valid count.
std::optional<double> steps_of(lua_State* L) {
    if (lua_type(L, 1) == LUA_TTABLE) {
        return static_cast<double>(lua_rawlen(L, 1));
    }
    if (const auto* vector = lua::test<lua::Vector>(L, 1)) {
        return static_cast<double>(vector->size());
    }
    const double n = lua_tonumber(L, 1);
    const bool whole = lua_type(L, 1) == LUA_TNUMBER && n >= 0 && (std::isinf(n) || (n == std::floor(n) && n < 9e15));
    return whole ? std::optional(n) : std::nullopt;
}

int progress(lua_State* L) {
    lua::refuse_in_worker(L, "progress");
    lua_settop(L, 2);
    const auto steps = steps_of(L);
    if (!steps) {
        lua::raise_got(L, 1, "progress", "progress needs the number of steps (math.huge if it is unknown) or a list",
                       fmt::format("; for example {}", example));
    }
    if (!lua_isnil(L, 2) && lua_type(L, 2) != LUA_TSTRING) {
        lua::raise_got(L, 2, "progress", "progress: the label must be a string",
                       fmt::format("; for example {}", example));
    }
    const std::string label = lua_isnil(L, 2) ? "" : lua_tostring(L, 2);
    lua_pushcfunction(L, lua::guarded<next_step>);
    auto& loop = lua::push(L, Loop{.progress = nullptr,
                                   .steps = std::isinf(*steps) ? std::numeric_limits<lua_Integer>::max()
                                                               : static_cast<lua_Integer>(*steps),
                                   .list = lua_type(L, 1) != LUA_TNUMBER});
    loop.progress.reset(new terminal::Progress(
        terminal::Progress::of_steps(label, *steps)));  // NOLINT: Progress cannot be moved, only constructed in place
    lua_pushvalue(L, 1);
    lua_setiuservalue(L, -2, 1);
    lua_pushinteger(L, 0);
    lua_pushvalue(L, -2);  // the closing value removes the progress line however the loop ends
    return 4;
}

constexpr lua::Member loop_members[] = {
    {lua::a_metamethod<close_loop>("__close"), {"", "The loop was left.", ""}},
};

const lua::Class loop_class = {"progress", {example, "The state of a loop that shows its progress.", ""}, loop_members};

constexpr lua::Member progress_module_members[] = {
    {lua::a_function<progress>,
     {"for i in progress(n, label) do, for i, x in progress(list, label) do",
      "A loop of n steps, or over a list (a table or a vector), that shows its progress: after half a second a "
      "line on standard error, if that is a terminal, with label, fraction, rate and remaining time. Runs and "
      "loops within a step count as parts of it. n may be math.huge; leave such a loop with break. A single run "
      "shows the same.",
      "peaks = {}\n"
      "for i, f in progress({ 0.5, 1, 2 }, \"sweep\") do\n"
      "    M = excitation.harmonic{ frequency = f }\n"
      "    peaks[i] = nondimensional{ zeta = 0.1 }:simulate{ M = M, t_end = 20, dt = 0.01 }.theta:max()\n"
      "end\n"
      "print(#peaks)  --> 3"}},
};

void add_progress(lua_State* L, const lua::Class& functions) {
    lua::add_class<Loop>(L, loop_class);
    lua::add_functions(L, functions);
}

}  // namespace

const lua::Class progress_functions = {
    "progress",
    {"for i in progress(n, label) do", "Loops that show their progress.", "for i in progress(3, \"sweep\") do end"},
    progress_module_members,
    add_progress};

}  // namespace dinal::api
