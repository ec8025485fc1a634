// Binds C++ to Lua: classes and modules as tables of documented members, typed userdata, errors at the user's line.
//
// One Lua class is one file bind_x.cpp with one `Class`: name, documentation, members. add_class(), add_module() and
// add_functions() make metatables and tables from it; help() and docs/manual.md read the same data.
#pragma once

#include <array>
#include <cstddef>
#include <exception>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "lua/lua_headers.hpp"
#include "lua/memory_limit.hpp"
#include "text/expected.hpp"
#include "text/option.hpp"
#include "text/suggest.hpp"  // did_you_mean, for every unknown name

namespace dinal::terminal {
struct Display;
}

namespace dinal::lua {

/// The documentation of a member, stored once.
struct Doc {
    const char* signature;  ///< call as a user writes it: "sys:simulate{ OPTIONS } -> run"
    const char* summary;    ///< one or more sentences, units included
    const char* example;    ///< Lua that runs on its own; `-->` is followed by what the line prints
    /// The options for each OPTIONS in the signature, in this order.
    std::array<const text::Call*, 2> calls = {};
};

enum class Kind {
    function,    ///< called with a dot: integrator.rk4{...}
    method,      ///< called with a colon: run:at(t)
    field,       ///< read like a variable; `call` receives the object and pushes one value
    metamethod,  ///< __add, __len, __call ...: for the objects of a class, or for the table of a module
};

/// The function and kind of a member, made by a_method<at>, a_field<...>, a_function<...> or
/// a_metamethod<...>("__len").
struct Binding {
    lua_CFunction call;  ///< always guarded<...>
    Kind kind;
    std::string_view name = {};  ///< for metamethods; others are named in their signature
};

struct Member {
    std::string_view name = {};
    lua_CFunction call = nullptr;
    Kind kind = Kind::function;
    Doc doc = {};

    constexpr Member() = default;
    constexpr Member(const Binding& binding, const Doc& text)
        : name(binding.name.empty() ? name_in(text.signature) : binding.name),
          call(binding.call),
          kind(binding.kind),
          doc(text) {}
    constexpr Member(std::string_view own_name, lua_CFunction function, Kind how, const Doc& text)
        : name(own_name), call(function), kind(how), doc(text) {}

private:
    /// Returns "at" for "run:at(t) -> theta, velocity".
    static constexpr std::string_view name_in(std::string_view signature) {
        signature = signature.substr(0, signature.find(" ->"));
        signature = signature.substr(0, signature.find_first_of("({"));
        return signature.substr(signature.find_last_of(".: ") + 1);
    }
};

/// A Lua class or a Lua module.
struct Class {
    const char* name;  ///< as in "a system has no field ..."
    Doc doc;
    std::span<const Member> members;
    /// Registers it in the library table on the top of the stack: add_class<T>, add_module or add_functions.
    void (*add)(lua_State* L, const Class& description) = nullptr;
    /// Called with (object, key) for a number key, and for strings that name no member. Pushes one value and returns 1,
    /// or returns 0 for "no such field", which becomes an error with a suggestion.
    lua_CFunction other_keys = nullptr;
    /// Returns the prompt's text for the object at `index`; by default the text of tostring.
    std::string (*card)(lua_State* L, int index, const terminal::Display& screen) = nullptr;
    /// Like other_keys, for strings that take precedence over members.
    lua_CFunction first_keys = nullptr;
};

/// A section of the manual: a module, a class or a set of functions.
struct Section {
    const char* title;   ///< "excitation", "An excitation"
    const char* prefix;  ///< prefix of a member: "excitation.", "e:", ""
    const Class* description;
};

/// Raises a Lua error with the file and line of the user's code in front. Its facts are kept (error_memory.hpp) for
/// error markers and hints.
[[noreturn]] void raise(lua_State* L, const text::Error& error);
[[noreturn]] void raise(lua_State* L, std::string_view sentence);
template <class First, class... Rest>
[[noreturn]] void raise(lua_State* L, fmt::format_string<First, Rest...> sentence, First&& first, Rest&&... rest) {
    raise(L, text::error(sentence, std::forward<First>(first), std::forward<Rest>(rest)...));
}

/// Raises the error with the call in front: "CALL: SENTENCE".
[[noreturn]] inline void fail(lua_State* L, std::string_view call, text::Error error) {
    raise(L, text::in_call(call, std::move(error)));
}
template <class First, class... Rest>
[[noreturn]] void fail(lua_State* L, std::string_view call, fmt::format_string<First, Rest...> sentence, First&& first,
                       Rest&&... rest) {
    fail(L, call, text::error(sentence, std::forward<First>(first), std::forward<Rest>(rest)...));
}

/// Raises "WANTED, got VALUE" plus `end`, about the value at `index` in the call.
[[noreturn]] void raise_got(lua_State* L, int index, std::string_view call, std::string_view wanted,
                            std::string_view end = "");

/// "FILE:LINE: " of the innermost Lua function in the call stack, or "".
std::string where(lua_State* L);

/// Returns the value, or raises its error with the call in front.
template <class T>
T value_or_raise(lua_State* L, std::string_view call, text::Expected<T> expected) {
    if (!expected) {
        raise(L, text::in_call(call, expected.error()));
    }
    return std::move(expected).value();
}

/// Pushes a text and returns 1, the number of Lua results.
int push_text(lua_State* L, std::string_view text);
/// Push a field of the table at `index`, or a global, and return its type. Raw: metamethods are a user's code, and a
/// strict _G raises errors.
int push_field(lua_State* L, int index, std::string_view name);
int push_global(lua_State* L, std::string_view name);
/// Pushes the table under this key of the registry; makes it if there is none, with weak keys.
void push_weak_table(lua_State* L, const void* key);

/// Sets a numeric field of the table on the top of the stack.
void set_number(lua_State* L, const char* name, double value);

/// Describes a value for a sentence: "nil", "a table", "the string "1"", "a system", "nan".
std::string describe(lua_State* L, int index);

/// Returns whether Lua can call it: a Lua function, a C function, a table or userdata with __call.
[[nodiscard]] bool is_callable(lua_State* L, int index);

/// The value as in the user's text, for Error::culprit: "nil", "-1", a string itself; "" for others.
std::string written(lua_State* L, int index);

namespace detail {
int raise_message_on_top(lua_State* L);
[[noreturn]] void raise_no_object(lua_State* L, std::string_view call);
/// The signature of the running bound function: "run:explain()".
std::string signature_of_running(lua_State* L);
void push_message(lua_State* L, const char* text);
}  // namespace detail

/// Wraps every C++ function that Lua calls: a C++ exception becomes a Lua error at the user's line.
// NOTE: never catch (...): Lua's own errors are C++ exceptions of a private type and must pass.
template <lua_CFunction function>
int guarded(lua_State* L) {
    try {
        collect_when_tight(L);
        return function(L);
    } catch (const std::bad_alloc&) {
        detail::push_message(L, "not enough memory");
    } catch (const std::exception& problem) {
        detail::push_message(L, problem.what());
    }
    return detail::raise_message_on_top(L);
}

template <lua_CFunction function>
inline constexpr Binding a_function{guarded<function>, Kind::function};
template <lua_CFunction method>
inline constexpr Binding a_method{guarded<method>, Kind::method};
template <lua_CFunction getter>
inline constexpr Binding a_field{guarded<getter>, Kind::field};
template <lua_CFunction function>
constexpr Binding a_metamethod(std::string_view name) {
    return {guarded<function>, Kind::metamethod, name};
}

namespace detail {
// Its address is the registry key of T's metatable.
template <class T>
inline char type_key = 0;

void push_metatable(lua_State* L, const void* key);
void* test(lua_State* L, int index, const void* key);
void add_class(lua_State* L, const Class& description, const void* key, lua_CFunction collect);

template <class T>
int collect(lua_State* L) {
    if (auto* object = static_cast<T*>(test(L, 1, &type_key<T>))) {
        std::destroy_at(object);
        // A finalizer called by hand (debug.getmetatable) must not leave a dead object.
        lua_pushnil(L);
        lua_setmetatable(L, 1);
    }
    return 0;
}
}  // namespace detail

/// Pushes a new object of a class registered by add_class<T>. It has one user value.
template <class T>
T& push(lua_State* L, T value) {
    static_assert(alignof(T) <= alignof(std::max_align_t));
    static_assert(std::is_nothrow_move_constructible_v<T>);
    luaL_checkstack(L, 3, "too many values");
    T* object = std::construct_at(static_cast<T*>(lua_newuserdatauv(L, sizeof(T), 1)), std::move(value));
    detail::push_metatable(L, &detail::type_key<T>);
    lua_setmetatable(L, -2);
    return *object;
}

/// Returns the object at `index`, or nullptr for anything else.
template <class T>
[[nodiscard]] T* test(lua_State* L, int index) {
    return static_cast<T*>(detail::test(L, index, &detail::type_key<T>));
}

/// Returns the object of a method call. `call` is a correct example for the error: "sys:simulate{ t_end = 20, dt = 0.01
/// }".
template <class T>
[[nodiscard]] T& self(lua_State* L, int index, std::string_view call) {
    T* object = test<T>(L, index);
    if (object == nullptr) {
        detail::raise_no_object(L, call);
    }
    return *object;
}

/// Returns the finite number at `index`; otherwise raises an error that begins with `what`: "run:at(t): t".
double finite_argument(lua_State* L, int index, std::string_view what);

/// Registers T. Its objects look up methods, fields, and `other_keys`; an unknown name is an error with a suggestion,
/// and every assignment is an error. Leaves the stack unchanged.
template <class T>
void add_class(lua_State* L, const Class& description) {
    detail::add_class(L, description, &detail::type_key<T>, detail::collect<T>);
}

/// Sets library[module.name] to a table of the module's functions, in the library table on the top. A metamethod
/// "__call" makes that table callable, with itself as first argument. An unknown name is an error.
void add_module(lua_State* L, const Class& module);

/// Sets the functions in the library table on the top.
void add_functions(lua_State* L, const Class& functions);

/// The documentation of a value, or nullptrs: a function (the member and its owner), a module or an object.
struct Documented {
    const Class* owner = nullptr;
    const Member* member = nullptr;
};
Documented documented(lua_State* L, int index);

}  // namespace dinal::lua
