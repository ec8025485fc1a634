// The table of named options of a constructor or method, checked strictly and once against its rows.
#pragma once

#include <bitset>
#include <string>
#include <string_view>
#include <vector>

#include "lua/bind.hpp"
#include "text/option.hpp"

namespace dinal::lua {

/// Errors name the call, the option, its value and the wanted kind. Strings are not converted to numbers.
class Options {
public:
    /// Reads the table at `index`, which must be the last argument. Raises an error if it is not a table, has
    /// positional entries or an unknown name. If the call may be bare, a missing argument is an empty table, and a
    /// number or string sets the bare option.
    Options(lua_State* L, int index, const text::Call& call);

    /// Fills the options of a T. Raises an error if an option is missing, of another kind, or out of range.
    template <class T>
    void fill(T& object) const {
        fill(&text::detail::owner_tag<T>, &object);
    }

    /// Returns whether the option was given when the call began.
    bool has(std::string_view name) const { return given_[place(name)]; }
    /// Pushes the option unchanged, nil if absent.
    void push(std::string_view name) const;
    /// The option as declared in its row, which must not be of the kind `other`.
    text::OptionValue value(const text::Option& option) const;

    /// For an option of the kind `other`: a number in the range of its row, or the finite numbers of a table or vector
    /// (empty if absent).
    double number(std::string_view name) const;
    std::vector<double> numbers(std::string_view name) const;
    /// The object of one of dinal's classes, kept alive by the option table; nullptr if absent and optional.
    template <class T>
    const T* object(std::string_view name) const {
        push(name);
        const auto* found = test<T>(L_, -1);
        if (found == nullptr && (!lua_isnil(L_, -1) || row(name).otherwise == text::needed)) {
            lua_isnil(L_, -1) ? missing(name) : wrong(name);
        }
        lua_pop(L_, 1);
        return found;
    }

    /// The name of the call, with which all error sentences begin.
    const char* call() const { return call_.name; }
    /// The row of an existing option.
    const text::Option& row(std::string_view name) const;

    /// Raises the error with the call in front: "CALL: SENTENCE".
    [[noreturn]] void fail(text::Error error) const;
    /// Raises an error about that option.
    [[noreturn]] void fail(std::string_view option, std::string sentence) const;
    template <class First, class... Rest>
    [[noreturn]] void fail(std::string_view option, fmt::format_string<First, Rest...> sentence, First&& first,
                           Rest&&... rest) const {
        fail(option, fmt::format(sentence, std::forward<First>(first), std::forward<Rest>(rest)...));
    }
    /// Returns the value, or raises its error.
    template <class T>
    T value_or_fail(text::Expected<T> expected) const {
        if (!expected) {
            fail(expected.error());
        }
        return std::move(expected).value();
    }
    /// Raises "CALL: NAME must be WANTED, got ...".
    [[noreturn]] void wrong(std::string_view name, std::string_view wanted) const;
    [[noreturn]] void wrong(std::string_view name) const { wrong(name, row(name).wanted); }
    /// Raises "CALL needs NAME, for example EXAMPLE".
    [[noreturn]] void missing(std::string_view name) const;

private:
    static constexpr std::size_t most_options = 64;

    void check_table();
    [[noreturn]] void refuse(std::vector<std::string_view>& unknown) const;
    /// The index of the option's row; `most_options` if there is none.
    std::size_t place(std::string_view name) const;
    void fill(const void* owner, void* object) const;
    /// Checks a row and the following rows that are alternatives to it.
    void check_alternatives(std::size_t row) const;
    double number_on_top(const text::Option& option) const;
    std::size_t choice_on_top(const text::Option& option) const;

    lua_State* L_;
    int index_;
    text::Call call_;
    std::bitset<most_options + 1> given_;  ///< whether each row's option was given
};

/// Called for each table of options, within the function that received it.
inline void (*look_at_options)(lua_State* L) = nullptr;

/// Reads a table whose options fill one struct.
template <class T>
[[nodiscard]] T read(lua_State* L, int index, const text::Call& call) {
    const Options options(L, index, call);
    T object{};
    options.fill(object);
    return object;
}

}  // namespace dinal::lua
