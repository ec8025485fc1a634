#include "source/function_source.hpp"

#include <algorithm>
#include <vector>

#include "files/file.hpp"
#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "lua/prototype.hpp"
#include "lua/standard_globals.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::source {
namespace {

const char kept_key = 0;   // registry key of kept texts: name -> list of texts
const char known_key = 0;  // registry key of results: function -> its text

/// Distinguishes functions: lines, names, and bytes of code.
struct Shape {
    lua_Debug about{};
    std::vector<std::string> upvalues;
    std::string code;

    Shape(lua_State* L, int index) {
        index = lua_absindex(L, index);
        lua_pushvalue(L, index);
        lua_getinfo(L, ">Su", &about);
        for (int i = 1; const char* name = lua_getupvalue(L, index, i); ++i) {
            upvalues.emplace_back(name);
            lua_pop(L, 1);
        }
        code = lua::dumped_function(L, index, true);
    }
    bool like(const Shape& other) const {
        return about.linedefined == other.about.linedefined && about.lastlinedefined == other.about.lastlinedefined &&
               about.nparams == other.about.nparams && about.isvararg == other.about.isvararg &&
               upvalues == other.upvalues;
    }
};

/// "function(t) ... end" from "function M(t) ... end"; empty for a method, whose text lacks self.
std::string without_name(std::string_view function) {
    const std::size_t parameters = function.find('(');
    if (parameters == std::string_view::npos || function.substr(0, parameters).find(':') != std::string_view::npos) {
        return "";
    }
    return "function" + std::string(function.substr(parameters));
}

enum class Likeness { none, shape, code };

/// Compiles the text at the same line with the same variables around it, and compares.
Likeness likeness(lua_State* L, const std::string& source, const Shape& wanted) {
    std::string chunk;
    for (const std::string& name : wanted.upvalues) {
        chunk += name == "_ENV" ? "" : "local " + name + " ";
    }
    chunk.append(static_cast<std::size_t>(std::max(wanted.about.linedefined - 1, 0)), '\n');
    chunk += "return " + source;
    const int top = lua_gettop(L);
    Likeness result = Likeness::none;
    // The call only makes the function: the chunk is a list of variables and one function.
    if (luaL_loadbufferx(L, chunk.data(), chunk.size(), "=source", "t") == LUA_OK && lua_pcall(L, 0, 1, 0) == LUA_OK &&
        lua_isfunction(L, -1)) {
        const Shape found(L, -1);
        if (found.like(wanted)) {
            result = found.code == wanted.code ? Likeness::code : Likeness::shape;
        }
    }
    lua_settop(L, top);
    return result;
}

/// The texts of possible matches, as expressions, each once.
// NOTE: the code of an inner function also numbers the variables of the outer one, which its own text lacks. So if no
// code is equal, the shape decides, provided that it is unique.
struct Found {
    std::vector<std::string> by_shape;
    std::vector<std::string> by_code;

    std::optional<std::string> only() const {
        const auto& best = by_code.empty() ? by_shape : by_code;
        return best.size() == 1 ? std::optional(best.front()) : std::nullopt;
    }
};

void find_in(lua_State* L, std::string_view text, const Shape& wanted, Found& found) {
    for (const auto function : lua::functions_between(text, wanted.about.linedefined, wanted.about.lastlinedefined)) {
        const std::string source = without_name(function);
        const Likeness like = source.empty() ? Likeness::none : likeness(L, source, wanted);
        if (like != Likeness::none) {
            auto& list = like == Likeness::code ? found.by_code : found.by_shape;
            if (!text::contains(list, source)) {
                list.push_back(source);
            }
        }
    }
}

void find_in_kept(lua_State* L, const Shape& wanted, Found& found) {
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &kept_key) == LUA_TTABLE &&
        lua_getfield(L, -1, wanted.about.source) == LUA_TTABLE) {
        for (auto i = static_cast<lua_Integer>(lua_rawlen(L, -1)); i > 0; --i) {
            lua_rawgeti(L, -1, i);
            find_in(L, lua_tostring(L, -1), wanted, found);
            lua_pop(L, 1);
        }
    }
}

/// "math.sin" for the C function at `index` if a loaded module has it under that name.
std::optional<std::string> library_name(lua_State* L, int index) {
    const int top = lua_gettop(L);
    std::optional<std::string> name;
    lua_getfield(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
    lua_pushnil(L);
    while (!name && lua_next(L, top + 1) != 0) {
        if (lua_type(L, top + 2) == LUA_TSTRING && lua_istable(L, top + 3)) {
            const std::string module = lua_tostring(L, top + 2);
            if (module == LUA_GNAME) {  // not under a user's own name
                lua::push_standard_globals(L);
                lua_replace(L, top + 3);
            }
            lua_pushnil(L);
            while (!name && lua_next(L, top + 3) != 0) {
                if (lua_type(L, -2) == LUA_TSTRING && lua_rawequal(L, -1, index) != 0) {
                    name = (module == LUA_GNAME ? "" : module + ".") + lua_tostring(L, -2);
                }
                lua_pop(L, 1);
            }
        }
        lua_settop(L, top + 2);
    }
    lua_settop(L, top);
    return name;
}

/// An expression that loads a main chunk again: from its file or, for load("..."), from its text, which is the chunk's
/// name.
std::optional<std::string> whole_chunk(std::string_view source) {
    if (source.starts_with('=')) {
        return std::nullopt;
    }
    return source.starts_with('@') ? "loadfile(" + text::quoted(source.substr(1)) + ")"
                                   : "load(" + text::quoted(source) + ")";
}

/// Pushes the weak table of texts by function; false stands for a function without text.
void push_known(lua_State* L) {
    lua::push_weak_table(L, &known_key);
}

}  // namespace

// Results stay valid: a function never changes, even if its file does.
std::optional<std::string> function_source(lua_State* L, int index) {
    luaL_checkstack(L, LUA_MINSTACK, "for the text of a function");
    index = lua_absindex(L, index);
    if (lua_type(L, index) != LUA_TFUNCTION) {
        return std::nullopt;
    }
    if (lua_iscfunction(L, index) != 0) {
        return library_name(L, index);
    }
    push_known(L);
    lua_pushvalue(L, index);
    if (lua_rawget(L, -2) != LUA_TNIL) {
        const bool is_text = lua_type(L, -1) == LUA_TSTRING;
        auto known = is_text ? std::optional<std::string>(lua::text_at(L, -1)) : std::nullopt;
        lua_pop(L, 2);
        return known;
    }
    lua_pop(L, 2);
    const Shape wanted(L, index);
    const std::string_view source = wanted.about.source;
    if (wanted.about.what == std::string_view("main")) {
        return whole_chunk(source);
    }
    const int top = lua_gettop(L);
    Found found;
    if (source.starts_with('=')) {
        find_in_kept(L, wanted, found);
    } else if (!source.starts_with('@')) {
        find_in(L, source, wanted, found);
    } else if (const auto text = files::read_file(std::string(source.substr(1)))) {
        find_in(L, *text, wanted, found);
    }
    lua_settop(L, top);
    auto only = found.only();
    push_known(L);
    lua_pushvalue(L, index);
    if (only) {
        lua::push_text(L, *only);
    } else {
        lua_pushboolean(L, 0);
    }
    lua_rawset(L, -3);
    lua_pop(L, 1);
    return only;
}

void keep_source(lua_State* L, const char* chunk_name, std::string_view text) {
    const int top = lua_gettop(L);
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &kept_key) != LUA_TTABLE) {
        lua_newtable(L);
        lua_pushvalue(L, -1);
        lua_rawsetp(L, LUA_REGISTRYINDEX, &kept_key);
    }
    luaL_getsubtable(L, -1, chunk_name);
    const int texts = lua_gettop(L);
    lua_pushlstring(L, text.data(), text.size());
    lua_pushvalue(L, -1);
    lua_rawseti(L, texts, 0);  // the last one
    lua_pushvalue(L, -1);
    if (lua_rawget(L, texts) == LUA_TNIL) {  // each text is listed once, however often it is loaded
        lua_pushvalue(L, texts + 1);
        lua_pushboolean(L, 1);
        lua_rawset(L, texts);
        lua_pushvalue(L, texts + 1);
        lua_rawseti(L, texts, static_cast<lua_Integer>(lua_rawlen(L, texts)) + 1);
    }
    lua_settop(L, top);
}

std::optional<std::string> last_kept_source(lua_State* L, const std::string& chunk_name) {
    luaL_checkstack(L, LUA_MINSTACK, "for the text of a chunk");
    const int top = lua_gettop(L);
    std::optional<std::string> text;
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &kept_key) == LUA_TTABLE &&
        lua_getfield(L, -1, chunk_name.c_str()) == LUA_TTABLE) {
        lua_rawgeti(L, -1, 0);
        text = lua::text_at(L, -1);
    }
    lua_settop(L, top);
    return text;
}

}  // namespace dinal::source
