
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>

#include "files/file.hpp"
#include "lua/bind.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/safe_mode.hpp"
#include "prompt/call.hpp"
#include "prompt/chunk.hpp"
#include "prompt/commands.hpp"
#include "prompt/notices.hpp"
#include "prompt/output.hpp"
#include "prompt/script.hpp"
#include "prompt/session.hpp"
#include "prompt/user_files.hpp"
#include "source/function_source.hpp"
#include "text/version.hpp"
#include "text/words.hpp"

namespace dinal::prompt {

namespace {

/// As in lua, a string in the global _PROMPT or _PROMPT2 replaces dinal's prompt.
std::string prompt_text(lua_State* L, const char* global, const char* ours) {
    std::string text = lua::push_global(L, global) == LUA_TSTRING ? lua_tostring(L, -1) : ours;
    lua_pop(L, 1);
    return text;
}

/// Reports the syntax error on the top of the stack.
void reject(Session& session, const std::string& text) {
    source::keep_source(session.L, prompt_chunk, text);  // the message shows the line
    say_error(load_error_text(session.L, nullptr));
}

/// Meanings of lines within a chunk that are not Lua.
enum class LineMeaning { none, blank, leaving, other };

LineMeaning line_meaning(std::string_view line) {
    const std::string_view word = text::trimmed(line);
    if (word.empty()) {
        return LineMeaning::blank;
    }
    const auto is = [word](std::string_view one) { return word == one; };
    constexpr std::array<std::string_view, 6> leaving = {"quit", "exit", "bye", "quit()", "exit()", ":q"};
    if (std::ranges::any_of(leaving, is) || word == ":quit") {
        return LineMeaning::leaving;
    }
    const bool asks = word == "help" || word == "help()" || word == ":help" || word.front() == '?';
    return asks ? LineMeaning::other : LineMeaning::none;
}

/// Reminds of Ctrl-C if a line within a chunk looks like an attempt to leave.
void remind_of_cancel(const Chunk& chunk, LineMeaning found) {
    say_notice(fmt::format("{}; Ctrl-C cancels it{}", chunk.waits,
                           found == LineMeaning::leaving ? ", and :quit then leaves dinal" : ""));
}

/// Reads the missing lines of a chunk and compiles it: the function is then on the stack. `copied`: the lines were
/// copied with their prompts.
TypedLine read_rest(Session& session, Chunk& chunk, TypedLine input, bool copied) {
    lua_State* L = session.L;
    while (chunk.result == Compiled::incomplete) {
        const std::string cue = chunk.waits + "; Ctrl-C cancels it";
        TypedLine more = session.editor.read(prompt_text(L, "_PROMPT2", ">> "), input.text, cue);
        if (more.reading == Reading::end) {
            say("\n");
            chunk.result = Compiled::wrong;
            return input;
        }
        if (more.reading == Reading::interrupted) {
            lua_settop(L, 0);
            return more;
        }
        if (copied) {
            more.text = behind_prompt(more.text).value_or(more.text);
        }
        const bool in_text = !lua::tokens(input.text).empty() && lua::tokens(input.text).back().open;
        const LineMeaning found = in_text ? LineMeaning::none : line_meaning(more.text);
        if (found != LineMeaning::none) {
            remind_of_cancel(chunk, found);
            if (found != LineMeaning::blank) {
                continue;
            }
        }
        lua_settop(L, 0);
        input.text.append("\n").append(more.text);
        chunk = compile(L, input.text);
    }
    return input;
}

void remember(Session& session, const std::string& input) {
    session.editor.remember(input);
    if (!is_command(input)) session.inputs.push_back(input);
}

/// Executes an input, reading further lines of a chunk if needed.
Reading take(Session& session, TypedLine input, bool copied) {
    lua_State* L = session.L;
    if (is_command(input.text)) {
        remember(session, input.text);
        run_command(session, input.text);
        return Reading::line;
    }
    Chunk chunk = compile(L, input.text);
    const bool incomplete = chunk.result == Compiled::incomplete;
    if (const std::string notice = incomplete ? unfinished_notice(L, input.text) : ""; !notice.empty()) {
        remember(session, input.text);
        say_notice(notice);
        return Reading::line;
    }
    input = read_rest(session, chunk, input, copied);
    if (input.reading == Reading::interrupted) {
        return input.reading;
    }
    remember(session, input.text);
    if (chunk.result == Compiled::ready) {
        run_chunk(session, chunk, input.text);
    } else {
        reject(session, input.text);
    }
    return Reading::line;
}

/// Executes inputs copied with their prompts. Lines without a prompt between them are output of the first session,
/// unless a chunk is open.
Reading take_copied(Session& session, std::string_view text) {
    std::string open;
    bool is_open = false;
    for (const std::string_view line : text::split(text, '\n')) {
        const auto code = behind_prompt(line);
        if (!code && !is_open) {
            continue;
        }
        open.append(is_open ? "\n" : "").append(code.value_or(line));
        is_open = !is_command(open) && compile(session.L, open).result == Compiled::incomplete;
        lua_settop(session.L, 0);
        if (is_open || text::trimmed(open).empty()) {
            continue;
        }
        take(session, {Reading::line, open}, true);
        lua_settop(session.L, 0);
        open.clear();
        if (session.leaving || lua::interrupt_requested()) {
            return Reading::line;
        }
    }
    return is_open ? take(session, {Reading::line, open}, true) : Reading::line;
}

Reading read_and_run(Session& session) {
    TypedLine input = session.editor.read(prompt_text(session.L, "_PROMPT", "> "));
    if (input.reading != Reading::line) {
        return input.reading;
    }
    return behind_prompt(input.text) ? take_copied(session, input.text) : take(session, std::move(input), false);
}

void run_init_file(lua_State* L) {
    const std::string file = init_file();
    if (file.empty()) {
        return;
    }
    if (luaL_loadfilex(L, file.c_str(), lua::load_mode()) != LUA_OK) {
        say_error(load_error_text(L, file.c_str()));
    } else if (call(L, 0, 0) != LUA_OK) {
        say_error(take_text(L));
    }
    lua_settop(L, 0);
}

}  // namespace

bool run_chunk(Session& session, const Chunk& chunk, const std::string& text) {
    source::keep_source(session.L, prompt_chunk,
                        text);  // errors and files of results may need the text of functions defined here
    const Evaluated result = evaluate(session.L, chunk, session.show_values);
    if (!result.fine) {
        return false;
    }
    say_notice(local_notice(text));
    say_notice(nil_notice(session.L, text));
    say_notice(comma_notice(text));
    say_notice(overwritten_notice(session.L, text));
    session.record.add(chunk, result);
    return true;
}

bool run_text(Session& session, const std::string& text) {
    lua_settop(session.L, 0);
    const Chunk chunk = compile(session.L, text);
    const bool ready = chunk.result == Compiled::ready;
    if (!ready) {
        reject(session, text);
    }
    if (chunk.result == Compiled::incomplete) {  // no further line can complete it
        const std::string notice = unfinished_notice(session.L, text);
        say_notice(notice.empty() ? chunk.waits : notice);
    }
    const bool fine = ready && run_chunk(session, chunk, text);
    lua_settop(session.L, 0);
    return fine;
}

std::string greeting() {
    return version_line() + ": help() for help, Ctrl-D to leave";
}

bool run_prompt(lua_State* L, Start start) {
    lua_settop(L, 0);
    if (isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0) {
        // A reader of our pipe may disappear: that is an error there and must not end the session. A handler, because
        // an ignored signal would stay ignored in started programs.
        lua::set_handler(SIGPIPE, [](int) {});
    }
    if (start == Start::with_init_file) {
        run_init_file(L);
    }
    Session session(L);
    while (!session.leaving) {
        const Reading reading = read_and_run(session);
        lua_settop(L, 0);
        flush_output();
        if (reading == Reading::end) {
            say("\n");
            return true;
        }
        if (reading == Reading::interrupted && isatty(STDIN_FILENO) == 0) {
            return false;
        }
    }
    return true;
}

namespace {

bool has(const std::string& text, std::string_view word) {
    const lua::Tokens all = lua::tokens(text);
    return std::ranges::any_of(all, [word](const lua::Token& token) {
        return (token.kind == lua::TokenKind::name || token.kind == lua::TokenKind::keyword || token.is("::")) &&
               token.text == word;
    });
}

/// Returns whether statements need a block, so that their local variables and labels end with it.
bool needs_block(const std::string& statements) {
    return has(statements, "local") || has(statements, "::");
}

/// The expression inside brackets; a comment at its end must not swallow the closing one.
std::string in_call(std::string_view function, const std::string& expression) {
    const lua::Tokens all = lua::tokens(expression);
    const bool comment = !all.empty() && all.back().kind == lua::TokenKind::comment;
    return fmt::format("{}({}{})", function, expression, comment ? "\n" : "");
}

/// Returns whether the expression is a call, which is a statement by itself.
bool is_call(const std::string& expression) {
    const lua::Tokens all = lua::tokens(expression);
    const auto last =
        std::find_if(all.rbegin(), all.rend(), [](const lua::Token& t) { return t.kind != lua::TokenKind::comment; });
    return last != all.rend() && (last->is(")") || last->is("}") || last->kind == lua::TokenKind::string) &&
           all.size() > 1 && all.front().kind == lua::TokenKind::name;
}

}  // namespace

void Record::add(const Chunk& chunk, const Evaluated& result) {
    if (text::trimmed(chunk.statements + chunk.expression).empty()) {
        return;
    }
    entries_.push_back({chunk, result});
}

void Record::add_statement(const std::string& statement) {
    add(Chunk{Compiled::ready, statement, "", false}, Evaluated{true, 0, false});
}

bool Record::writes(const std::string& file) const {
    return text::contains(written_, file);
}

text::Expected<bool> Record::save(const std::string& file) {
    if (lua::safe_mode() && !file.ends_with(".lua")) {
        return text::error("{} does not end in .lua, and safe mode writes no other scripts", file);
    }
    if (!writes(file) && access(file.c_str(), F_OK) == 0) {
        return text::error("{} is there already, and not of this session; choose another name", file);
    }
    if (auto written = files::write_file(file, script()); !written) {
        return written.error();
    }
    written_.push_back(file);
    return true;
}

bool Record::sets_ans(const Entry& entry) {
    return entry.result.values > 0 && !entry.result.first_nil && !only_reads_variable(entry.chunk);
}

/// Returns whether ans is used before the next input sets it.
bool Record::ans_is_used_after(std::size_t entry) const {
    for (std::size_t i = entry + 1; i < entries_.size(); ++i) {
        if (has(entries_[i].chunk.statements, "ans") || has(entries_[i].chunk.expression, "ans")) {
            return true;
        }
        if (sets_ans(entries_[i])) {
            return false;
        }
    }
    return false;
}

std::string Record::script() const {
    std::string text = "-- typed at the prompt of dinal " DINAL_VERSION "\n";
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const auto& [chunk, result] = entries_[i];
        std::string lines(text::trimmed(chunk.statements));
        const std::string expression(text::trimmed(chunk.expression));
        if (!expression.empty()) {
            lines += lines.empty() ? "" : "\n";
            const bool becomes_ans = sets_ans(entries_[i]);
            if (becomes_ans && (ans_is_used_after(i) || (chunk.silent && !is_call(expression)))) {
                lines += "ans = " + expression + (chunk.silent ? "" : "\nprint(ans)");
            } else if (chunk.silent && only_reads_variable(chunk)) {
                continue;  // reading a variable has no effect
            } else if (is_call(expression) && (chunk.silent || result.values == 0)) {
                lines += expression;
            } else {
                lines += in_call("print", expression);
            }
        }
        text += needs_block(chunk.statements) ? fmt::format("do\n{}\nend\n", lines) : lines + "\n";
    }
    return text;
}

}  // namespace dinal::prompt
