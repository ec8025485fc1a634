// Conversion of values to Lua: numbers, flags, texts, optionals and lists, so that a field is one row.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "lua/bind.hpp"
#include "lua/vector.hpp"

namespace dinal::lua {

/// The result of a getter that has pushed its value itself.
struct Pushed {};

/// An argument that can be called.
struct Callable {
    int index;
};

/// A table of numbers by name; Python keeps their order.
using NamedNumbers = std::vector<std::pair<const char*, double>>;

/// Gives the table on the top a metatable that stores the order of its names, such as those of a row of data. Tables
/// with equal names share it.
void note_order(lua_State* L, const NamedNumbers& numbers);

/// Pushes a number, a flag, a text, a list of these, a table of these by name, or an object of a class; nil for an
/// empty optional.
template <class Value>
void push_value(lua_State* L, const Value& value) {
    if constexpr (std::is_same_v<Value, Pushed>) {
        return;
    } else if constexpr (std::is_same_v<Value, bool>) {
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
                             typename Value::value_type;
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
                lua_setfield(L, -2, std::string(element.first).c_str());
            } else {
                push_value(L, element);
                lua_rawseti(L, -2, ++i);
            }
        }
        if constexpr (std::is_same_v<Value, NamedNumbers>) note_order(L, value);
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

/// The string at `index`, or the strings of a list; none for anything else.
inline std::optional<std::vector<std::string>> strings_at(lua_State* L, int index) {
    index = lua_absindex(L, index);
    std::vector<std::string> all;
    if (lua_type(L, index) == LUA_TSTRING) return std::vector<std::string>{lua_tostring(L, index)};
    if (!lua_istable(L, index)) return lua_isnil(L, index) ? std::optional(all) : std::nullopt;
    for (std::size_t i = 1; i <= lua_rawlen(L, index); ++i) {
        const bool text = lua_rawgeti(L, index, static_cast<lua_Integer>(i)) == LUA_TSTRING;
        if (text) all.emplace_back(lua_tostring(L, -1));
        lua_pop(L, 1);
        if (!text) return std::nullopt;
    }
    return all;
}

/// Pushes a copy of the table at `index` without its list entries up to `listed`.
inline void push_copy(lua_State* L, int index, lua_Integer listed = 0) {
    index = lua_absindex(L, index);
    lua_newtable(L);
    for (lua_pushnil(L); lua_next(L, index) != 0;) {
        const bool left_out = lua_isinteger(L, -2) != 0 && lua_tointeger(L, -2) >= 1 && lua_tointeger(L, -2) <= listed;
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        left_out ? lua_pop(L, 2) : lua_rawset(L, -4);
    }
}

namespace detail {
/// The object of the running method.
template <class Object>
const Object& own(lua_State* L) {
    if (const auto* object = lua::test<Object>(L, 1)) return *object;
    raise_no_object(L, signature_of_running(L));
}

template <class Object, auto get>
int read_value(lua_State* L) {
    const auto& object = own<Object>(L);
    if constexpr (std::is_invocable_v<decltype(get), lua_State*, const Object&>) {
        const Object kept = object;  // get may drop the last reference
        push_value(L, std::invoke(get, L, kept));
    } else if constexpr (std::is_invocable_v<decltype(get), const Object&>) {
        push_value(L, std::invoke(get, object));
    } else {
        push_value(L, std::invoke(get, *object));  // dereferences a handle
    }
    return 1;
}

template <class Object, auto get>
inline char kept_key = 0;

template <class Object, auto get>
int read_kept(lua_State* L) {
    static_cast<void>(own<Object>(L));
    if (lua_getiuservalue(L, 1, 1) != LUA_TTABLE) {
        lua_newtable(L);
        lua_pushvalue(L, -1);
        lua_setiuservalue(L, 1, 1);
    }
    if (lua_rawgetp(L, -1, &kept_key<Object, get>) == LUA_TNIL) {
        read_value<Object, get>(L);
        lua_pushvalue(L, -1);
        lua_rawsetp(L, -4, &kept_key<Object, get>);
    }
    return 1;
}
}  // namespace detail

namespace detail {
/// Raises "v:quantile(p): p must be WANTED, got ..." about the argument at `index` of the running function.
[[noreturn]] void raise_argument(lua_State* L, int index, std::string_view wanted);
/// "a vector", for the class with this metatable.
std::string article_and_name(lua_State* L, const void* key);

/// Reads the argument at `index`: a finite number, a string or an object; an optional one may be absent.
template <class T>
decltype(auto) argument(lua_State* L, int index) {
    if constexpr (requires(T t) { t.has_value(); }) {
        return lua_isnoneornil(L, index) ? T() : T(argument<typename T::value_type>(L, index));
    } else if constexpr (std::is_same_v<T, double>) {
        double number = lua_tonumber(L, index);
        if (lua_type(L, index) != LUA_TNUMBER || !std::isfinite(number)) raise_argument(L, index, "a finite number");
        return number;
    } else if constexpr (std::is_same_v<T, std::string>) {
        if (lua_type(L, index) != LUA_TSTRING) raise_argument(L, index, "a string");
        return std::string(lua_tostring(L, index));
    } else if constexpr (std::is_same_v<T, lua_Integer>) {
        int whole = 0;
        lua_Integer number = lua_type(L, index) == LUA_TNUMBER ? lua_tointegerx(L, index, &whole) : 0;
        if (whole == 0) raise_argument(L, index, "a whole number");
        return number;
    } else if constexpr (std::is_same_v<T, Callable>) {
        if (!is_callable(L, index)) raise_argument(L, index, "a function");
        return Callable{index};
    } else {
        if (index == 1) return own<T>(L);
        const auto* object = lua::test<T>(L, index);
        if (object == nullptr) raise_argument(L, index, article_and_name(L, &type_key<T>));
        return *object;
    }
}

/// Pushes the result of a function, a list of numbers as a vector; raises an error with the call in front.
template <class Result>
void push_result(lua_State* L, Result result) {
    if constexpr (std::is_same_v<Result, std::vector<double>>) {
        push_vector(L, std::move(result));
    } else if constexpr (requires { result.error(); }) {
        if (!result) fail(L, signature_of_running(L), result.error());
        push_result(L, std::move(result).value());
    } else {
        push_value(L, result);
    }
}

template <auto function, class Result, class... T, std::size_t... i>
int call_with_state(lua_State* L, Result (* /*type*/)(lua_State*, T...), std::index_sequence<i...> /*places*/) {
    // Braces guarantee the order: the object is checked before its arguments.
    const std::tuple<decltype(argument<std::remove_cvref_t<T>>(L, 1))...> arguments{
        argument<std::remove_cvref_t<T>>(L, static_cast<int>(i) + 1)...};
    push_result(L, std::apply([L](const auto&... each) { return function(L, each...); }, arguments));
    return 1;
}
template <auto function, class Result, class... T>
int call_typed(lua_State* L, Result (*type)(lua_State*, T...)) {
    return call_with_state<function>(L, type, std::index_sequence_for<T...>());
}
template <auto function, class Result, class... T>
int call_typed(lua_State* L, Result (* /*type*/)(T...)) {
    constexpr auto with_state = [](lua_State*, T... arguments) -> Result {
        return function(std::forward<T>(arguments)...);
    };
    return call_with_state<with_state>(L, +with_state, std::index_sequence_for<T...>());
}
template <auto function>
int called(lua_State* L) {
    return call_typed<function>(L, +function);
}
}  // namespace detail

/// Binds a C++ function of the object and its arguments as a method or function; arguments are read and checked by
/// their types.
template <auto function>
inline constexpr Binding a_typed_method = a_method<detail::called<function>>;
template <auto function>
inline constexpr Binding a_typed_function = a_function<detail::called<function>>;

/// Binds a field: a member of the C++ object, or a function of it, or of the Lua state and it.
template <class Object, auto get>
inline constexpr Binding a_value = a_field<detail::read_value<Object, get>>;
/// A field that is computed on first use and kept with the object, so that reading it in a loop is cheap.
template <class Object, auto get>
inline constexpr Binding a_kept_value = a_field<detail::read_kept<Object, get>>;
/// Binds a method without arguments.
template <class Object, auto get>
inline constexpr Binding a_question = a_method<detail::read_value<Object, get>>;
template <class Object, auto get>
inline constexpr Binding a_text = a_metamethod<detail::read_value<Object, get>>("__tostring");
template <class Object, auto get>
inline constexpr Binding a_length = a_metamethod<detail::read_value<Object, get>>("__len");

}  // namespace dinal::lua
