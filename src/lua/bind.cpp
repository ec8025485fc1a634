#include "lua/bind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lua/error_memory.hpp"
#include "lua/standard_globals.hpp"
#include "lua/values.hpp"
#include "text/characters.hpp"

namespace dinal::lua {

namespace {

// Registry key of the table that maps functions and module tables to their documentation.
const char documentation_key = 0;
// The address of this variable is the key under which a metatable stores its Class.
const char class_key = 0;

void push_documentation(lua_State* L) {
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &documentation_key) != LUA_TTABLE) {
        lua_pop(L, 1);
        lua_newtable(L);
        lua_pushvalue(L, -1);
        lua_rawsetp(L, LUA_REGISTRYINDEX, &documentation_key);
    }
}

// Documents the value on the top as { owner, member }; the value stays.
void document(lua_State* L, const Class& owner, const Member* member) {
    push_documentation(L);
    lua_pushvalue(L, -2);
    lua_createtable(L, 2, 0);
    lua_pushlightuserdata(L, const_cast<Class*>(&owner));  // only read
    lua_rawseti(L, -2, 1);
    lua_pushlightuserdata(L, const_cast<Member*>(member));
    lua_rawseti(L, -2, 2);
    lua_rawset(L, -3);
    lua_pop(L, 1);
}

std::string with_article(std::string_view name) {
    const bool vowel = std::string_view("aeiou").find(name.front()) != std::string_view::npos;
    return (vowel ? "an " : "a ") + std::string(name);
}

std::string key_text(lua_State* L, int index) {
    if (lua_type(L, index) == LUA_TSTRING) {
        return "'" + std::string(lua_tostring(L, index)) + "'";
    }
    return "[" + describe(L, index) + "]";
}

std::vector<std::string_view> visible_names(const Class& description) {
    std::vector<std::string_view> names;
    for (const Member& member : description.members) {
        if (member.kind != Kind::metamethod) {
            names.emplace_back(member.name);
        }
    }
    return names;
}

std::string suggestion_for_key(lua_State* L, int index, const Class& description) {
    return lua_type(L, index) == LUA_TSTRING ? text::did_you_mean(lua_tostring(L, index), visible_names(description))
                                             : "";
}

/// The end of a sentence that lists the names of an object of the class.
std::string names_in(const Class& description) {
    const std::vector<std::string_view> names = visible_names(description);
    return names.empty() ? "" : fmt::format("; it has {}", fmt::join(names, ", "));
}

const Class& class_of_closure(lua_State* L, int upvalue) {
    return *static_cast<const Class*>(lua_touserdata(L, lua_upvalueindex(upvalue)));
}

// Upvalues: methods by name, getters by name, the Class.
int index_object(lua_State* L) {
    const Class& description = class_of_closure(L, 3);
    if (lua_type(L, 2) == LUA_TSTRING) {
        if (description.first_keys != nullptr && description.first_keys(L) == 1) return 1;
        lua_pushvalue(L, 2);
        if (lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL) {
            return 1;
        }
        lua_pushvalue(L, 2);
        if (lua_rawget(L, lua_upvalueindex(2)) != LUA_TNIL) {
            lua_pushvalue(L, 1);
            lua_call(L, 1, 1);
            return 1;
        }
        lua_settop(L, 2);
    }
    if (description.other_keys != nullptr && description.other_keys(L) == 1) {
        return 1;
    }
    raise(L, {.sentence = with_article(description.name) + " has no field " + key_text(L, 2),
              .culprit = written(L, 2),
              .cure = suggestion_for_key(L, 2, description),
              .instead = names_in(description)});
}

int refuse_assignment(lua_State* L) {
    const Class& description = class_of_closure(L, 1);
    raise(L, {.sentence = with_article(description.name) + " cannot be changed, so " + key_text(L, 2) +
                          " cannot be set; make a new one",
              .culprit = written(L, 2)});
}

int index_module(lua_State* L) {
    const Class& module = class_of_closure(L, 1);
    const std::string name = module.name;
    const std::string likely = suggestion_for_key(L, 2, module);
    if (lua_type(L, 2) == LUA_TSTRING && is_of_dinal(L, lua_tostring(L, 2))) {
        const std::string alone = lua_tostring(L, 2);
        raise(L, {.sentence = "there is no " + name + "." + alone,
                  .call = name,
                  .culprit = alone,
                  .cure = "; " + alone + " is written without " + name + " and the point"});
    }
    raise(L,
          {.sentence = "there is no " + name + (lua_type(L, 2) == LUA_TSTRING ? "." + written(L, 2) : key_text(L, 2)),
           .call = name,
           .culprit = written(L, 2),
           .cure = likely,
           .instead = names_in(module)});
}

int module_text(lua_State* L) {
    const Class& module = class_of_closure(L, 1);
    std::string text = std::string(module.name) + ":";
    for (const std::string_view name : visible_names(module)) {
        text += (text.back() == ':' ? " " : ", ") + std::string(name);
    }
    text += "; help(" + std::string(module.name) + ") says more";
    return push_text(L, text);
}

void set_metamethods(lua_State* L, const Class& description) {
    for (const Member& member : description.members) {
        if (member.kind == Kind::metamethod) {
            lua_pushcfunction(L, member.call);
            lua_setfield(L, -2, std::string(member.name).c_str());
        }
    }
    lua_pushstring(L, description.name);
    lua_setfield(L, -2, "__name");
}

void push_members(lua_State* L, const Class& description, Kind kind) {
    lua_newtable(L);
    for (const Member& member : description.members) {
        if (member.kind == kind) {
            lua_pushcfunction(L, member.call);
            document(L, description, &member);
            lua_setfield(L, -2, std::string(member.name).c_str());
        }
    }
}

}  // namespace

std::string where(lua_State* L) {
    lua_Debug frame{};
    for (int level = 0; lua_getstack(L, level, &frame) != 0; ++level) {
        lua_getinfo(L, "Sl", &frame);
        if (frame.currentline > 0) {
            return std::string(frame.short_src) + ":" + std::to_string(frame.currentline) + ": ";
        }
    }
    return "";
}

void raise(lua_State* L, const text::Error& error) {
    {
        // the message may contain names of columns and files, and a script may print caught errors
        const std::string message = text::harmless(where(L) + error.message());
        remember_facts(L, error);
        lua_settop(L, 0);  // arguments are no longer needed
        lua_pushlstring(L, message.data(), message.size());
    }
    lua_error(L);
    std::terminate();  // lua_error does not return, but is not declared so
}

void raise(lua_State* L, std::string_view sentence) {
    raise(L, text::Error{std::string(sentence)});
}

void raise_got(lua_State* L, int index, std::string_view call, std::string_view wanted, std::string_view end) {
    raise(L, {.sentence = std::string(wanted) + ", got " + describe(L, index) + std::string(end),
              .call = std::string(call),
              .culprit = written(L, index)});
}

int push_text(lua_State* L, std::string_view text) {
    lua_pushlstring(L, text.data(), text.size());
    return 1;
}

int push_field(lua_State* L, int index, std::string_view name) {
    index = lua_absindex(L, index);
    push_text(L, name);
    return lua_rawget(L, index);
}

int push_global(lua_State* L, std::string_view name) {
    lua_pushglobaltable(L);
    const int type = push_field(L, -1, name);
    lua_remove(L, -2);
    return type;
}

void push_weak_table(lua_State* L, const void* key) {
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, key) == LUA_TTABLE) return;
    lua_pop(L, 1);
    lua_newtable(L);
    lua_createtable(L, 0, 1);
    push_text(L, "k");
    lua_setfield(L, -2, "__mode");
    lua_setmetatable(L, -2);
    lua_pushvalue(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, key);
}

void set_number(lua_State* L, const char* name, double value) {
    lua_pushnumber(L, value);
    lua_setfield(L, -2, name);
}

std::string describe(lua_State* L, int index) {
    switch (lua_type(L, index)) {
        case LUA_TNONE:
        case LUA_TNIL:
            return "nil";
        case LUA_TBOOLEAN:
            return lua_toboolean(L, index) != 0 ? "true" : "false";
        case LUA_TNUMBER: {
            if (std::isnan(lua_tonumber(L, index))) {
                return "nan";  // Lua itself prints -nan for 0/0
            }
            lua_pushvalue(L, index);  // lua_tostring changes the value it converts
            std::string text = lua_tostring(L, -1);
            lua_pop(L, 1);
            return text;
        }
        case LUA_TSTRING: {
            const std::string_view text = lua_tostring(L, index);
            return "the string \"" + std::string(text.substr(0, 40)) + (text.size() > 40 ? "..." : "") + "\"";
        }
        case LUA_TUSERDATA:
            if (const Documented found = documented(L, index); found.owner != nullptr) {
                return with_article(found.owner->name);
            }
            break;
        default:
            break;
    }
    return "a " + std::string(luaL_typename(L, index));
}

std::string written(lua_State* L, int index) {
    const int type = lua_type(L, index);
    if (type == LUA_TSTRING) {
        return lua_tostring(L, index);
    }
    return type == LUA_TNUMBER || type == LUA_TBOOLEAN || type <= LUA_TNIL ? describe(L, index) : "";
}

void note_order(lua_State* L, const NamedNumbers& numbers) {
    std::vector<const char*> names;
    for (const auto& [name, number] : numbers) names.push_back(name);
    if (luaL_newmetatable(L, fmt::format("order {}", fmt::join(names, " ")).c_str()) != 0) {
        set_value(L, "names", names);
        lua_pushnil(L);
        lua_setfield(L, -2, "__name");  // otherwise tostring would show it
    }
    lua_setmetatable(L, -2);
}

double finite_argument(lua_State* L, int index, std::string_view what) {
    if (lua_type(L, index) != LUA_TNUMBER || !std::isfinite(lua_tonumber(L, index))) {
        raise_got(L, index, what, std::string(what) + " must be a finite number");
    }
    return lua_tonumber(L, index);
}

void add_module(lua_State* L, const Class& module) {
    push_members(L, module, Kind::function);
    document(L, module, nullptr);
    lua_newtable(L);
    set_metamethods(L, module);
    lua_pushlightuserdata(L, const_cast<Class*>(&module));  // only read
    lua_pushcclosure(L, guarded<index_module>, 1);
    lua_setfield(L, -2, "__index");
    lua_pushlightuserdata(L, const_cast<Class*>(&module));
    lua_pushcclosure(L, guarded<module_text>, 1);
    lua_setfield(L, -2, "__tostring");
    lua_setmetatable(L, -2);
    lua_setfield(L, -2, module.name);
}

void add_functions(lua_State* L, const Class& functions) {
    for (const Member& member : functions.members) {
        lua_pushcfunction(L, member.call);
        document(L, functions, &member);
        lua_setfield(L, -2, std::string(member.name).c_str());
    }
}

Documented documented(lua_State* L, int index) {
    Documented found;
    if (lua_isuserdata(L, index) != 0 && lua_getmetatable(L, index) != 0) {
        lua_rawgetp(L, -1, &class_key);
        found.owner = static_cast<const Class*>(lua_touserdata(L, -1));
        lua_pop(L, 2);
        return found;
    }
    if (lua_isnoneornil(L, index)) {
        return found;
    }
    lua_pushvalue(L, index);
    push_documentation(L);
    lua_insert(L, -2);
    if (lua_rawget(L, -2) == LUA_TTABLE) {
        lua_rawgeti(L, -1, 1);
        lua_rawgeti(L, -2, 2);
        found = {static_cast<const Class*>(lua_touserdata(L, -2)), static_cast<const Member*>(lua_touserdata(L, -1))};
        lua_pop(L, 2);
    }
    lua_pop(L, 2);
    return found;
}

namespace detail {

std::string signature_of_running(lua_State* L) {
    lua_Debug frame{};
    lua_getstack(L, 0, &frame);
    lua_getinfo(L, "f", &frame);
    const Documented found = documented(L, -1);
    lua_pop(L, 1);
    const std::string_view signature = found.member != nullptr ? found.member->doc.signature : "object:method()";
    return std::string(signature.substr(0, signature.find(" ->")));
}

void raise_argument(lua_State* L, int index, std::string_view wanted) {
    const std::string call = signature_of_running(L);
    const std::size_t open = call.find('(');
    std::string_view names = std::string_view(call).substr(open == std::string::npos ? call.size() : open + 1);
    // A method's object is its first argument but stands before the parentheses.
    for (int i = call.find(':') < open ? 2 : 1; i < index; ++i)
        names.remove_prefix(std::min(names.find(", "), names.size() - 2) + 2);
    raise_got(L, index, call,
              fmt::format("{}: {} must be {}", call, names.substr(0, names.find_first_of(",)] ")), wanted));
}

std::string article_and_name(lua_State* L, const void* key) {
    push_metatable(L, key);
    lua_getfield(L, -1, "__name");
    return with_article(lua_tostring(L, -1));
}

void raise_no_object(lua_State* L, std::string_view call) {
    raise(L, {.sentence = "use a colon: " + std::string(call), .call = std::string(call)});
}

void push_message(lua_State* L, const char* text) {
    const std::string message = where(L) + text;
    lua_settop(L, 0);
    push_text(L, message);
}

int raise_message_on_top(lua_State* L) {
    return lua_error(L);
}

void push_metatable(lua_State* L, const void* key) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, key);
}

void* test(lua_State* L, int index, const void* key) {
    if (lua_type(L, index) != LUA_TUSERDATA || lua_getmetatable(L, index) == 0) {
        return nullptr;
    }
    lua_rawgetp(L, LUA_REGISTRYINDEX, key);
    const bool same = lua_rawequal(L, -1, -2) != 0;
    lua_pop(L, 2);
    return same ? lua_touserdata(L, index) : nullptr;
}

void add_class(lua_State* L, const Class& description, const void* key, lua_CFunction collect) {
    auto* upvalue = const_cast<Class*>(&description);  // only read
    lua_newtable(L);
    set_metamethods(L, description);
    push_members(L, description, Kind::method);
    push_members(L, description, Kind::field);
    lua_pushlightuserdata(L, upvalue);
    lua_pushcclosure(L, guarded<index_object>, 3);
    lua_setfield(L, -2, "__index");
    lua_pushlightuserdata(L, upvalue);
    lua_pushcclosure(L, guarded<refuse_assignment>, 1);
    lua_setfield(L, -2, "__newindex");
    lua_pushcfunction(L, collect);
    lua_setfield(L, -2, "__gc");
    lua_pushstring(L, description.name);
    lua_setfield(L, -2, "__metatable");
    lua_pushlightuserdata(L, upvalue);
    lua_rawsetp(L, -2, &class_key);
    lua_rawsetp(L, LUA_REGISTRYINDEX, key);
}

}  // namespace detail

}  // namespace dinal::lua
