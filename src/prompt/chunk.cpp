#include "prompt/chunk.hpp"

#include <fmt/core.h>

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lua/bind.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_message.hpp"
#include "lua/lua_text.hpp"
#include "lua/standard_globals.hpp"
#include "prompt/call.hpp"
#include "prompt/notices.hpp"
#include "prompt/output.hpp"
#include "terminal/display.hpp"
#include "text/words.hpp"

namespace dinal::prompt {
namespace {

// The variable prevents a tail call of `return f(x)`, which would remove f's name and place from messages.
constexpr std::string_view returning = "local dinal_prompt <close> = nil; return ";

bool load(lua_State* L, const std::string& text) {
    return luaL_loadbufferx(L, text.data(), text.size(), prompt_chunk, "t") == LUA_OK;
}

/// Compiles the text; pops the function or the message.
bool loads(lua_State* L, const std::string& text) {
    const bool good = load(L, text);
    lua_pop(L, 1);
    return good;
}

/// Returns whether a string continues on the next line: "...\\" or "...\\z  ".
bool string_continues(std::string_view text) {
    if (text.ends_with('\\')) {
        return true;
    }
    const std::size_t last = text.find_last_not_of(" \t\r\n");
    return last != std::string_view::npos && last > 0 && text.substr(last - 1, 2) == "\\z";
}

/// Returns whether the message on the top of the stack says that the chunk ended too early.
bool ended_early(lua_State* L, std::string_view chunk) {
    const std::string_view message = lua::text_at(L, -1);
    // A quoted string ends on its line unless a backslash escapes the newline.
    return lua::is_about_end(message) && (!lua::is_about_unfinished_string(message) || string_continues(chunk));
}

std::string returned(std::string_view expression) {
    return std::string(returning).append(expression);
}

/// The text without semicolons and comments at its end.
std::string_view without_semicolons(std::string_view text) {
    const lua::Tokens all = lua::tokens(text);
    std::string_view result = text;
    for (auto token = all.rbegin(); token != all.rend(); ++token) {
        if (token->is(";")) {
            result = text.substr(0, token->at);
        } else if (token->kind != lua::TokenKind::comment) {
            break;
        }
    }
    return result;
}

/// The possible beginnings of the last value: after semicolons, and at lines. The last place comes first.
std::vector<std::size_t> possible_cuts(const std::string& text) {
    std::vector<std::size_t> cuts;
    for (std::size_t cut = text.rfind('\n'); cut != std::string::npos && cut > 0; cut = text.rfind('\n', cut - 1)) {
        cuts.push_back(cut);
    }
    for (const lua::Token& token : lua::tokens(text)) {
        if (token.is(";")) {
            cuts.push_back(token.at);
        }
    }
    std::sort(cuts.rbegin(), cuts.rend());
    return cuts;
}

/// Makes a block that ends in an expression return it; pushes the function and returns true if that is possible.
/// NOTE: `cautious` skips lines that Lua may read as a continuation of the line before: (f)(), "s", {...}, -x.
bool load_with_last_value(lua_State* L, Chunk& chunk, const std::string& text, bool cautious) {
    for (const std::size_t cut : possible_cuts(text)) {
        const std::size_t first = text.find_first_not_of(" \t\r\n", cut + 1);
        if (first == std::string::npos) {
            continue;
        }
        const char letter = text[first];
        if (cautious && text[cut] == '\n' && !text::is_name_char(letter)) {
            continue;
        }
        const std::string begin = text.substr(0, cut + 1);
        const std::string last = text.substr(cut + 1);
        if (loads(L, begin) && loads(L, returned(last))) {
            chunk.statements = begin;
            chunk.expression = last;
            return load(L, begin + returned(last));
        }
    }
    return false;
}

/// The innermost unclosed bracket.
std::optional<lua::Token> open_bracket(std::string_view text) {
    lua::Tokens open;
    for (const lua::Token& token : lua::tokens(text)) {
        if (token.nesting() > 0) {
            open.push_back(token);
        } else if (token.nesting() < 0 && !open.empty()) {
            open.pop_back();
        }
    }
    return open.empty() ? std::nullopt : std::optional(open.back());
}

char partner_of(char bracket) {
    return bracket == '(' ? ')' : bracket == '[' ? ']' : '}';
}

/// The missing part, according to the message on the top of the stack about a chunk that ended too early.
std::string what_is_missing(lua_State* L, std::string_view text) {
    const std::string message(lua::text_at(L, -1));
    const std::size_t line = message.find(':') + 1, words = message.find(": ") + 2;  // input:1: ...
    const std::string number = message.substr(line, words - 2 - line);
    const auto parsed = lua::syntax_message(std::string_view(message).substr(words));
    if (!parsed || parsed->expected.empty() || parsed->expected.front() == '<') {
        const auto open = open_bracket(text);
        return open ? fmt::format("{} of line {} waits for {}", open->text, open->line, partner_of(open->text.front()))
                    : fmt::format("line {} goes on", number);
    }
    if (parsed->opened.empty()) {  // the missing part is on that line
        return fmt::format("line {} waits for {}", number, parsed->expected);
    }
    return fmt::format("{} of line {} waits for {}", parsed->opened, parsed->opened_line, parsed->expected);
}

/// The words after an initial `return`.
std::string_view without_return(std::string_view text) {
    const lua::Tokens all = lua::tokens(text);
    return !all.empty() && all.front().is("return") ? text.substr(all.front().end()) : text;
}

}  // namespace

Chunk compile(lua_State* L, const std::string& text) {
    Chunk chunk{Compiled::ready, text, "", false};
    const std::string_view quiet = without_semicolons(text);
    chunk.silent = quiet.size() != text.size();
    const bool equals = !text.empty() && text[0] == '=';  // = x, as in Lua 5.2 and earlier
    const std::string_view expression = without_return(quiet.substr(equals ? 1 : 0));
    if (load(L, returned(expression))) {
        chunk.statements.clear();
        chunk.expression = expression;
        return chunk;
    }
    bool early = ended_early(L, text);
    chunk.waits = early ? what_is_missing(L, text) : "";
    lua_pop(L, 1);
    const bool statements = load(L, text);
    const bool statements_early = !statements && ended_early(L, text);
    chunk.waits = statements_early ? what_is_missing(L, text) : chunk.waits;
    early = !statements && (statements_early || early);
    if (quiet.find_first_of("\n;") != std::string::npos) {
        const int top = lua_gettop(L);
        // NOTE: a block may end in a name, after which Lua expects more.
        if (load_with_last_value(L, chunk, std::string(quiet), statements || early)) {
            lua_remove(L, top);
            return chunk;
        }
        lua_settop(L, top);
    }
    chunk.silent = false;
    chunk.result = statements ? Compiled::ready : early ? Compiled::incomplete : Compiled::wrong;
    return chunk;
}

bool only_reads_variable(const Chunk& chunk) {
    const lua::Tokens all = lua::tokens(chunk.expression);
    const auto code =
        std::ranges::count_if(all, [](const lua::Token& token) { return token.kind != lua::TokenKind::comment; });
    return chunk.statements.empty() && code == 1 && all.front().kind == lua::TokenKind::name;
}

namespace {

/// Sets the global ans to the value at `index`.
void set_ans(lua_State* L, int index) {
    index = lua_absindex(L, index);
    lua_pushglobaltable(L);
    lua_pushliteral(L, "ans");
    lua_pushvalue(L, index);
    lua_rawset(L, -3);
    lua_pop(L, 1);
}

/// Pushes the partial result of a run that failed or was stopped, or nil.
void push_partial(lua_State* L) {
    lua::push_dinal_table(L);
    lua::push_field(L, -1, "partial");
    lua_remove(L, -2);
}

/// Prints how to continue: a partial run with run:continue, a partial sweep with a file by calling it again.
int print_partial(lua_State* L) {
    const lua::Documented kept = lua::documented(L, 1);
    const bool run = kept.owner != nullptr && kept.owner->name == std::string_view("run");
    say_error((run ? "the finished part of the run is in dinal.partial and in ans (ans:continue() continues it):\n"
                   : "the finished points are in dinal.partial and in ans (with file the same call continues):\n") +
              show(L, 1, terminal::display_of(STDERR_FILENO)));
    return 0;
}

/// Calls `function` with the values above `base` to show them; pops them.
void show_by(lua_State* L, lua_CFunction function, int base) {
    luaL_checkstack(L, LUA_MINSTACK, "too many values to show");
    lua_pushcfunction(L, function);
    lua_insert(L, base + 1);
    if (call(L, lua_gettop(L) - base - 1, 0) != LUA_OK) {
        say_error(take_text(L));
    }
}

/// Sets ans to the first value above `base`, and shows all.
void take_values(lua_State* L, int base, const Chunk& chunk, lua_CFunction show_values) {
    if (lua_gettop(L) == base) {
        return;
    }
    const bool single = lua_gettop(L) == base + 1;
    if (!lua_isnil(L, base + 1) && !only_reads_variable(chunk)) {
        set_ans(L, base + 1);
    }
    const std::string element = single && lua_isnil(L, base + 1) ? element_notice(L, chunk) : "";
    if (!chunk.silent) {
        show_by(L, show_values, base);
    }
    if (single) {
        say_notice(name_notice(L, chunk));
        say_notice(element);
    }
}

/// Keeps the partial run before an error; `before` is the index of the previous one.
void keep_partial_run(lua_State* L, int before) {
    push_partial(L);
    if (!lua_isnil(L, -1) && lua_rawequal(L, -1, before) == 0 && luaL_len(L, -1) > 0) {
        set_ans(L, -1);
        show_by(L, print_partial, lua_gettop(L) - 1);
    }
}

/// Runs the function on the top of the stack and shows its values; returns false with the message on the stack if it
/// failed.
bool run_and_show(lua_State* L, const Chunk& chunk, lua_CFunction show_values, Evaluated& result) {
    const lua::InterruptScope running(L);  // covers a Ctrl-C that arrives while values are shown
    if (call(L, 0, LUA_MULTRET) != LUA_OK) {
        return false;
    }
    result = {!lua::interrupt_requested(), lua_gettop(L) - 1, lua_gettop(L) > 1 && lua_isnil(L, 2)};
    if (!result.fine) {
        say_error("interrupted");
    }
    take_values(L, 1, chunk, show_values);
    return true;
}

}  // namespace

std::string values_text(lua_State* L) {
    const int count = lua_gettop(L);
    std::string text;
    for (int i = 1; i <= count; ++i) {
        text.append(i == 1 ? "" : "\t").append(show(L, i, terminal::display_of(STDOUT_FILENO)));
    }
    return text;
}

int print_values(lua_State* L) {
    say_value(values_text(L) + "\n");
    return 0;
}

Evaluated evaluate(lua_State* L, const Chunk& chunk, lua_CFunction show_values) {
    Evaluated result;
    push_partial(L);
    lua_insert(L, 1);
    if (!run_and_show(L, chunk, show_values, result)) {
        say_error(take_text(L));
        keep_partial_run(L, 1);
    }
    lua_settop(L, 0);
    return result;
}

}  // namespace dinal::prompt
