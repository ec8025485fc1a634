#include "lua/standard_globals.hpp"

#include <algorithm>
#include <atomic>
#include <string_view>

#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "terminal/progress.hpp"

namespace dinal::lua {
namespace {

const char dinal_key = 0;     // in the registry, where `dinal = nil` has no effect
const char standard_key = 0;  // registry key of the initial copy of _G
const char fields_key = 0;    // in a table of libraries: a copy of each one's initial fields

/// Copies all fields of one table to another.
void copy_fields(lua_State* L, int from, int to) {
    lua_pushnil(L);
    while (lua_next(L, from) != 0) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, to);
    }
}

/// Copies the fields of the libraries in the table on the top, which is a copy of _G.
void note_fields(lua_State* L) {
    const int globals = lua_gettop(L);
    lua_newtable(L);
    lua_pushnil(L);
    while (lua_next(L, globals) != 0) {
        if (lua_istable(L, -1)) {
            lua_newtable(L);
            copy_fields(L, lua_gettop(L) - 1, lua_gettop(L));
            lua_rawset(L, globals + 1);  // library -> copy; lua_next continues from its name
            continue;
        }
        lua_pop(L, 1);
    }
    lua_rawsetp(L, LUA_REGISTRYINDEX, &fields_key);
}

/// Restores the initial fields of the libraries.
void reset_fields(lua_State* L) {
    const int top = lua_gettop(L);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &fields_key);
    lua_pushnil(L);
    while (lua_next(L, top + 1) != 0) {
        copy_fields(L, lua_gettop(L), lua_gettop(L) - 1);
        lua_pop(L, 1);
    }
    lua_settop(L, top);
}

}  // namespace

void make_dinal_table(lua_State* L) {
    lua_newtable(L);
    lua_pushvalue(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &dinal_key);
}

void push_dinal_table(lua_State* L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &dinal_key);
}

bool is_global_table(lua_State* L, int index) {
    index = lua_absindex(L, index);
    lua_pushglobaltable(L);
    const bool same = lua_rawequal(L, -1, index) != 0;
    lua_pop(L, 1);
    return same;
}

void copy_fields(lua_State* L) {
    lua_pushnil(L);
    while (lua_next(L, -3) != 0) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, -4);
    }
}

void note_standard_globals(lua_State* L) {
    lua_newtable(L);
    lua_pushglobaltable(L);
    copy_fields(L, lua_gettop(L), lua_gettop(L) - 1);
    lua_pop(L, 1);
    note_fields(L);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &standard_key);
}

bool is_overwritten(lua_State* L, std::string_view name, std::string_view field) {
    const int top = lua_gettop(L);
    push_standard_globals(L);
    push_field(L, -1, name);
    if (!field.empty()) {  // a library: its initial table, and the copy of its fields
        lua_rawgetp(L, LUA_REGISTRYINDEX, &fields_key);
        lua_pushvalue(L, -2);
        lua_rawget(L, -2);
        if (lua_istable(L, -1)) {
            push_field(L, -1, field);
            lua_pushvalue(L, top + 2);
            push_field(L, -1, field);
        } else {
            lua_settop(L, top);
            return false;
        }
    } else {
        push_global(L, name);
    }
    const int before = field.empty() ? top + 2 : lua_gettop(L) - 2;
    const bool was = !lua_isnil(L, before);
    const bool overwritten = was && lua_rawequal(L, before, -1) == 0;
    lua_settop(L, top);
    return overwritten;
}

bool is_of_dinal(lua_State* L, std::string_view name) {
    push_dinal_table(L);
    const bool has = push_field(L, -1, name) != LUA_TNIL;
    lua_pop(L, 2);
    return has;
}

void push_standard_globals(lua_State* L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &standard_key);
}

void push_standard_fields(lua_State* L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &fields_key);
}

std::vector<std::string> users_globals(lua_State* L) {
    std::vector<std::string> names;
    const int top = lua_gettop(L);
    push_standard_globals(L);
    lua_pushglobaltable(L);
    lua_pushnil(L);
    while (lua_next(L, top + 2) != 0) {
        lua_pushvalue(L, -2);
        lua_rawget(L, top + 1);
        const bool ours = lua_rawequal(L, -1, -2) != 0;
        lua_pop(L, 2);
        if (!ours && lua_type(L, -1) == LUA_TSTRING) {
            names.emplace_back(lua_tostring(L, -1));
        }
    }
    lua_settop(L, top);
    // The program sets these after the others were recorded.
    std::erase_if(names, [](std::string_view name) { return name == "dinal" || name == "arg"; });
    std::ranges::sort(names);
    return names;
}

void reset_globals(lua_State* L) {
    const int top = lua_gettop(L);
    lua_pushglobaltable(L);
    for (const std::string& name : users_globals(L)) {
        lua_pushlstring(L, name.data(), name.size());
        lua_pushnil(L);
        lua_rawset(L, top + 1);
    }
    push_standard_globals(L);
    copy_fields(L, top + 2, top + 1);
    reset_fields(L);
    lua_pushliteral(L, "dinal");
    push_dinal_table(L);
    lua_rawset(L, top + 1);
    lua_settop(L, top);
}

namespace {

// Lua's own functions, called on our frame as in interrupt.cpp; atomic for the same reason.
std::atomic<lua_CFunction> original_print = nullptr;
std::atomic<lua_CFunction> original_write = nullptr;       // io.write
std::atomic<lua_CFunction> original_file_write = nullptr;  // file:write

/// Returns whether the cursor will be at the beginning of a line.
bool last_ends_line(lua_State* L) {
    return lua_type(L, -1) == LUA_TSTRING && text_at(L, -1).ends_with('\n');
}

int print(lua_State* L) {
    terminal::make_way_for_output(true);
    return original_print.load()(L);
}

int write_below_progress(lua_State* L) {
    terminal::make_way_for_output(last_ends_line(L));
    return original_write.load()(L);
}

int file_write(lua_State* L) {
    const auto* file = static_cast<luaL_Stream*>(luaL_testudata(L, 1, LUA_FILEHANDLE));
    if (file != nullptr && (file->f == stdout || file->f == stderr)) {
        terminal::make_way_for_output(last_ends_line(L));
    }
    return original_file_write.load()(L);
}

/// Replaces a function in the table on the top, if both exist, and pops the table.
void replace(lua_State* L, const char* name, std::atomic<lua_CFunction>& original, lua_CFunction ours) {
    if (lua_istable(L, -1)) {
        lua_getfield(L, -1, name);
        const bool plain = lua_getupvalue(L, -1, 1) == nullptr;  // those of safe mode have upvalues
        const lua_CFunction present = plain ? lua_tocfunction(L, -1) : nullptr;
        lua_pop(L, plain ? 1 : 2);
        if (present != nullptr && present != ours) {
            original = present;
            lua_pushcfunction(L, ours);
            lua_setfield(L, -2, name);
        }
    }
    lua_pop(L, 1);
}

}  // namespace

void open_terminal_output(lua_State* L) {
    lua_pushglobaltable(L);
    replace(L, "print", original_print, print);
    if (luaL_getmetatable(L, LUA_FILEHANDLE) == LUA_TTABLE) {
        lua_getfield(L, -1, "__index");
        replace(L, "write", original_file_write, file_write);
        lua_getglobal(L, LUA_IOLIBNAME);
        replace(L, "write", original_write, write_below_progress);
    }
    lua_pop(L, 1);
}

}  // namespace dinal::lua
