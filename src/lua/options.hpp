// The one table of named options that a constructor or a method takes, checked strictly and once against its rows.
#pragma once

#include <bitset>
#include <string>
#include <string_view>
#include <vector>

#include "lua/bind.hpp"
#include "text/option.hpp"

namespace dinal::lua {

/// Whatever is wrong is told by a sentence that names the call, the option, its value and what is wanted. Strings are
/// no numbers.
class Options {
public:
    /// The table at `index`, which must be the last argument. Raises when it is no table, has positional entries or a
    /// name that is in no row. When the call may be bare, no argument is an empty table; a number or a string is the
    /// table with the option that it stands for.
    Options(lua_State* L, int index, const text::Call& call);

    /// Fills what the rows of a T say. Raises when an option is missing, of another kind, or out of its range.
    template <class T>
    void fill(T& object) const {
        fill(&text::detail::owner_tag<T>, &object);
    }

    /// The option was given when the call began.
    [[nodiscard]] bool has(std::string_view name) const { return given_[place(name)]; }
    /// Pushes the option as it stands, nil when absent.
    void push(std::string_view name) const;
    /// The option as its row wants it, which must not be of the kind `other`.
    [[nodiscard]] text::OptionValue value(const text::Option& option) const;

    /// Options of the kind `other`: a number in the range of its row; the finite numbers of a table or a vector, none
    /// when it is absent.
    [[nodiscard]] double number(std::string_view name) const;
    [[nodiscard]] std::vector<double> numbers(std::string_view name) const;
    /// An object of one of our classes; the table of options holds it on. nullptr when it is absent and not needed.
    template <class T>
    [[nodiscard]] const T* object(std::string_view name) const {
        push(name);
        const auto* found = test<T>(L_, -1);
        if (found == nullptr && (!lua_isnil(L_, -1) || row(name).otherwise == text::needed)) {
            lua_isnil(L_, -1) ? missing(name) : wrong(name);
        }
        lua_pop(L_, 1);
        return found;
    }

    /// What heads all sentences.
    [[nodiscard]] const char* call() const { return call_.name; }
    /// The row of an option that there is.
    [[nodiscard]] const text::Option& row(std::string_view name) const;

    /// Raises the error as one of this call: "CALL: SENTENCE".
    [[noreturn]] void fail(text::Error error) const;
    /// The same for what is wrong with that option.
    [[noreturn]] void fail(std::string_view option, std::string sentence) const;
    /// The value, or fails with its error.
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
    /// Raises that the call has no options of these names.
    [[noreturn]] void refuse(std::vector<std::string_view>& unknown) const;
    /// Of a row; `most_options` when there is none.
    [[nodiscard]] std::size_t place(std::string_view name) const;
    void fill(const void* owner, void* object) const;
    /// Of that row and those after it that stand instead of it.
    void check_alternatives(std::size_t row) const;
    [[nodiscard]] double number_on_top(const text::Option& option) const;
    [[nodiscard]] std::size_t choice_on_top(const text::Option& option) const;

    lua_State* L_;
    int index_;
    text::Call call_;
    std::bitset<most_options + 1> given_;  ///< by row
};

/// Called for each table of options, in the function that was called with it.
inline void (*look_at_options)(lua_State* L) = nullptr;

/// The table of a call whose options all fill one struct.
template <class T>
[[nodiscard]] T read(lua_State* L, int index, const text::Call& call) {
    const Options options(L, index, call);
    T object{};
    options.fill(object);
    return object;
}

}  // namespace dinal::lua
