// How values become Lua: numbers, flags, texts, optionals and lists each by themselves, so that a field is one row.
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "lua/bind.hpp"

namespace dinal::lua {

/// Pushes a number, a flag, a text, a list of such, a table of such by their names, or an object of a class; nil for an
/// optional that is empty.
template <class Value>
void push_value(lua_State* L, const Value& value) {
    if constexpr (std::is_same_v<Value, bool>) {
        lua_pushboolean(L, value ? 1 : 0);
    } else if constexpr (std::is_integral_v<Value>) {
        lua_pushinteger(L, static_cast<lua_Integer>(value));
    } else if constexpr (std::is_floating_point_v<Value>) {
        lua_pushnumber(L, value);
    } else if constexpr (std::is_convertible_v<Value, std::string_view>) {
        push_text(L, value);
    } else if constexpr (requires { value.has_value(); }) {
        value ? push_value(L, *value) : lua_pushnil(L);
    } else if constexpr (requires {
                             value.begin();
                             value.size();
                         }) {
        constexpr bool named = requires {
            value.begin()->second;
        };
        const int size = static_cast<int>(value.size());
        lua_createtable(L, named ? 0 : size, named ? size : 0);
        [[maybe_unused]] lua_Integer i = 0;
        for (const auto& element : value) {
            if constexpr (named) {
                push_value(L, element.second);
                lua_setfield(L, -2, element.first.c_str());
            } else {
                push_value(L, element);
                lua_rawseti(L, -2, ++i);
            }
        }
    } else {
        push<Value>(L, value);
    }
}

/// Sets a field of the table on the top.
template <class Value>
void set_value(lua_State* L, const char* name, const Value& value) {
    push_value(L, value);
    lua_setfield(L, -2, name);
}

/// Pushes a table of these numbers by their names.
inline void push_numbers(lua_State* L, std::initializer_list<std::pair<const char*, double>> numbers) {
    lua_createtable(L, 0, static_cast<int>(numbers.size()));
    for (const auto& [name, number] : numbers) set_value(L, name, number);
}

namespace detail {
template <class Object, auto get>
int read_field(lua_State* L) {
    const Object& object = self<Object>(L, 1, "object.field");
    if constexpr (std::is_invocable_v<decltype(get), const Object&>) {
        push_value(L, std::invoke(get, object));
    } else {
        push_value(L, std::invoke(get, *object));  // a handle, which leads to the object
    }
    return 1;
}
}  // namespace detail

/// A field that is a member of the C++ object, or what a function makes of it.
template <class Object, auto get>
inline constexpr Binding a_value = a_field<detail::read_field<Object, get>>;

}  // namespace dinal::lua
