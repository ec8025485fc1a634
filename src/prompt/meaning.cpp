#include "prompt/meaning.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "help/signature.hpp"
#include "lua/bind.hpp"
#include "lua/lua_text.hpp"

namespace dinal::prompt {
namespace {

constexpr int most_metatables = 10;  // an __index may lead to itself

bool closes(const lua::Token& token) {
    return token.is(")") || token.is("}") || token.is("]");
}

/// One that means what stands between its quotes.
bool is_plain_string(const lua::Token& token) {
    return token.kind == lua::TokenKind::string && !token.open && token.text.front() != '[' &&
           token.text.find('\\') == std::string_view::npos;
}

const lua::Member* member_of(const lua::Class& description, std::string_view name) {
    const auto found =
        std::find_if(description.members.begin(), description.members.end(),
                     [name](const lua::Member& m) { return m.kind != lua::Kind::metamethod && m.name == name; });
    return found == description.members.end() ? nullptr : &*found;
}

/// Walks along the expression. What is known so far is `result`; its value is on the top of the stack.
class Walk {
public:
    explicit Walk(lua_State* L) : L_(L) {
        lua_pushnil(L_);
        owner_ = lua_gettop(L_);
        lua_pushnil(L_);
    }

    Meaning result;

    void begin(const lua::Token& token) {
        if (token.kind == lua::TokenKind::name) {
            lua_pop(L_, 1);
            lua_pushglobaltable(L_);
            raw_field(token.text);
        }
    }

    void go_to_field(std::string_view name) {
        if (result.kind == Meaning::Kind::value) {
            const lua::Documented found = lua::documented(L_, -1);
            if (lua_isuserdata(L_, -1) != 0) {
                if (found.owner == nullptr) {
                    forget();
                    return;
                }
                lua_copy(L_, -1, owner_);
                go_to_member(*found.owner, name);
                field_ = name;
            } else {
                raw_field(name);
            }
        } else if (result.kind == Meaning::Kind::object) {
            go_to_member(*result.section->description, name);
        } else if (result.kind == Meaning::Kind::member) {
            const help::Section* held =
                result.member->kind == lua::Kind::field ? help::result_class(result.member->doc.signature) : nullptr;
            held != nullptr ? go_to_member(*held->description, name) : forget();
        }
    }

    /// list[1], of tables as they are, and of data in an object: run.events[1].
    void index(lua_Integer number) {
        if (result.kind == Meaning::Kind::value && lua_istable(L_, -1)) {
            lua_rawgeti(L_, -1, number);
            lua_remove(L_, -2);
            return;
        }
        const bool data =
            result.kind == Meaning::Kind::member && result.member->kind == lua::Kind::field && !field_.empty() &&
            help::result_class(result.member->doc.signature) != nullptr &&
            help::result_class(result.member->doc.signature)->description->name == std::string_view("data");
        const std::string field(field_);
        forget();
        if (data) {
            row_of(field, number);
        }
    }

    void call() {
        const lua::Doc* doc = nullptr;
        if (result.kind == Meaning::Kind::member) {
            doc = &result.member->doc;
        } else if (result.kind == Meaning::Kind::value) {
            const lua::Documented found = lua::documented(L_, -1);
            const bool module = found.owner != nullptr && found.member == nullptr && lua_istable(L_, -1);
            doc = found.member != nullptr ? &found.member->doc : module ? &found.owner->doc : nullptr;
        }
        const help::Section* object = doc == nullptr ? nullptr : help::result_class(doc->signature);
        forget();
        if (object != nullptr) {
            result = {Meaning::Kind::object, object, nullptr};
        }
    }

    void forget() {
        result = {};
        field_ = {};
        lua_pop(L_, 1);
        lua_pushnil(L_);
    }

private:
    /// Replaces the nil on the top by a row of the data in a field of the owner: what is asked is ours, and no code of
    /// the user.
    void row_of(const std::string& field, lua_Integer number) {
        const auto get = [](lua_State* L) {
            lua_getfield(L, 1, lua_tostring(L, 2));
            lua_geti(L, -1, lua_tointeger(L, 3));
            return 1;
        };
        lua_pushcfunction(L_, get);
        lua_pushvalue(L_, owner_);
        lua_pushstring(L_, field.c_str());
        lua_pushinteger(L_, number);
        if (lua_pcall(L_, 3, 1, 0) != LUA_OK || !lua_istable(L_, -1)) {
            lua_pop(L_, 1);
            return;
        }
        lua_replace(L_, -2);
        result = {Meaning::Kind::value, nullptr, nullptr};
    }

    /// Replaces the table on the top by its field, looked up in the tables of __index, too.
    void raw_field(std::string_view name) {
        for (int i = 0; i < most_metatables; ++i) {
            if (lua_istable(L_, -1)) {
                lua_pushlstring(L_, name.data(), name.size());
                if (lua_rawget(L_, -2) != LUA_TNIL) {
                    lua_replace(L_, -2);
                    result = {Meaning::Kind::value, nullptr, nullptr};
                    return;
                }
                lua_pop(L_, 1);
            }
            if (lua_getmetatable(L_, -1) == 0) {
                break;
            }
            lua_pushliteral(L_, "__index");
            lua_rawget(L_, -2);
            lua_replace(L_, -3);
            lua_pop(L_, 1);
        }
        forget();
    }

    void go_to_member(const lua::Class& description, std::string_view name) {
        const lua::Member* member = member_of(description, name);
        forget();
        if (member != nullptr) {
            result = {Meaning::Kind::member, section_of(&description), member};
        }
    }

    lua_State* L_;
    int owner_ = 0;           // the object whose field was gone to last
    std::string_view field_;  // the name of that, empty when something else came after it
};

}  // namespace

const help::Section* section_of(const lua::Class* description) {
    const auto all = help::sections();
    const auto found = std::find_if(all.begin(), all.end(),
                                    [description](const help::Section& s) { return s.description == description; });
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
        } else if (token.kind == lua::TokenKind::string || token.is("(") || token.is("{") || token.is("[")) {
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
                ++i;
                const lua::Token& inner = expression[i];
                depth += inner.is("(") || inner.is("{") || inner.is("[") ? 1 : closes(inner) ? -1 : 0;
            }
        }
    }
    Meaning result = walk.result;
    if (result.kind == Meaning::Kind::value) {
        if (const lua::Documented found = lua::documented(L, -1); found.member != nullptr) {
            result = {Meaning::Kind::member, section_of(found.owner), found.member};
        } else if (found.owner != nullptr && lua_isuserdata(L, -1) != 0) {
            result = {Meaning::Kind::object, section_of(found.owner), nullptr};
        }
    }
    return result;
}

namespace {

/// As a function that Lua can call: what is in a field of an object of ours.
int field_of_object(lua_State* L) {
    lua_gettable(L, 1);
    return 1;
}

}  // namespace

void go_to_field(lua_State* L, std::string_view name) {
    lua_pushcfunction(L, field_of_object);
    lua_insert(L, -2);
    lua_pushlstring(L, name.data(), name.size());
    if (lua_pcall(L, 2, 1, 0) != LUA_OK) {
        lua_pop(L, 1);
        lua_pushnil(L);
    }
}

void add_own_names(lua_State* L, std::vector<std::string>& names) {
    const lua::Class* description = lua_isuserdata(L, -1) != 0 ? lua::documented(L, -1).owner : nullptr;
    if (description == nullptr || description->other_keys == nullptr) {
        return;
    }
    const int object = lua_gettop(L);
    lua_pushvalue(L, object);
    go_to_field(L, "names");
    for (lua_Integer i = 1; lua_istable(L, -1) && lua_rawgeti(L, -1, i) == LUA_TSTRING; ++i) {
        if (const std::string name = lua_tostring(L, -1); lua::is_name(name)) {
            names.push_back(name);
        }
        lua_pop(L, 1);
    }
    lua_settop(L, object);
}

std::vector<std::string> columns_of_owner(lua_State* L, std::span<const lua::Token> function) {
    std::vector<std::string> names;
    const std::size_t size = function.size();
    if (size < 3 || !function[size - 2].is(":")) {
        return names;
    }
    const int top = lua_gettop(L);
    const Meaning owner = meaning(L, function.first(size - 2));
    add_own_names(L, names);
    for (const lua::Member& member : owner.kind == Meaning::Kind::object && owner.section != nullptr && names.empty()
                                         ? owner.section->description->members
                                         : std::span<const lua::Member>()) {
        const help::Section* held = help::result_class(member.doc.signature);
        if (member.kind == lua::Kind::field && held != nullptr &&
            held->description->name == std::string_view("vector")) {
            names.emplace_back(member.name);
        }
    }
    lua_settop(L, top);
    return names;
}

}  // namespace dinal::prompt
