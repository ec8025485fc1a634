#include "api/events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "lua/bind.hpp"

namespace dinal::api {
namespace {

const char event_key = 0;  // registry keys of the two metatables
const char events_key = 0;

constexpr lua_Integer most_rows = 15;

double number_field(lua_State* L, int event, const char* field) {
    lua_pushstring(L, field);
    lua_rawget(L, event);
    const double value = lua_type(L, -1) == LUA_TNUMBER ? lua_tonumber(L, -1) : 0;
    lua_pop(L, 1);
    return value;
}

std::string kind_field(lua_State* L, int event) {
    lua_pushliteral(L, "kind");
    lua_rawget(L, event);
    std::string kind = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "?";
    lua_pop(L, 1);
    return kind;
}

int push_text(lua_State* L, const std::string& text) {
    lua_pushlstring(L, text.data(), text.size());
    return 1;
}

int event_text(lua_State* L) {
    luaL_checktype(L, 1, LUA_TTABLE);
    return push_text(L,
                     fmt::format("{{ t = {:.6g}, kind = \"{}\", theta = {:.6g}, M = {:.6g} }}", number_field(L, 1, "t"),
                                 kind_field(L, 1), number_field(L, 1, "theta"), number_field(L, 1, "M")));
}

/// "41 events: 39 turns, 1 stick, 1 slip", then a table of the first. The user may have changed the list meanwhile.
int events_text(lua_State* L) {
    luaL_checktype(L, 1, LUA_TTABLE);
    const auto count = static_cast<lua_Integer>(lua_rawlen(L, 1));
    std::vector<std::pair<std::string, int>> kinds = {{"turn", 0}, {"stick", 0}, {"slip", 0}, {"rest", 0}};
    std::string table;
    for (lua_Integer i = 1; i <= count; ++i) {
        if (lua_rawgeti(L, 1, i) == LUA_TTABLE) {
            const std::string kind = kind_field(L, 2);
            const auto known =
                std::find_if(kinds.begin(), kinds.end(), [&kind](const auto& k) { return k.first == kind; });
            if (known == kinds.end()) {
                kinds.emplace_back(kind, 1);
            } else {
                ++known->second;
            }
            if (i <= most_rows) {
                table += fmt::format("\n{:>3} {:<9.6g} {:<5} {:>10.5g} {:>8.4g}", i, number_field(L, 2, "t"),
                                     kind_field(L, 2), number_field(L, 2, "theta"), number_field(L, 2, "M"));
            }
        }
        lua_settop(L, 1);
    }
    std::string text = fmt::format("{} event{}", count, count == 1 ? "" : "s");
    const char* separator = ": ";
    for (const auto& [kind, times] : kinds) {
        if (times > 0) {
            text += fmt::format("{}{} {}{}", separator, times, kind, times == 1 ? "" : "s");
            separator = ", ";
        }
    }
    if (!table.empty()) {
        text += fmt::format("\n  i {:<9} {:<5} {:>10} {:>8}", "t", "kind", "theta", "M") + table;
    }
    if (count > most_rows) {
        text += fmt::format("\n ... and {} more", count - most_rows);
    }
    return push_text(L, text);
}

/// Gives the table on the top its metatable.
void set_metatable(lua_State* L, const void* key, const char* name, lua_CFunction text) {
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, key) != LUA_TTABLE) {
        lua_pop(L, 1);
        lua_createtable(L, 0, 2);
        lua_pushcfunction(L, text);
        lua_setfield(L, -2, "__tostring");
        lua_pushstring(L, name);
        lua_setfield(L, -2, "__name");
        lua_pushvalue(L, -1);
        lua_rawsetp(L, LUA_REGISTRYINDEX, key);
    }
    lua_setmetatable(L, -2);
}

void push_event(lua_State* L, const model::Event& event) {
    lua_createtable(L, 0, 4);
    lua_pushnumber(L, event.t);
    lua_setfield(L, -2, "t");
    const std::string_view kind = model::name(event.kind);
    lua_pushlstring(L, kind.data(), kind.size());
    lua_setfield(L, -2, "kind");
    lua_pushnumber(L, event.theta);
    lua_setfield(L, -2, "theta");
    lua_pushnumber(L, event.M);
    lua_setfield(L, -2, "M");
    set_metatable(L, &event_key, "event", lua::guarded<event_text>);
}

}  // namespace

void push_events(lua_State* L, std::span<const model::Event> events) {
    lua_createtable(L, static_cast<int>(events.size()), 0);
    for (std::size_t i = 0; i < events.size(); ++i) {
        push_event(L, events[i]);
        lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
    }
    set_metatable(L, &events_key, "events", lua::guarded<events_text>);
}

}  // namespace dinal::api
