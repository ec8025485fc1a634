#include "errors/error_remarks.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "errors/bare_value.hpp"
#include "errors/excerpt.hpp"
#include "errors/habits.hpp"
#include "errors/misspelling.hpp"
#include "errors/source_text.hpp"
#include "lua/tokens.hpp"
#include "source/function_source.hpp"

namespace dinal::errors {
namespace {

std::string_view statement_of(const std::optional<SourceText>& source, int line) {
    return source ? source->statement(line) : std::string_view();
}

/// The remarks on an error of either kind, of ours or of Lua.
template <class Error>
lua::Remarks remarks(lua_State* L, lua_Debug* frame, const Error& error, const std::optional<SourceText>& source,
                     int line) {
    const Advice advice = help_with(L, frame, error, statement_of(source, line));
    std::vector<std::string> names = suspects(error);
    if (!advice.culprit.empty()) {
        names.insert(names.begin(), advice.culprit);
    }
    return {advice.end_of_sentence, source ? excerpt(*source, line, names) : "", ""};
}

/// The message is about what the function at the index has returned.
lua::Remarks remarks_on_result(const text::Error& error, const SourceText& source, int line) {
    const std::vector<lua::Token> all = lua::tokens(source.text);
    const bool returns = std::any_of(all.begin(), all.end(), [](const lua::Token& t) { return t.is("return"); });
    std::vector<std::string> names = suspects(error);
    names.insert(names.end(), {"return", "function"});
    return {error.culprit == "nil" && !returns ? "; is the word return missing?" : "", excerpt(source, line, names),
            ""};
}

}  // namespace

lua::Remarks first_remarks(lua_State* L, int error, int function) {
    luaL_checkstack(L, LUA_MINSTACK, "for the remarks on an error");
    const std::string text = lua_type(L, error) == LUA_TSTRING ? lua_tostring(L, error) : "";
    const auto message = parse_message(text);
    if (!message) {
        return {};
    }
    const text::Error* facts = lua::facts_of(L, text);
    if (function != 0 && facts != nullptr) {
        const auto source = source::function_source(L, function);
        return source ? remarks_on_result(*facts, {*source, message->line}, message->line) : lua::Remarks();
    }
    lua_Debug found{};
    lua_Debug* frame = find_frame(L, *message, found) ? &found : nullptr;
    const auto source = frame != nullptr ? source_of_frame(L, *frame) : source_running(L, message->chunk);
    if (facts != nullptr) {
        return remarks(L, frame, *facts, source, message->line);
    }
    if (const auto syntax = lua::syntax_message(message->words)) {  // of a load() in the chunk
        const std::string habit = syntax_habit(L, *syntax, statement_of(source, message->line));
        return {habit, source ? excerpt(*source, message->line, {std::string(syntax->near)}) : "", ""};
    }
    return remarks(L, frame, lua::running_message(message->words), source, message->line);
}

lua::Remarks remarks_on(lua_State* L, int index) {
    const lua::Remarks* remembered = lua::remembered_remarks(L, index);
    return remembered != nullptr ? *remembered : first_remarks(L, lua_absindex(L, index), 0);
}

lua::Remarks remarks_on_syntax(lua_State* L, int index, const char* file) {
    const std::string text = lua_tostring(L, index);
    const auto message = parse_message(text);
    if (!message) {
        return {};
    }
    const auto source = file != nullptr ? source_of_file(file) : source_kept(L, message->chunk);
    const lua::SyntaxMessage syntax = lua::syntax_message(message->words).value_or(lua::SyntaxMessage{message->words});
    std::string habit = syntax_habit(L, syntax, statement_of(source, message->line));
    if (habit.empty() && source) habit = bare_value(L, *source, message->line, syntax);
    return {habit, source ? syntax_excerpt(L, *source, message->line, syntax) : "", ""};
}

}  // namespace dinal::errors
