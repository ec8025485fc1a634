#include "prompt/notices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "errors/advice.hpp"
#include "errors/error_remarks.hpp"
#include "help/help_text.hpp"
#include "help/library.hpp"
#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "lua/options.hpp"
#include "lua/standard_globals.hpp"
#include "prompt/completion.hpp"
#include "prompt/output.hpp"
#include "text/suggest.hpp"

namespace dinal::prompt {
namespace {

std::string without_semicolon(const std::string& remark) {
    return remark.substr(std::min<std::size_t>(2, remark.size()));
}

}  // namespace

std::string name_notice(lua_State* L, const Chunk& chunk) {
    const lua::Tokens all = lua::tokens(chunk.expression);
    if (all.size() == 1 && all.front().is("help")) {
        return "help() starts a tour; ?name explains a name";
    }
    if (all.size() != 1 || all.front().kind != lua::TokenKind::name || all.front().is("ans")) {
        return "";
    }
    const std::string_view name = all.front().text;
    const bool is_known = lua::push_global(L, name) != LUA_TNIL;
    lua_pop(L, 1);
    if (is_known) return "";
    const std::string cure = errors::foreign_tokens(name, errors::Seen::typed);
    if (!cure.empty()) return "there is no such variable" + cure;
    const std::string hint = errors::similar_global(L, name);
    return hint.empty() ? "" : fmt::format("there is no variable '{}'{}", name, hint);
}

std::string unfinished_notice(const std::string& text) {
    return text.find('\n') == std::string::npos
               ? without_semicolon(errors::foreign_tokens(text, errors::Seen::unfinished))
               : "";
}

std::string local_notice(const std::string& text) {
    const lua::Tokens all = lua::tokens(text);
    if (all.size() < 2 || !all.front().is("local")) return "";
    const bool is_used = std::ranges::count(all, all[1].text, &lua::Token::text) > 1;
    return is_used ? "" : "a local variable ends with the input: to keep it, leave out the word local";
}

std::string nil_notice(lua_State* L, const std::string& text) {
    return errors::nil_value(L, nullptr, text, true);
}

std::string comma_notice(const std::string& text) {
    return without_semicolon(errors::foreign_tokens(text, errors::Seen::complete));
}

std::string overwritten_notice(lua_State* L, const std::string& text) {
    const lua::Tokens all = lua::tokens(text);
    if (all.size() < 2 || !all[1].is("=") || !lua::is_overwritten(L, all[0].text)) return "";
    return fmt::format("{0} existed before and is now your variable; :reset restores it and deletes your variables{1}",
                       all[0].text,
                       lua::is_of_dinal(L, all[0].text) ? fmt::format(", {0} = dinal.{0} it alone", all[0].text) : "");
}

void say_notice(const std::string& notice) {
    if (!notice.empty()) {
        say_error("(" + notice + ")");
    }
}

namespace {

/// The notice of a misspelt option for the running call in a file, once for each line: "'theta_0' is nil, so theta0 is
/// not given"; or "".
std::string nil_option_now(lua_State* L) {
    thread_local std::set<std::pair<const void*, int>> seen;  // workers of a sweep use it, too
    lua_Debug frame{};
    if (lua_getstack(L, 1, &frame) == 0 || lua_getinfo(L, "Sl", &frame) == 0 || *frame.source != '@') return "";
    // A function on one line ends before its statement, which can see other variables.
    if (frame.linedefined == frame.currentline || !seen.emplace(frame.source, frame.currentline).second) return "";
    const auto source = errors::source_of_frame(L, frame);
    if (!source) return "";
    const std::string notice = errors::nil_value(L, &frame, source->statement(frame.currentline), false);
    return notice.empty() ? "" : fmt::format("{}:{}: {}", frame.short_src, frame.currentline, notice);
}

/// Raises an error for an unknown global. Lua itself reads names with _ in front, such as _PROMPT.
int refuse_unknown(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING || *lua_tostring(L, 2) == '_') return 0;
    const std::string name = lua_tostring(L, 2);
    const std::string hint = errors::similar_global(L, name);
    lua::raise(L, {.sentence = fmt::format("there is no variable '{}'", name),
                   .culprit = name,
                   .cure = hint.empty() ? "; --strict makes this an error" : hint});
}

}  // namespace

void report_nil_option(lua_State* L) {
    const std::string notice = nil_option_now(L);
    if (!notice.empty()) say_notice(notice);
}

void be_strict(lua_State* L) {
    lua_pushglobaltable(L);
    lua_createtable(L, 0, 1);
    lua_pushcfunction(L, lua::guarded<refuse_unknown>);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
    lua_pop(L, 1);
    lua::look_at_options = [](lua_State* state) {
        const std::string notice = nil_option_now(state);
        if (notice.empty()) return;
        lua_pushstring(state, notice.c_str());
        lua_error(state);
    };
}

}  // namespace dinal::prompt
