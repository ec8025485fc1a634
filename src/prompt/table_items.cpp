#include "prompt/table_items.hpp"

#include <algorithm>
#include <string_view>

#include "lua/lua_text.hpp"

namespace dinal::prompt {
namespace {

constexpr std::size_t most_sorted_keys = 500;  // beyond, the first that Lua finds are shown

/// How many of 1, 2, ... there are. NOTE: not the border of rawlen, which may lie behind holes.
std::size_t list_length(lua_State* L, int index) {
    const auto border = static_cast<lua_Integer>(lua_rawlen(L, index));
    for (lua_Integer n = 0; n < border; ++n) {
        const bool hole = lua_rawgeti(L, index, n + 1) == LUA_TNIL;
        lua_pop(L, 1);
        if (hole) {
            return static_cast<std::size_t>(n);
        }
    }
    return static_cast<std::size_t>(border);
}

}  // namespace

TableItems::TableItems(lua_State* L, int index) : L_(L), table_(index), listed_(list_length(L, index)) {
    lua_newtable(L_);
    keys_ = lua_gettop(L_);
    collect();
    std::sort(order_.begin(), order_.end());
}

void TableItems::push(std::size_t i) const {
    if (in_list(i)) {
        lua_pushinteger(L_, static_cast<lua_Integer>(i) + 1);
    } else {
        lua_rawgeti(L_, keys_, std::get<lua_Integer>(order_[i - listed_]));
    }
    lua_pushvalue(L_, -1);
    lua_rawget(L_, table_);
}

bool TableItems::key_is_listed() const {
    const lua_Integer i = lua_isinteger(L_, -2) != 0 ? lua_tointeger(L_, -2) : 0;
    return i >= 1 && static_cast<std::size_t>(i) <= listed_;
}

void TableItems::collect() {
    lua_pushnil(L_);
    while (lua_next(L_, table_) != 0) {
        if (!key_is_listed()) {
            ++others_;
            if (others_ <= most_sorted_keys) {
                add_key();
            }
        }
        lua_pop(L_, 1);
    }
}

void TableItems::add_key() {
    const auto place = static_cast<lua_Integer>(others_);
    lua_pushvalue(L_, -2);
    if (lua_type(L_, -1) == LUA_TNUMBER) {
        order_.emplace_back(0, lua_tonumber(L_, -1), "", place);
    } else if (lua_type(L_, -1) == LUA_TSTRING) {
        const std::string_view name = lua::text_at(L_, -1);
        order_.emplace_back(name == "t" ? 1 : 2, 0, std::string(name), place);
    } else {
        order_.emplace_back(3, 0, "", place);
    }
    lua_rawseti(L_, keys_, place);
}

}  // namespace dinal::prompt
