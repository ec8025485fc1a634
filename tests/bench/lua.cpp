// The rows of work.lua, each a benchmark.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>

#include "help/library.hpp"
#include "items.hpp"

namespace bench {
namespace {

/// The state of Lua with the table of rows on its stack; ends the program when it cannot be made.
lua_State* work() {
    static const std::unique_ptr<lua_State, decltype(&lua_close)> state(luaL_newstate(), lua_close);
    lua_State* L = state.get();
    if (lua_gettop(L) > 0) return L;
    luaL_openlibs(L);
    dinal::help::open_library(L);
    for (const auto& [name, value] : {std::pair{"PROGRAM", DINAL_PROGRAM}, {"EXAMPLES", DINAL_EXAMPLES}}) {
        lua_pushstring(L, value);
        lua_setglobal(L, name);
    }
    if (luaL_dofile(L, DINAL_WORK) != LUA_OK) {
        std::cerr << "bench: " << lua_tostring(L, -1) << '\n';
        std::exit(1);
    }
    return L;
}

/// Field `name` of the table at the top, as text; empty when it is nil.
std::string text_of(lua_State* L, const char* name) {
    lua_getfield(L, -1, name);
    const char* text = lua_tostring(L, -1);
    std::string own = text == nullptr ? "" : text;
    lua_pop(L, 1);
    return own;
}

double number_of(lua_State* L, const char* name) {
    lua_getfield(L, -1, name);
    const double number = lua_tonumber(L, -1);
    lua_pop(L, 1);
    return number;
}

void measure(benchmark::State& state, lua_Integer row) {
    lua_State* L = work();
    for ([[maybe_unused]] auto iteration : state) {
        lua_settop(L, 1);
        lua_geti(L, 1, row);
        lua_getfield(L, -1, "run");
        if (lua_pcall(L, 0, 0, 0) != LUA_OK) return state.SkipWithError(lua_tostring(L, -1));
    }
}

}  // namespace

void register_work(Results& results) {
    lua_State* L = work();
    for (lua_Integer row = 1; lua_geti(L, 1, row) == LUA_TTABLE; ++row, lua_pop(L, 1)) {
        Item& item = results.of(text_of(L, "group"), text_of(L, "name"));
        item.per = text_of(L, "per"), item.unit = text_of(L, "unit");
        item.count = number_of(L, "count"), item.most = number_of(L, "most");
        lua_getfield(L, -1, "against");
        if (lua_istable(L, -1)) {
            lua_geti(L, -1, 1), lua_geti(L, -2, 2);
            item.against = {lua_tostring(L, -2), lua_tostring(L, -1)};
            lua_pop(L, 2);
        }
        lua_pop(L, 1);
        auto* registered = benchmark::RegisterBenchmark((item.group + "/" + item.name).c_str(),
                                                        [row](benchmark::State& state) { measure(state, row); });
        lua_getfield(L, -1, "by_clock");
        if (lua_toboolean(L, -1)) registered->UseRealTime();
        lua_pop(L, 1);
    }
    lua_settop(L, 1);
}

}  // namespace bench
