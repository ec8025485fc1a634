// The one table of named options that a constructor or a method takes, checked strictly and once.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lua/bind.hpp"

namespace dinal::lua {

/// Every getter raises a sentence that names the call, the option, its value and what is wanted. Strings are no
/// numbers.
class Options {
public:
    /// The table at `index`, which must be the last argument. `call` heads all sentences ("excitation.pulse"),
    /// `example` shows a right call ("excitation.pulse{ at = 1, width = 0.2 }"), `names` are all the options there are.
    /// Raises when it is no table, has positional entries or an unknown name. With `may_be_absent`, no argument is an
    /// empty table.
    Options(lua_State* L, int index, std::string_view call, std::string_view example,
            std::initializer_list<std::string_view> names, bool may_be_absent = false);

    [[nodiscard]] bool has(std::string_view name) const;

    /// A finite number that must be there; `name = 1` style hints come from the example of the call.
    [[nodiscard]] double number(std::string_view name) const;
    [[nodiscard]] double number(std::string_view name, double otherwise) const;
    [[nodiscard]] std::optional<double> optional_number(std::string_view name) const;
    /// Like number(), but inf and -inf pass; NaN never does.
    [[nodiscard]] double extended_number(std::string_view name, double otherwise) const;

    [[nodiscard]] bool boolean(std::string_view name, bool otherwise) const;
    [[nodiscard]] std::string text(std::string_view name) const;
    /// Which of `choices` it is, as an index; `otherwise` when absent. A wrong one gets a suggestion.
    [[nodiscard]] std::size_t choice(std::string_view name, std::initializer_list<std::string_view> choices,
                                     std::size_t otherwise) const;
    /// A sequence of finite numbers: a table or a vector; empty when absent.
    [[nodiscard]] std::vector<double> numbers(std::string_view name) const;

    /// Pushes the option as it stands, nil when absent.
    void push(std::string_view name) const;

    /// Raises the error as one of this call: "CALL: SENTENCE".
    [[noreturn]] void fail(text::Error error) const;
    [[noreturn]] void fail(std::string_view sentence) const;
    /// Raises "CALL: NAME must be WANTED, got ...".
    [[noreturn]] void wrong(std::string_view name, std::string_view wanted) const;
    /// Raises "CALL needs NAME, for example EXAMPLE".
    [[noreturn]] void missing(std::string_view name) const;

private:
    [[nodiscard]] double checked_number(std::string_view name, bool infinite_too) const;

    lua_State* L_;
    int index_;
    std::string_view call_;
    std::string_view example_;
};

}  // namespace dinal::lua
