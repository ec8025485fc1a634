#include "prompt/completion.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "errors/advice.hpp"
#include "help/help_text.hpp"
#include "help/library.hpp"
#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "prompt/commands.hpp"
#include "terminal/display.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::prompt {
namespace {

/// The names that begin with the word, sorted.
std::vector<std::string> fitting(std::vector<std::string> names, std::string_view word) {
    std::erase_if(names, [word](const std::string& name) { return !name.starts_with(word); });
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

std::string bracket_after(std::string_view signature) {
    const char bracket = help::call_bracket(signature);
    return bracket == '{' ? "{ " : "(";
}

/// The text after a name for the value on the top: the bracket of a call, or nothing.
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

/// Adds the names that may follow the value on the top and a separator.
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

/// The part of a name such as load.theta that is offered.
enum class Dotted { nothing, first_word, all };

/// Adds the names that a field of the object on the top lists.
void add_listed_names(lua_State* L, const char* field, Dotted dotted, std::vector<std::string>& names) {
    const int object = lua_gettop(L);
    lua_pushvalue(L, object);
    lua_pushstring(L, field);
    errors::go_to_field(L);
    for (lua_Integer i = 1; lua_istable(L, -1) && lua_rawgeti(L, -1, i) == LUA_TSTRING; ++i) {
        const std::string name = lua_tostring(L, -1), first = name.substr(0, name.find('.'));
        const bool offered = first == name || dotted != Dotted::nothing;
        if (offered && lua::is_name(first)) names.push_back(dotted == Dotted::all ? name : first);
        lua_pop(L, 1);
    }
    lua_settop(L, object);
}

std::vector<std::string> members(lua_State* L, const TypedText& typed, bool calls) {
    std::vector<std::string> names;
    const int top = lua_gettop(L);
    const Meaning owner = meaning(L, typed.owner());
    const help::Section* held = owner.kind == Meaning::Kind::object ? owner.section : nullptr;
    if (owner.kind == Meaning::Kind::member && owner.member->kind == lua::Kind::field) {
        held = help::section_of_result(owner.member->doc.signature);
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

/// The documentation of dinal's function in an open call, or nullptr.
const lua::Doc* called_doc(lua_State* L, const OpenCall& call) {
    const int top = lua_gettop(L);
    const Meaning function = meaning(L, call.function);
    lua_settop(L, top);
    return function.kind == Meaning::Kind::member ? &function.member->doc : nullptr;
}

/// The table that contains the cursor.
struct OpenTable {
    std::span<const text::Option> options = {};  ///< its fields; empty if unknown
    bool list = false;                           ///< whether it is a list of tables
};

OpenTable open_table(lua_State* L, const OpenCall& call) {
    const lua::Doc* doc = called_doc(L, call);
    const text::Call* known = doc != nullptr ? help::call_with(*doc, call.braces) : nullptr;
    text::Fields::Place place = text::Fields::Place::itself;
    for (const std::string_view name : call.path) {
        if (known != nullptr && place == text::Fields::Place::itself) {
            const auto row = std::ranges::find(known->options, name, &text::Option::name);
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

/// The bodies and links in a table by name of a system's method: sys:simulate{ theta0 = { load = 1 } }.
std::vector<std::string> joint_names(lua_State* L, const OpenCall& call) {
    std::vector<std::string> names;
    if (call.path.size() != 1 || call.function.size() < 3) return names;
    const std::string_view option = call.path.front();
    const bool of_bodies = option == "theta0" || option == "velocity0" || option == "bodies";
    if (!of_bodies && option != "M" && option != "belt" && option != "links") return names;
    const int top = lua_gettop(L);
    if (meaning(L, call.function.first(call.function.size() - 2)).kind == Meaning::Kind::object) {
        if (option != "links") add_listed_names(L, "bodies", Dotted::nothing, names);
        if (!of_bodies) add_listed_names(L, "links", Dotted::nothing, names);
    }
    lua_settop(L, top);
    return names;
}

std::vector<std::string> option_names(lua_State* L, const OpenCall& call) {
    const OpenTable table = open_table(L, call);
    std::vector<std::string> names = joint_names(L, call);
    std::erase_if(names, [&](const auto& name) { return std::ranges::count(call.given, name) > 0; });
    for (std::string& name : names) name += " = ";
    if (table.list) {
        names.emplace_back("{ ");
    }
    for (const text::Option& option : table.options) {
        if (!text::contains(call.given, option.name)) {
            names.push_back(std::string(option.name) + " = ");
        }
    }
    return names;
}

/// dinal's functions that construct an object of the class.
std::vector<std::string> constructors(std::string_view name) {
    std::vector<std::string> calls;
    for (const help::Section& section : help::sections()) {
        for (const lua::Member& member : section.description->members) {
            const help::Section* made = help::section_of_result(member.doc.signature);
            if (member.kind == lua::Kind::function && made != nullptr && made->description->name == name) {
                calls.push_back(help::written_name(section, member) + bracket_after(member.doc.signature));
            }
        }
    }
    return calls;
}

/// The possible values of an option according to its row. `quote` surrounds choices.
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

/// Returns whether a string at this position may be a file name. For dinal's functions their documentation decides.
bool takes_file(lua_State* L, const OpenCall& call) {
    const lua::Doc* doc = called_doc(L, call);
    if (doc == nullptr) {
        return true;
    }
    return call.option.empty() && !call.options
               ? std::string_view(doc->signature).find("file") != std::string_view::npos
               : call.option == "file";
}

/// Globals, keywords, and names used by the chunk itself.
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
        const bool known = std::ranges::any_of(names, [&name](const std::string& n) {
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
        const std::vector<std::string> of_options = help::help_option_names();
        names.insert(names.end(), of_options.begin(), of_options.end());
        names = fitting(std::move(names), word);
        for (std::string& name : names) {  // the editor replaces the last word only
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
        const lua::Tokens words = lua::tokens(part);
        const auto is_given = [&](const lua::Token& word) { return text::contains(typed.call()->given, word.text); };
        if (!words.empty() && !std::ranges::any_of(words, is_given)) {
            hint.append(hint.empty() ? "" : ", ").append(part, std::min(part.find_first_not_of(' '), part.size()));
        }
        part.clear();
    }
    return hint;
}

namespace {

bool separates(const lua::Token& token) {
    return token.is(".") || token.is(":");
}

}  // namespace

TypedText::TypedText(std::string_view before) : tokens_(lua::tokens(before)) {
    find_cursor(before);
    find_call();
}

void TypedText::find_cursor(std::string_view before) {
    if (!tokens_.empty() && tokens_.back().end() == before.size()) {
        const lua::Token& last = tokens_.back();
        if (last.kind == lua::TokenKind::comment || last.kind == lua::TokenKind::number) {
            return;
        }
        if (last.kind == lua::TokenKind::string) {
            cursor_ = last.open && last.text.front() != '[' ? Cursor::string : Cursor::nothing;
            word_ = last.text.substr(1);
            tokens_.pop_back();
            return;
        }
        if (last.kind != lua::TokenKind::symbol) {
            word_ = last.text;
            tokens_.pop_back();
        }
    }
    cursor_ = Cursor::name;
    if (tokens_.size() > 1 && separates(tokens_.back())) {
        cursor_ = Cursor::member;
        separator_ = tokens_.back().text.front();
        owner_ = expression_before(tokens_.size() - 1);
    }
}

/// The expression that ends before token `end`: a name, fields, calls, brackets. Empty if there is none.
std::span<const lua::Token> TypedText::expression_before(std::size_t end) const {
    std::size_t begin = end;
    while (begin > 0) {
        const lua::Token& last = tokens_[begin - 1];
        if (last.kind == lua::TokenKind::name) {
            --begin;
            if (begin < 2 || !separates(tokens_[begin - 1])) {
                break;
            }
            --begin;
        } else if (last.nesting() < 0) {
            int depth = 0;
            do {
                --begin;
                depth -= tokens_[begin].nesting();
            } while (depth > 0 && begin > 0);
            const bool called =
                begin > 0 && (tokens_[begin - 1].kind == lua::TokenKind::name || tokens_[begin - 1].nesting() < 0);
            if (!called) {
                break;
            }
        } else if (last.kind == lua::TokenKind::string && begin > 1 &&
                   tokens_[begin - 2].kind == lua::TokenKind::name) {
            --begin;  // f"text"
        } else {
            return {};
        }
    }
    return std::span(tokens_).subspan(begin, end - begin);
}

std::vector<std::size_t> TypedText::open_brackets() const {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
        if (tokens_[i].nesting() > 0) {
            open.push_back(i);
        } else if (tokens_[i].nesting() < 0 && !open.empty()) {
            open.pop_back();
        }
    }
    return open;
}

/// The name under which a table, given by its bracket, is a field of an outer one; "" for a list entry. None if it is
/// part of an expression.
std::optional<std::string_view> TypedText::name_of_table(std::size_t bracket, std::size_t outer) const {
    const auto separates_items = [&](std::size_t i) {
        return i == outer || tokens_[i].is(",") || (tokens_[i].is(";") && tokens_[outer].is("{"));
    };
    if (separates_items(bracket - 1)) {
        return "";
    }
    const bool named = bracket - outer > 2 && tokens_[bracket - 1].is("=") && tokens_[outer].is("{") &&
                       tokens_[bracket - 2].kind == lua::TokenKind::name && separates_items(bracket - 3);
    return named ? std::optional(tokens_[bracket - 2].text) : std::nullopt;
}

void TypedText::find_call() {
    const std::vector<std::size_t> open = open_brackets();
    if (cursor_ == Cursor::string && !tokens_.empty() && tokens_.back().kind == lua::TokenKind::name) {
        call_ = OpenCall{.function = expression_before(tokens_.size())};  // f"...
        return;
    }
    if (open.empty()) {
        return;
    }
    const std::size_t bracket = open.back();
    OpenCall call{.function = expression_before(bracket)};
    call.options = tokens_[bracket].is("{");
    std::size_t around = open.size() - 1;
    for (; call.function.empty() && around > 0 && tokens_[open[around]].is("{"); --around) {
        const std::optional<std::string_view> name = name_of_table(open[around], open[around - 1]);
        if (!name) {
            return;
        }
        call.path.insert(call.path.begin(), *name);
        call.function = expression_before(open[around - 1]);
    }
    if (call.function.empty()) {
        return;
    }
    if (!call.path.empty() && call.path.front().empty()) {
        call.braces = tokens_[open[around]].is("(") ? help::Braces::in_parentheses : help::Braces::nested;
        call.path.erase(call.path.begin());
    }
    int depth = 0;
    for (std::size_t i = bracket + 1; i + 1 < tokens_.size(); ++i) {
        depth += tokens_[i].nesting();
        if (depth == 0 && tokens_[i].kind == lua::TokenKind::name && tokens_[i + 1].is("=")) {
            call.given.push_back(tokens_[i].text);
        }
    }
    const lua::Token& last = tokens_.back();
    if (call.options && cursor_ == Cursor::name && (last.is("{") || last.is(",") || last.is(";"))) {
        cursor_ = Cursor::option;
    }
    if (call.options && last.is("=") && tokens_.size() > bracket + 2) {
        call.option = tokens_[tokens_.size() - 2].text;
        cursor_ = cursor_ == Cursor::name ? Cursor::value : cursor_;
    }
    call_ = call;
}

namespace {

/// Returns whether a string literal has no escapes.
bool is_plain_string(const lua::Token& token) {
    return token.kind == lua::TokenKind::string && !token.open && token.text.front() != '[' &&
           token.text.find('\\') == std::string_view::npos;
}

const lua::Member* member_of(const lua::Class& description, std::string_view name) {
    const auto found = std::ranges::find_if(description.members, [name](const lua::Member& m) {
        return m.kind != lua::Kind::metamethod && m.name == name;
    });
    return found == description.members.end() ? nullptr : &*found;
}

Meaning meaning_of_top(lua_State* L) {
    if (lua_isnil(L, -1)) return {};
    const lua::Documented found = lua::documented(L, -1);
    if (found.member != nullptr) return {Meaning::Kind::member, section_of(found.owner), found.member};
    const bool object = found.owner != nullptr && lua_isuserdata(L, -1) != 0;
    return object ? Meaning{Meaning::Kind::object, section_of(found.owner)} : Meaning{Meaning::Kind::value};
}

/// Evaluates an expression step by step. `result` is the meaning so far; its value is on the top of the stack, nil if
/// only documentation is known.
class Walk {
public:
    explicit Walk(lua_State* L) : L_(L) { lua_pushnil(L_); }

    Meaning result;

    void begin(const lua::Token& token) {
        if (token.kind != lua::TokenKind::name) return;
        lua_pop(L_, 1);
        lua_pushglobaltable(L_);
        go_to_field(token.text);
    }

    void go_to_field(std::string_view name) {
        const lua::Class* owner = class_here();
        lua_pushlstring(L_, name.data(), name.size());
        errors::go_to_field(L_);
        result = meaning_of_top(L_);
        if (const lua::Member* member = owner == nullptr ? nullptr : member_of(*owner, name)) {
            result = {Meaning::Kind::member, section_of(owner), member};
        }
    }

    /// Follows an index with a number: run.events[1].
    void index(lua_Integer number) {
        lua_pushinteger(L_, number);
        errors::go_to_field(L_);
        result = meaning_of_top(L_);
    }

    void call() {
        const lua::Doc* doc = result.member != nullptr ? &result.member->doc : nullptr;
        if (lua_istable(L_, -1)) {
            const lua::Documented module = lua::documented(L_, -1);
            doc = module.owner != nullptr ? &module.owner->doc : nullptr;
        }
        const help::Section* object = doc == nullptr ? nullptr : help::section_of_result(doc->signature);
        forget();
        if (object != nullptr) {
            result = {Meaning::Kind::object, object, nullptr};
        }
    }

    void forget() {
        result = {};
        lua_pop(L_, 1);
        lua_pushnil(L_);
    }

private:
    /// The class here, according to the value or the documentation; nullptr for others.
    const lua::Class* class_here() {
        if (lua_isuserdata(L_, -1) != 0) return lua::documented(L_, -1).owner;
        const bool field = result.kind == Meaning::Kind::member && result.member->kind == lua::Kind::field;
        const help::Section* section = field ? help::section_of_result(result.member->doc.signature) : result.section;
        const bool known = lua_isnil(L_, -1) && (field || result.kind == Meaning::Kind::object);
        return known && section != nullptr ? section->description : nullptr;
    }

    lua_State* L_;
};

}  // namespace

const help::Section* section_of(const lua::Class* description) {
    const auto all = help::sections();
    const auto found = std::ranges::find(all, description, &help::Section::description);
    return found == all.end() ? nullptr : &*found;
}

Meaning meaning(lua_State* L, std::span<const lua::Token> expression) {
    luaL_checkstack(L, LUA_MINSTACK, "for the meaning of what is typed");
    Walk walk(L);
    if (expression.empty()) {
        return {};
    }
    walk.begin(expression.front());
    for (std::size_t i = 1; i < expression.size(); ++i) {
        const lua::Token& token = expression[i];
        if (token.kind == lua::TokenKind::name) {
            walk.go_to_field(token.text);
        } else if (token.kind == lua::TokenKind::string || token.nesting() > 0) {
            const lua::Token* key =
                i + 2 < expression.size() && expression[i + 2].is("]") ? &expression[i + 1] : nullptr;
            if (!token.is("[")) {
                walk.call();
            } else if (key != nullptr && key->kind == lua::TokenKind::number) {
                walk.index(std::strtoll(std::string(key->text).c_str(), nullptr, 10));
            } else if (key != nullptr && is_plain_string(*key)) {
                walk.go_to_field(key->text.substr(1, key->text.size() - 2));
            } else {
                walk.forget();
            }
            int depth = token.kind == lua::TokenKind::string ? 0 : 1;
            while (depth > 0 && i + 1 < expression.size()) {
                depth += expression[++i].nesting();
            }
        }
    }
    return walk.result;
}

void add_own_names(lua_State* L, std::vector<std::string>& names) {
    const lua::Class* description = lua_isuserdata(L, -1) != 0 ? lua::documented(L, -1).owner : nullptr;
    if (description == nullptr) return;
    const std::string_view name = description->name;
    if (name == "system") {
        add_listed_names(L, "bodies", Dotted::nothing, names);
        add_listed_names(L, "links", Dotted::nothing, names);
    } else if (description->other_keys != nullptr) {
        add_listed_names(L, "names", name == "run" ? Dotted::first_word : Dotted::nothing, names);
    }
}

std::vector<std::string> columns_of_owner(lua_State* L, std::span<const lua::Token> function) {
    std::vector<std::string> names;
    const std::size_t size = function.size();
    if (size < 3 || !function[size - 2].is(":")) {
        return names;
    }
    const int top = lua_gettop(L);
    const Meaning owner = meaning(L, function.first(size - 2));
    if (owner.kind == Meaning::Kind::object && lua_isuserdata(L, -1)) add_listed_names(L, "names", Dotted::all, names);
    for (const lua::Member& member : owner.kind == Meaning::Kind::object && owner.section != nullptr && names.empty()
                                         ? owner.section->description->members
                                         : std::span<const lua::Member>()) {
        const help::Section* held = help::section_of_result(member.doc.signature);
        if (member.kind == lua::Kind::field && held != nullptr &&
            held->description->name == std::string_view("vector")) {
            names.emplace_back(member.name);
        }
    }
    lua_settop(L, top);
    return names;
}

namespace {

/// Runs `work`, catching Lua errors (only insufficient memory).
template <class Work>
void safely(lua_State* L, Work work) {
    const auto trampoline = [](lua_State* state) {
        auto& function = *static_cast<Work*>(lua_touserdata(state, 1));
        lua_settop(state, 0);
        function(state);
        return 0;
    };
    const int top = lua_gettop(L);
    lua_pushcfunction(L, trampoline);
    lua_pushlightuserdata(L, &work);
    lua_pcall(L, 1, 0, 0);
    lua_settop(L, top);
}

bool is_simple(std::string_view text, bool unicode) {
    return std::ranges::all_of(text, [unicode](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte >= 0x20 && byte != 0x7F && (byte < 0x80 || unicode);
    });
}

/// As many whole words of a list as fit.
std::string fitting_list(const std::string& list, std::size_t room, bool unicode) {
    if (text::columns(list) <= room) {
        return list;
    }
    const std::string_view more = unicode ? ", …" : ", ...";
    const std::string_view cut = text::cut_to_columns(list, room > 5 ? room - 5 : 0);
    const std::size_t comma = cut.rfind(',');
    return comma == std::string_view::npos ? "" : std::string(cut.substr(0, comma)).append(more);
}

}  // namespace

Painted paint(lua_State* L, const LineOnScreen& shown) {
    const terminal::Display screen = terminal::display_of(STDOUT_FILENO);
    const std::size_t before = text::columns(shown.prompt);
    const std::size_t used = before + text::columns(shown.line);
    constexpr std::size_t spare = 2;  // a completely full row may already have been wrapped
    if (used + spare >= screen.width || !is_simple(shown.prompt, screen.unicode) ||
        !is_simple(shown.line, screen.unicode)) {
        return {};
    }
    const std::size_t room = screen.width - used - spare;
    constexpr std::size_t gap = 2;
    std::string hint;
    if (shown.line.empty()) {
        hint = text::cut_to_columns(shown.cue, room);
    } else if (shown.cursor == shown.line.size() && !shown.rest.empty() && is_simple(shown.rest, screen.unicode)) {
        hint = text::cut_to_columns(shown.rest, room);
    } else if (shown.cursor == shown.line.size()) {
        safely(L, [&](lua_State* state) { hint = signature_hint(state, shown.pending + std::string(shown.line)); });
        hint = fitting_list(hint, room > gap ? room - gap : 0, screen.unicode);
        hint.insert(0, hint.empty() ? 0 : gap, ' ');
    }
    if (hint.empty()) return {};
    // octal if a digit follows: \x1b7 would be one character
    const std::string right = used > 0 ? fmt::format("\x1b[{}C", used) : "";
    return {fmt::format("\0337\r{}\x1b[90m{}\x1b[0m\x1b[K\0338", right, hint), true};
}

Completion complete_safely(lua_State* L, const std::string& before) {
    Completion completion;
    safely(L, [&](lua_State* state) { completion = complete(state, before); });
    return completion;
}

}  // namespace dinal::prompt
