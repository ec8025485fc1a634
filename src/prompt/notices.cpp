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

bool opens_block(const lua::Token& token) {
    return token.is("function") || token.is("do") || token.is("if") || token.is("repeat");
}
bool closes_block(const lua::Token& token) {
    return token.is("end") || token.is("until");
}

/// The names declared by `local` at token `at`.
std::vector<std::string_view> declared(const lua::Tokens& all, std::size_t at) {
    std::vector<std::string_view> names;
    std::size_t i = at + 1 + (at + 1 < all.size() && all[at + 1].is("function") ? 1 : 0);
    for (; i < all.size() && all[i].kind == lua::TokenKind::name; i += 2) {
        names.push_back(all[i].text);
        if (i + 1 >= all.size() || !all[i + 1].is(",")) {
            break;
        }
    }
    return names;
}

/// The number of uses of a variable, without fields such as lab.given. 1 means only its declaration.
std::ptrdiff_t uses(const lua::Tokens& all, std::string_view name) {
    std::ptrdiff_t count = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool field = i > 0 && (all[i - 1].is(".") || all[i - 1].is(":"));
        count += all[i].kind == lua::TokenKind::name && all[i].text == name && !field ? 1 : 0;
    }
    return count;
}

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

std::string element_notice(lua_State* L, const Chunk& chunk) {
    const lua::Tokens all = lua::tokens(chunk.expression);
    if (all.size() < 3) return "";
    if (all.back().is("]")) {
        const lua::LuaMessage nothing{.words = {}, .type = "nil", .kind = "field", .name = "?"};
        return without_semicolon(errors::missing_element(L, nullptr, nothing, chunk.expression).end_of_sentence);
    }
    if (all.back().kind != lua::TokenKind::name || !all[all.size() - 2].is(".")) return "";
    const int top = lua_gettop(L);
    const Meaning owner = meaning(L, std::span(all).first(all.size() - 2));
    const std::vector<std::string> names =
        owner.kind == Meaning::Kind::value && lua_istable(L, -1) ? errors::member_names(L) : std::vector<std::string>();
    lua_settop(L, top);
    const std::string hint = text::did_you_mean(all.back().text, names);
    if (!hint.empty()) return fmt::format("there is no '{}' in it{}", all.back().text, hint);
    constexpr std::size_t few = 8;
    return names.empty() || names.size() > few
               ? ""
               : fmt::format("there is no '{}' in it: it has {}", all.back().text, fmt::join(names, ", "));
}

namespace {

std::string colon_notice(lua_State* L, const std::string& text) {
    const TypedText typed(text);
    if (!typed.tokens_before().empty() && typed.tokens_before().back().is(":") && typed.word().empty() &&
        text.find('\n') == std::string::npos) {
        return "a colon needs the name of a method after it; a loop is: for i = 1, 10 do ... end";
    }
    if (typed.cursor() != Cursor::member || typed.separator() != ':' || typed.word().empty()) {
        return "";
    }
    lua::Tokens expression(typed.owner().begin(), typed.owner().end());
    expression.push_back({lua::TokenKind::symbol, ":"});
    expression.push_back({lua::TokenKind::name, typed.word()});
    const int top = lua_gettop(L);
    const Meaning found = meaning(L, expression);
    lua_settop(L, top);
    if (found.kind != Meaning::Kind::member || found.member->kind == lua::Kind::function) {
        return "";
    }
    return found.member->kind == lua::Kind::field
               ? fmt::format("{} is a field: write it with a point, {}", found.member->name,
                             help::written_name(*found.section, *found.member))
               : fmt::format("{} is a method, which is called: {}", found.member->name,
                             help::signature(found.member->doc));
}

}  // namespace

std::string unfinished_notice(lua_State* L, const std::string& text) {
    const std::string notice = colon_notice(L, text);
    return notice.empty() && text.find('\n') == std::string::npos
               ? without_semicolon(errors::foreign_tokens(text, errors::Seen::unfinished))
               : notice;
}

std::string local_notice(const std::string& text) {
    const lua::Tokens all = lua::tokens(text);
    const bool script = text.find('\n') != std::string::npos;
    std::vector<std::string_view> names;
    int depth = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].is("local") && depth == 0) {
            for (const std::string_view name : declared(all, i)) {
                if (script || uses(all, name) == 1)
                    names.push_back(name);  // at the prompt, a variable used on its own line is not lost
            }
        }
        depth += opens_block(all[i]) ? 1 : closes_block(all[i]) ? -1 : 0;
    }
    if (names.empty()) return "";
    return fmt::format("local variables end with the input: {} {} gone. To keep {}, leave out the word local",
                       fmt::join(names, ", "), names.size() == 1 ? "is" : "are", names.size() == 1 ? "it" : "them");
}

std::string nil_notice(lua_State* L, const std::string& text) {
    return errors::nil_value(L, nullptr, text, true);
}

std::string comma_notice(const std::string& text) {
    return without_semicolon(errors::foreign_tokens(text, errors::Seen::complete));
}

std::string overwritten_notice(lua_State* L, const std::string& text) {
    const lua::Tokens all = lua::tokens(text);
    int depth = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        depth += all[i].is("{") || all[i].is("(") ? 1 : all[i].is("}") || all[i].is(")") ? -1 : 0;
        if (depth > 0 || all[i].kind != lua::TokenKind::name) {
            continue;
        }
        const bool defined = i > 0 && all[i - 1].is("function");
        const bool field = i + 2 < all.size() && all[i + 1].is(".") && all[i + 2].kind == lua::TokenKind::name;
        const std::size_t last = field ? i + 2 : i;
        const bool part = i > 0 && (all[i - 1].is(".") || all[i - 1].is(":") || all[i - 1].is("local"));
        const bool assigned = last + 1 < all.size() && (all[last + 1].is("=") || all[last + 1].is(","));
        const std::string_view key = field ? all[i + 2].text : std::string_view();
        if (part || !(assigned || defined) || !lua::is_overwritten(L, all[i].text, key)) {
            continue;
        }
        const std::string whole = field ? fmt::format("{}.{}", all[i].text, key) : std::string(all[i].text);
        if (!field && lua::is_of_dinal(L, all[i].text)) {
            return fmt::format("{0} was a name of dinal and is now your variable; {0} = dinal.{0} restores it", whole);
        }
        return fmt::format("{} existed before and is now your variable; :reset restores it and deletes your variables",
                           whole);
    }
    return "";
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
