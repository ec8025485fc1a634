#include "prompt/call.hpp"

#include <fmt/core.h>

#include <string_view>
#include <vector>

#include "errors/error_remarks.hpp"
#include "files/file.hpp"
#include "lua/error_memory.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_message.hpp"
#include "lua/lua_text.hpp"
#include "lua/memory_limit.hpp"
#include "lua/safe_mode.hpp"

namespace dinal::prompt {
namespace {

constexpr std::size_t longest_message = 10'000;  // bytes; longer messages are cut
constexpr std::size_t inner_frames = 10;         // about as many as luaL_traceback shows
constexpr std::size_t outer_frames = 4;

struct Frame {
    std::string name;   ///< "in function 'f'"
    std::string place;  ///< "lab.lua:10"
};

std::string function_name(const lua_Debug& info) {
    const std::string_view kind = info.namewhat;
    if (*info.what == 'm') {
        // A chunk of load() is named by its text in brackets, or by a name chosen by the script.
        const bool in_file = *info.source == '@';
        return fmt::format("in {} {}", in_file ? "file" : "what load() made of", info.short_src);
    }
    if (info.name == nullptr || kind.empty()) {
        return fmt::format("in the function at {}:{}", info.short_src, info.linedefined);
    }
    if (kind == "for iterator") {
        return "in the iterator of a for loop";
    }
    return fmt::format("in {} '{}'", kind == "method" || kind == "metamethod" ? kind : "function", info.name);
}

/// Adds the Lua function at this level of the call stack; skips C functions.
void add_frame(lua_State* L, lua_Debug& info, std::vector<Frame>& frames) {
    lua_getinfo(L, "Snl", &info);
    if (*info.what != 'C') {
        frames.push_back({function_name(info), fmt::format("{}:{}", info.short_src, info.currentline)});
    }
}

/// The number of levels of the stack. NOTE: lua_getstack takes time proportional to the level, so bisection is used.
int stack_height(lua_State* L) {
    lua_Debug info;
    int above = 1;
    while (lua_getstack(L, above, &info) != 0) {
        above *= 2;
    }
    int below = above / 2;
    while (above - below > 1) {
        const int middle = (below + above) / 2;
        (lua_getstack(L, middle, &info) != 0 ? below : above) = middle;
    }
    return above;
}

/// The running Lua functions, innermost first. In a deep recursion a frame without place replaces those in the middle.
std::vector<Frame> lua_frames(lua_State* L) {
    std::vector<Frame> frames;
    lua_Debug info;
    int level = 1;
    for (; frames.size() < inner_frames; ++level) {
        if (lua_getstack(L, level, &info) == 0) {
            return frames;
        }
        add_frame(L, info, frames);
    }
    const int height = stack_height(L);
    const int rest = height - static_cast<int>(outer_frames);
    if (level < rest) {
        frames.push_back({"...", ""});
        level = rest;
    }
    for (; lua_getstack(L, level, &info) != 0; ++level) {
        add_frame(L, info, frames);
    }
    return frames;
}

std::string trace(const std::vector<Frame>& frames) {
    std::string text;
    for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
        const Frame& caller = frames[i + 1];
        text += "\n  " + frames[i].name;
        if (!frames[i].place.empty() && !caller.place.empty()) {
            text += ", called from " + caller.place;
        }
    }
    return text;
}

int to_text(lua_State* L) {
    luaL_tolstring(L, 1, nullptr);
    return 1;
}

/// The error object as text; if it has none, its type, as in lua.
std::string message_of(lua_State* L) {
    const std::string type = luaL_typename(L, 1);
    if (lua_isstring(L, 1) == 0 && luaL_getmetafield(L, 1, "__tostring") == LUA_TNIL) {
        return fmt::format("(error object is a {} value)", type);
    }
    lua_pushcfunction(L, to_text);
    lua_pushvalue(L, 1);
    const bool speaks = lua_pcall(L, 1, 1, 0) == LUA_OK;
    const std::string text = take_text(L);
    return speaks ? text : fmt::format("(error object is a {} value, and its __tostring failed: {})", type, text);
}

/// "a:1: a:1: a:1: oh" becomes "a:1: oh": each coroutine.wrap on the way out prepends its position.
std::string without_repeated_head(const std::string& message) {
    const std::size_t end = message.find(": ");
    if (end == std::string::npos) {
        return message;
    }
    const std::string_view text = message;
    const std::string_view head = text.substr(0, end + 2);
    std::size_t start = 0;
    while (text.substr(start + head.size(), head.size()) == head) {
        start += head.size();
    }
    return message.substr(start);
}

std::string shortened(std::string message) {
    message = without_repeated_head(message);
    if (message.size() > longest_message) {
        const std::size_t size = message.size();
        message.resize(longest_message);
        message += fmt::format("... ({} bytes)", size);
    }
    return message;
}

int message_handler(lua_State* L) {
    const std::vector<Frame> frames = lua_frames(L);
    std::string text;
    if (lua::interrupt_requested()) {
        text = frames.empty() ? "interrupted" : "interrupted at " + frames.front().place;
    } else {
        const lua::Remarks remarks = errors::remarks_on(L, 1);
        text = shortened(message_of(L)) + remarks.suggestion + remarks.excerpt + remarks.during + trace(frames);
    }
    lua_pushlstring(L, text.data(), text.size());
    return 1;
}

/// A Lua function that returns the loaded chunk or the message, and the status.
int load_named(lua_State* L) {
    lua_pushinteger(L, luaL_loadfilex(L, lua_tostring(L, 1), lua::load_mode()));
    return 2;
}

}  // namespace

int call(lua_State* L, int arguments, int results) {
    const int function = lua_gettop(L) - arguments;
    lua_pushcfunction(L, message_handler);
    lua_insert(L, function);
    lua::forget_remarks(L);
    int status = LUA_OK;
    {
        const lua::InterruptScope armed(L);
        status = lua_pcall(L, arguments, results, function);
        lua::stop_after_refusal();
    }
    lua_remove(L, function);
    if (const std::string limit = lua::reached_limit(); !limit.empty()) {  // even if a pcall has swallowed the error
        lua_settop(L, function - 1);
        lua_pushlstring(L, limit.data(), limit.size());
        return LUA_ERRRUN;
    }
    if (status < 0) {  // an uncaught C++ exception: the stack has no message
        lua_pop(L, 1);
        lua_pushliteral(L, "internal error: a C++ exception reached Lua; please report it");
    }
    return status;
}

std::string load_error_text(lua_State* L, const char* file) {
    const lua::Remarks remarks = errors::remarks_on_syntax(L, -1, file);
    std::string text = take_text(L);
    // Lua's messages are suitable except those about bytecode, which Lua's own program would refuse as well.
    if (text == "not enough memory" && lua::memory_limit() > 0) {
        return lua::limit_sentence(lua::Stop::memory, "");
    }
    if (lua::is_about_forbidden_bytecode(text)) {
        return "the script is Lua bytecode, which safe mode does not take: run its source instead";
    }
    if (lua::is_about_foreign_bytecode(text)) {
        text += "; it is Lua bytecode that this Lua (" LUA_RELEASE ") cannot run: run its source instead";
    }
    return text + remarks.suggestion + remarks.excerpt;
}

std::string take_text(lua_State* L) {
    std::string result(lua_isstring(L, -1) != 0 ? lua::text_at(L, -1) : "(no message)");
    lua_pop(L, 1);
    return result;
}

int load_file(lua_State* L, const char* file) {
    if (const auto why = files::outside(file, files::Access::read)) {
        const std::string text = fmt::format("cannot open {}: {}", file, *why);
        lua_pushlstring(L, text.data(), text.size());
        return LUA_ERRFILE;
    }
    lua_pushcfunction(L, load_named);
    lua_pushstring(L, file);
    int status = call(L, 1, 2);
    if (status == LUA_OK) {
        status = static_cast<int>(lua_tointeger(L, -1));
        lua_pop(L, 1);
    }
    return status;
}

}  // namespace dinal::prompt
