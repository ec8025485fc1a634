#include "errors/error_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "errors/excerpt.hpp"
#include "errors/misspelling.hpp"
#include "errors/source_text.hpp"
#include "lua/tokens.hpp"
#include "source/function_source.hpp"

namespace dinal::errors {
namespace {

const char memory_key = 0;  // registry key of { error value, suggestion, excerpt, during, raised again }

Remarks fresh_remarks(lua_State* L, std::string_view text) {
    Remarks remarks;
    const auto message = parse_message(text);
    if (!message) {
        return remarks;
    }
    lua_Debug frame{};
    const bool there = find_frame(L, *message, frame);
    const auto source = there ? source_of_frame(L, frame) : source_running(L, message->chunk);
    const std::string_view statement = source ? source->statement(message->line) : std::string_view();
    remarks.suggestion = help_with(L, there ? &frame : nullptr, message->words, statement);
    if (source) {
        remarks.excerpt = excerpt(*source, *message, remarks.suggestion);
    }
    return remarks;
}

std::string text_item(lua_State* L, int table, int item) {
    lua_rawgeti(L, table, item);
    std::string text = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "";
    lua_pop(L, 1);
    return text;
}

/// Pushes the table of remembered remarks on the error value at `index`; false (and nothing) when there are none.
bool push_memory(lua_State* L, int index) {
    index = lua_absindex(L, index);
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &memory_key) == LUA_TTABLE) {
        lua_rawgeti(L, -1, 1);
        const bool same = lua_rawequal(L, -1, index) != 0;
        lua_pop(L, 1);
        if (same) {
            return true;
        }
    }
    lua_pop(L, 1);
    return false;
}

void set_item(lua_State* L, int item, const std::string& text) {
    lua_pushlstring(L, text.data(), text.size());
    lua_rawseti(L, -2, item);
}

/// The remarks on the error value on the top.
void remember(lua_State* L, const Remarks& remarks) {
    lua_createtable(L, 4, 0);
    lua_pushvalue(L, -2);
    lua_rawseti(L, -2, 1);
    set_item(L, 2, remarks.suggestion);
    set_item(L, 3, remarks.excerpt);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &memory_key);
}

}  // namespace

Remarks remarks_on(lua_State* L, int index) {
    luaL_checkstack(L, LUA_MINSTACK, "for the remarks on an error");
    index = lua_absindex(L, index);
    if (push_memory(L, index)) {
        const int memory = lua_gettop(L);
        Remarks remarks{text_item(L, memory, 2), text_item(L, memory, 3), text_item(L, memory, 4)};
        lua_pop(L, 1);
        return remarks;
    }
    if (lua_type(L, index) != LUA_TSTRING) {
        return {};
    }
    return fresh_remarks(L, lua_tostring(L, index));
}

Remarks remarks_on_syntax(lua_State* L, int index, const char* file) {
    const std::string text = lua_tostring(L, index);
    const auto message = parse_message(text);
    if (!message) {
        return {};
    }
    const auto source = file != nullptr ? source_of_file(file) : source_kept(L, message->chunk);
    const std::string_view statement = source ? source->statement(message->line) : std::string_view();
    Remarks remarks;
    remarks.suggestion = help_with(L, nullptr, message->words, statement);
    remarks.excerpt = source ? syntax_excerpt(L, *source, *message) : "";
    return remarks;
}

int remember_remarks(lua_State* L) {
    // NOTE: texts that are equal may be two errors; it is the same one only when it has been raised again.
    if (push_memory(L, 1)) {
        const bool again = lua_rawgeti(L, -1, 5) == LUA_TBOOLEAN;
        lua_pop(L, 1);
        lua_pushnil(L);
        lua_rawseti(L, -2, 5);
        lua_settop(L, 1);
        if (again) {
            return 1;
        }
    }
    remember(L, lua_type(L, 1) == LUA_TSTRING ? fresh_remarks(L, lua_tostring(L, 1)) : Remarks{});
    return 1;
}

void remember_result(lua_State* L, int index) {
    luaL_checkstack(L, LUA_MINSTACK, "for the remarks on an error");
    index = lua_absindex(L, index);
    const std::string text = lua_tostring(L, -1);
    const auto message = parse_message(text);
    Remarks remarks;
    if (const auto function = source::function_source(L, index); message && function) {
        const SourceText source{*function, message->line};
        const std::vector<lua::Token> all = lua::tokens(source.text);
        const bool returns = std::any_of(all.begin(), all.end(), [](const lua::Token& t) { return t.is("return"); });
        remarks.suggestion =
            message->words.starts_with("M returned nil") && !returns ? "; is the word return missing?" : "";
        remarks.excerpt = excerpt(source, *message, remarks.suggestion);
    }
    remember(L, remarks);
}

void remember_time(lua_State* L, double t) {
    luaL_checkstack(L, LUA_MINSTACK, "for the remarks on an error");
    if (push_memory(L, -1)) {
        const int memory = lua_gettop(L);
        set_item(L, 4, text_item(L, memory, 4) + fmt::format("\n  in M at t = {:.14g}", t));
        lua_pop(L, 1);
    }
}

void keep_remarks(lua_State* L) {
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &memory_key) == LUA_TTABLE) {
        lua_pushboolean(L, 1);
        lua_rawseti(L, -2, 5);
    }
    lua_pop(L, 1);
}

}  // namespace dinal::errors
