#include "prompt/completion.hpp"

#include <algorithm>

#include "errors/misspelling.hpp"
#include "help/help_text.hpp"
#include "help/signature.hpp"
#include "lua/lua_text.hpp"
#include "prompt/commands.hpp"
#include "prompt/meaning.hpp"
#include "prompt/typed_text.hpp"

namespace dinal::prompt {
namespace {

/// Those that begin with the word, sorted.
std::vector<std::string> fitting(std::vector<std::string> names, std::string_view word) {
    std::erase_if(names, [word](const std::string& name) { return !name.starts_with(word); });
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

std::string bracket_after(std::string_view signature) {
    const char bracket = help::call_bracket(signature);
    return bracket == '{' ? "{ " : "(";
}

/// What comes after a name that holds the value on the top: the bracket of a call, or nothing.
std::string suffix(lua_State* L) {
    if (const lua::Documented found = lua::documented(L, -1); found.member != nullptr) {
        return bracket_after(found.member->doc.signature);
    }
    return lua_isfunction(L, -1) ? "(" : "";
}

void add_members(const lua::Class& description, char separator, bool calls, std::vector<std::string>& names) {
    for (const lua::Member& member : description.members) {
        const bool method = member.kind == lua::Kind::method;
        if (member.kind != lua::Kind::metamethod && (method || separator == '.')) {
            names.push_back(std::string(member.name) + (method && calls ? bracket_after(member.doc.signature) : ""));
        }
    }
}

/// Names that may stand behind the value on the top and a separator.
void add_fields(lua_State* L, char separator, bool calls, std::vector<std::string>& names) {
    const int value = lua_gettop(L);
    for (const std::string& name : errors::member_names(L)) {
        if (!lua::is_name(name)) {
            continue;
        }
        lua_pushnil(L);
        if (lua_istable(L, value)) {
            lua_pushstring(L, name.c_str());
            lua_rawget(L, value);
        }
        const bool callable = lua_isfunction(L, -1) || lua_type(L, value) == LUA_TSTRING || !lua_istable(L, value);
        if (separator == '.' || callable || lua_isnil(L, -1)) {
            names.push_back(name + (calls && lua_istable(L, value) ? suffix(L) : separator == ':' && calls ? "(" : ""));
        }
        lua_settop(L, value);
    }
}

std::vector<std::string> members(lua_State* L, const TypedText& typed, bool calls) {
    std::vector<std::string> names;
    const int top = lua_gettop(L);
    const Meaning owner = meaning(L, typed.owner());
    const help::Section* held = owner.kind == Meaning::Kind::object ? owner.section : nullptr;
    if (owner.kind == Meaning::Kind::member && owner.member->kind == lua::Kind::field) {
        held = help::result_class(owner.member->doc.signature);
    }
    constexpr std::size_t field_of_variable = 3;
    if (owner.kind == Meaning::Kind::member && owner.member->kind == lua::Kind::field &&
        typed.owner().size() == field_of_variable && lua_isuserdata(L, -2) != 0) {
        lua_pop(L, 1);  // fit.error: the object is below
        go_to_field(L, owner.member->name);
    }
    if (held != nullptr) {
        add_members(*held->description, typed.separator(), calls, names);
        if (typed.separator() == '.') {
            add_own_names(L, names);
        }
    } else if (owner.kind == Meaning::Kind::value || (owner.kind == Meaning::Kind::member && lua_istable(L, -1))) {
        add_fields(L, typed.separator(), calls, names);
    }
    if (typed.owner().size() == 1 && typed.owner().front().is("dinal") && typed.separator() == '.') {
        names.insert(names.end(), {"on_interrupt", "partial"});  // nil most of the time
    }
    lua_settop(L, top);
    return names;
}

/// What is documented about the function of ours that is called; nullptr when it is none.
const lua::Doc* called_doc(lua_State* L, const OpenCall& call) {
    const int top = lua_gettop(L);
    const Meaning function = meaning(L, call.function);
    lua_settop(L, top);
    return function.kind == Meaning::Kind::member ? &function.member->doc : nullptr;
}

/// The table that the cursor is in.
struct OpenTable {
    std::span<const text::Option> options = {};  ///< its fields; none when they are not known
    bool list = false;                           ///< of tables
};

OpenTable open_table(lua_State* L, const OpenCall& call) {
    const lua::Doc* doc = called_doc(L, call);
    const text::Call* known = doc != nullptr ? help::call_with(*doc, call.braces) : nullptr;
    text::Fields::Place place = text::Fields::Place::itself;
    for (const std::string_view name : call.path) {
        if (known != nullptr && place == text::Fields::Place::itself) {
            const auto row = std::find_if(known->options.begin(), known->options.end(),
                                          [name](const text::Option& option) { return option.name == name; });
            const text::Fields table = row == known->options.end() ? text::Fields{} : row->fields;
            known = table.call;
            place = table.place;
        } else if (name.empty() == (place == text::Fields::Place::listed)) {
            place = text::Fields::Place::itself;
        } else {
            return {};
        }
    }
    if (known == nullptr || place == text::Fields::Place::by_name) {
        return {};
    }
    return place == text::Fields::Place::listed ? OpenTable{.list = true} : OpenTable{.options = known->options};
}

std::vector<std::string> option_names(lua_State* L, const OpenCall& call) {
    const OpenTable table = open_table(L, call);
    std::vector<std::string> names;
    if (table.list) {
        names.emplace_back("{ ");
    }
    for (const text::Option& option : table.options) {
        if (std::find(call.given.begin(), call.given.end(), option.name) == call.given.end()) {
            names.push_back(std::string(option.name) + " = ");
        }
    }
    return names;
}

/// Functions of ours that make an object of the class.
std::vector<std::string> constructors(std::string_view name) {
    std::vector<std::string> calls;
    for (const help::Section& section : help::sections()) {
        for (const lua::Member& member : section.description->members) {
            const help::Section* made = help::result_class(member.doc.signature);
            if (member.kind == lua::Kind::function && made != nullptr && made->description->name == name) {
                calls.push_back(help::written_name(section, member) + bracket_after(member.doc.signature));
            }
        }
    }
    return calls;
}

/// What the value of an option may be, as far as its row tells. `quote` stands around choices.
std::vector<std::string> option_values(lua_State* L, const OpenCall& call, std::string_view quote) {
    std::vector<std::string> values;
    for (const text::Option& option : open_table(L, call).options) {
        if (option.name != call.option) {
            continue;
        }
        for (const char* choice : option.choices) {
            values.push_back(std::string(quote) + choice + "\"");
        }
        if (option.fields.call != nullptr) {
            values.emplace_back("{ ");
        }
        if (option.filled.kind == text::OptionKind::flag) {
            values.insert(values.end(), {"true", "false"});
        }
        if (*option.object != '\0') {
            values = constructors(option.object);
        }
    }
    return values;
}

/// Whether a text that is typed there may be the name of a file: of our functions only those take one that say so.
bool takes_file(lua_State* L, const OpenCall& call) {
    const lua::Doc* doc = called_doc(L, call);
    if (doc == nullptr) {
        return true;
    }
    return call.option.empty() && !call.options
               ? std::string_view(doc->signature).find("file") != std::string_view::npos
               : call.option == "file";
}

/// Globals, keywords, and the names that the chunk itself uses.
std::vector<std::string> plain_names(lua_State* L, const TypedText& typed, bool calls) {
    std::vector<std::string> names;
    lua_pushglobaltable(L);
    lua_pushnil(L);
    while (lua_next(L, -2) != 0) {
        const std::string name = lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : "";
        if (lua::is_name(name) && (name.front() != '_' || typed.word().starts_with('_'))) {
            names.push_back(name + (calls ? suffix(L) : ""));
        }
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    if (typed.word().empty()) {
        return names;
    }
    names.insert(names.end(), lua::keywords().begin(), lua::keywords().end());
    std::string_view before;
    for (const lua::Token& token : typed.tokens_before()) {
        const std::string name(token.text);
        const bool known = std::any_of(names.begin(), names.end(), [&name](const std::string& n) {
            return n.starts_with(name) && (n.size() == name.size() || !lua::is_name(n));
        });
        if (token.kind == lua::TokenKind::name && before != "." && before != ":" && !known) {
            names.push_back(name);
        }
        before = token.text;
    }
    return names;
}

bool calls_help(const std::optional<OpenCall>& call) {
    return call && call->function.size() == 1 && call->function.front().is("help");
}

}  // namespace

Completion complete(lua_State* L, std::string_view before) {
    if (before.starts_with(':')) {
        return complete_command(L, before);
    }
    if (before.starts_with('?')) {
        const std::size_t begin = std::min(before.find_first_not_of(" ?"), before.size());
        const std::string_view word = before.substr(begin);
        const std::size_t last = word.find_last_of(".: ");
        std::vector<std::string> names = help::help_names();
        const std::vector<std::string> options = help::help_option_names();
        names.insert(names.end(), options.begin(), options.end());
        names = fitting(std::move(names), word);
        for (std::string& name : names) {  // the editor replaces only the last word
            name.erase(0, last == std::string_view::npos ? 0 : last + 1);
        }
        return {names, false};
    }
    const TypedText typed(before);
    const bool help = calls_help(typed.call());
    Completion completion;
    switch (typed.cursor()) {
        case Cursor::string:
            if (typed.call() && !help) {
                completion.names = option_values(L, *typed.call(), "");
                const OpenCall& call = *typed.call();
                const bool listed = call.option.empty() && call.path.size() == 1;  // y = { "theta", "
                if (const std::string_view name = listed ? call.path.front() : call.option;
                    name == "x" || name == "y") {
                    completion.names = columns_of_owner(L, call.function);
                    for (std::string& column : completion.names) column += '"';
                }
            }
            completion.files = !help && completion.names.empty() && (!typed.call() || takes_file(L, *typed.call()));
            completion.names = help ? help::help_names() : completion.names;
            break;
        case Cursor::member:
            completion.names = members(L, typed, !help);
            break;
        case Cursor::option:
            completion.names = option_names(L, *typed.call());
            if (completion.names.empty()) {
                completion.names = plain_names(L, typed, !help);
            }
            break;
        case Cursor::value:
            completion.names = option_values(L, *typed.call(), "\"");
            if (completion.names.empty() || !typed.word().empty()) {
                const std::vector<std::string> names = plain_names(L, typed, !help);
                completion.names.insert(completion.names.end(), names.begin(), names.end());
            }
            break;
        case Cursor::name:
            completion.names = plain_names(L, typed, !help);
            break;
        case Cursor::nothing:
            break;
    }
    completion.names = fitting(std::move(completion.names), typed.word());
    return completion;
}

std::string signature_hint(lua_State* L, std::string_view before) {
    const TypedText typed(before);
    if (!typed.call() || typed.cursor() == Cursor::nothing || typed.call()->braces == help::Braces::nested) {
        return "";
    }
    const lua::Doc* doc = called_doc(L, *typed.call());
    if (doc == nullptr) {
        return "";
    }
    if (!typed.call()->path.empty() && open_table(L, *typed.call()).options.empty()) {
        return "";
    }
    const std::string all = typed.call()->path.empty() ? help::parameters(help::signature(*doc))
                                                       : help::option_list(open_table(L, *typed.call()).options);
    std::string hint;
    std::string part;
    int depth = 0;
    for (std::size_t i = 0; i <= all.size(); ++i) {
        if (i < all.size() && (depth > 0 || all[i] != ',')) {
            depth += all[i] == '{' ? 1 : all[i] == '}' ? -1 : 0;
            part += all[i];
            continue;
        }
        const std::vector<lua::Token> words = lua::tokens(part);
        const auto is_given = [&](const lua::Token& word) {
            return std::find(typed.call()->given.begin(), typed.call()->given.end(), word.text) !=
                   typed.call()->given.end();
        };
        if (!words.empty() && !std::any_of(words.begin(), words.end(), is_given)) {
            hint.append(hint.empty() ? "" : ", ").append(part, std::min(part.find_first_not_of(' '), part.size()));
        }
        part.clear();
    }
    return hint;
}

}  // namespace dinal::prompt
