#include "lua/terminal_output.hpp"

#include <atomic>

#include "lua/lua_text.hpp"
#include "terminal/progress.hpp"

namespace dinal::lua {

namespace {

// Lua's own functions, called on the frame of ours, as in coroutines.cpp, and atomic for the same reason.
std::atomic<lua_CFunction> original_print = nullptr;
std::atomic<lua_CFunction> original_write = nullptr;       // io.write
std::atomic<lua_CFunction> original_file_write = nullptr;  // file:write

/// The cursor will stand at the beginning of a line.
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

/// In the table on the top of the stack, which is taken; if there is one, and if it has the function.
void replace(lua_State* L, const char* name, std::atomic<lua_CFunction>& original, lua_CFunction ours) {
    if (lua_istable(L, -1)) {
        lua_getfield(L, -1, name);
        const bool plain = lua_getupvalue(L, -1, 1) == nullptr;  // those of safe mode are not
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
