// Where the cursor stands in a text that is being typed: in a name, a string, the options of a call.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "help/signature.hpp"
#include "lua/tokens.hpp"

namespace dinal::prompt {

enum class Cursor { name, member, option, value, string, nothing };

/// A call whose brackets are open at the cursor.
struct OpenCall {
    std::span<const lua::Token> function;       ///< the tokens before the bracket: sys : simulate
    bool options = false;                       ///< the cursor is in a table of options,
    help::Braces braces = help::Braces::alone;  ///< which is passed like this
    /// From the options of the call to the table with the cursor: the names that lead there, "" in a list:
    /// events, "" in f{ events = { { ... } } }.
    std::vector<std::string_view> path = {};
    std::vector<std::string_view> given = {};  ///< the options that are there already
    std::string_view option = {};              ///< the one whose value the cursor is at
};

/// What stands before the cursor. Refers to the text.
class TypedText {
public:
    explicit TypedText(std::string_view before);
    TypedText(const TypedText&) = delete;
    TypedText& operator=(const TypedText&) = delete;

    [[nodiscard]] Cursor cursor() const { return cursor_; }
    /// The part of a name, or of a string, that is there already.
    [[nodiscard]] std::string_view word() const { return word_; }
    /// Of Cursor::member: the tokens before the separator, and the separator, '.' or ':'.
    [[nodiscard]] std::span<const lua::Token> owner() const { return owner_; }
    [[nodiscard]] char separator() const { return separator_; }
    [[nodiscard]] const std::optional<OpenCall>& call() const { return call_; }
    [[nodiscard]] const std::vector<lua::Token>& tokens_before() const { return tokens_; }

private:
    void find_cursor(std::string_view before);
    void find_call();
    [[nodiscard]] std::span<const lua::Token> expression_before(std::size_t end) const;
    [[nodiscard]] std::vector<std::size_t> open_brackets() const;
    [[nodiscard]] std::optional<std::string_view> name_of_table(std::size_t bracket, std::size_t outer) const;

    std::vector<lua::Token> tokens_;  // without the word at the cursor
    Cursor cursor_ = Cursor::nothing;
    std::string_view word_;
    std::span<const lua::Token> owner_;
    char separator_ = ' ';
    std::optional<OpenCall> call_;
};

}  // namespace dinal::prompt
