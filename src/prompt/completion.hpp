// Tab: what may follow the text before the cursor. Never runs code of the user.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "help/library.hpp"
#include "help/signature.hpp"
#include "lua/lua_headers.hpp"
#include "lua/tokens.hpp"

namespace dinal::prompt {

struct Completion {
    std::vector<std::string> names;  ///< whole words, with what comes next: "simulate{", "theta0 = "
    bool files = false;              ///< names of files may follow
};

/// `before` is all that was typed of the chunk up to the cursor.
Completion complete(lua_State* L, std::string_view before);

/// The signature of the call whose brackets are open at the cursor, without the options that are there already; empty
/// when no such call is known.
std::string signature_hint(lua_State* L, std::string_view before);

// Where the cursor stands in a text that is being typed: in a name, a string, the options of a call.

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

// What an expression that is being typed is, or will be: values, where no code of the user must run for them, else
// documentation.

struct Meaning {
    enum class Kind {
        unknown,
        value,   ///< none of ours
        object,  ///< it is, or will be, an object of the class `section`
        member,  ///< it is the method or field `member` of `section`, or one of our functions
    };
    Kind kind = Kind::unknown;
    const help::Section* section = nullptr;
    const lua::Member* member = nullptr;
};

/// Pushes exactly one value: that of the expression, nil where it cannot be had without running code of the user.
Meaning meaning(lua_State* L, std::span<const lua::Token> expression);

/// The section that describes a class, nullptr when none does.
const help::Section* section_of(const lua::Class* description);

/// Adds the names that the object on the top has besides the members of its class: the columns of data, the values of a
/// fit.
void add_own_names(lua_State* L, std::vector<std::string>& names);

/// The columns of the object whose method is called, run:plot: of a run its vectors, of data what it has.
std::vector<std::string> columns_of_owner(lua_State* L, std::span<const lua::Token> function);

// While a line is typed: the grey hint behind it, and completion that no error of Lua can leave.

/// What draws the hint behind a line, and puts the cursor back.
struct Painted {
    std::string text;   ///< empty when the line must stay as it is
    bool hint = false;  ///< something stands behind the line now
};

/// The line stands behind the prompt on the row of the cursor.
struct LineOnScreen {
    std::string_view prompt;
    const std::string& pending;  ///< the lines before it of a chunk that goes on
    std::string_view line;
    std::size_t cursor = 0;  ///< a place in the line
    std::string_view cue;    ///< what the chunk waits for, where nothing is typed yet
    std::string_view rest;   ///< what history adds to the line
};
Painted paint(lua_State* L, const LineOnScreen& shown);

/// complete(), with an empty answer where memory runs out.
Completion complete_safely(lua_State* L, const std::string& before);

}  // namespace dinal::prompt
