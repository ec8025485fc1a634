// Tab: the possible continuations of the text before the cursor. Runs no user code.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "help/library.hpp"
#include "lua/lua_headers.hpp"
#include "lua/lua_text.hpp"
#include "text/not_copied.hpp"

namespace dinal::prompt {

struct Completion {
    std::vector<std::string> names;  ///< whole words with the following text: "simulate{", "theta0 = "
    bool files = false;              ///< whether file names are possible
};

/// `before` is the text of the chunk up to the cursor.
Completion complete(lua_State* L, std::string_view before);

/// The signature of the innermost open call, without options already given; empty if unknown.
std::string signature_hint(lua_State* L, std::string_view before);

// The context of the cursor: a name, a string, the options of a call.

enum class Cursor { name, member, option, value, string, nothing };

/// A call with open brackets at the cursor.
struct OpenCall {
    std::span<const lua::Token> function;       ///< tokens before the bracket: sys : simulate
    bool options = false;                       ///< whether the cursor is in a table of options,
    help::Braces braces = help::Braces::alone;  ///< how this table is passed
    /// The path of names from the call's options to the table that contains the cursor, with "" for a list: `events`,
    /// "" in f{ events = { { ... } } }.
    std::vector<std::string_view> path = {};
    std::vector<std::string_view> given = {};  ///< options already given
    std::string_view option = {};              ///< the option whose value contains the cursor
};

/// Analyses the text before the cursor, which must outlive this object.
class TypedText : text::NotCopied {
public:
    explicit TypedText(std::string_view before);

    Cursor cursor() const { return cursor_; }
    /// The beginning of a name or string at the cursor.
    std::string_view word() const { return word_; }
    /// For Cursor::member: the tokens before the separator '.' or ':', and the separator.
    std::span<const lua::Token> owner() const { return owner_; }
    char separator() const { return separator_; }
    const std::optional<OpenCall>& call() const { return call_; }
    const lua::Tokens& tokens_before() const { return tokens_; }

private:
    void find_cursor(std::string_view before);
    void find_call();
    std::span<const lua::Token> expression_before(std::size_t end) const;
    std::vector<std::size_t> open_brackets() const;
    std::optional<std::string_view> name_of_table(std::size_t bracket, std::size_t outer) const;

    lua::Tokens tokens_;  // without the word at the cursor
    Cursor cursor_ = Cursor::nothing;
    std::string_view word_;
    std::span<const lua::Token> owner_;
    char separator_ = ' ';
    std::optional<OpenCall> call_;
};

// The meaning of an expression being typed: its value if no user code must run for it, otherwise its documentation.

struct Meaning {
    enum class Kind {
        unknown,
        value,   ///< not an object of dinal
        object,  ///< an object of the class `section`, at present or as the result of running the expression
        member,  ///< the method or field `member` of `section`, or a function of dinal
    };
    Kind kind = Kind::unknown;
    const help::Section* section = nullptr;
    const lua::Member* member = nullptr;
};

/// Pushes the value of the expression, or nil if that would require user code; always exactly one value.
Meaning meaning(lua_State* L, std::span<const lua::Token> expression);

/// The section of a class, or nullptr.
const help::Section* section_of(const lua::Class* description);

/// Adds names of the object on the top beyond its class: columns of data, values of a fit.
void add_own_names(lua_State* L, std::vector<std::string>& names);

/// The columns of the object in a method call such as run:plot: vectors of a run, columns of data.
std::vector<std::string> columns_of_owner(lua_State* L, std::span<const lua::Token> function);

// While a line is typed: the grey hint after it, and completion without Lua errors.

/// The output that draws the hint behind a line and restores the cursor.
struct Painted {
    std::string text;   ///< empty if the line must not change
    bool hint = false;  ///< whether a hint is visible now
};

/// The line being typed, after the prompt.
struct LineOnScreen {
    std::string_view prompt;
    const std::string& pending;  ///< previous lines of the chunk
    std::string_view line;
    std::size_t cursor = 0;  ///< index in the line
    std::string_view cue;    ///< the missing part of the chunk, shown while nothing is typed
    std::string_view rest;   ///< suggestion from history
};
Painted paint(lua_State* L, const LineOnScreen& shown);

/// complete(), with an empty answer if memory is insufficient.
Completion complete_safely(lua_State* L, const std::string& before);

}  // namespace dinal::prompt
