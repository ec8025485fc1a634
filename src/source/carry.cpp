#include "source/carry.hpp"

#include <fmt/format.h>

#include <type_traits>

#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "lua/prototype.hpp"
#include "lua/standard_globals.hpp"
#include "lua/user_function.hpp"
#include "lua/vector.hpp"
#include "model/controller.hpp"
#include "model/functions.hpp"
#include "motion/integrators.hpp"
#include "source/describe.hpp"
#include "source/fingerprint.hpp"

namespace dinal::source {
namespace {

constexpr int deepest_value = 5000;  // nesting depth of tables, each of which uses the C++ stack

const char memory_key = 0;  // registry key in the target state

}  // namespace

Carrier::Carrier(lua_State* from, lua_State* to, CarryObject other_objects)
    : from_(from), to_(to), other_objects_(other_objects) {
    luaL_checkstack(from, 10, "to carry values");
    lua_newtable(to);
    lua_rawsetp(to, LUA_REGISTRYINDEX, &memory_key);
    lua::push_standard_globals(from);
    lua::push_standard_globals(to);
    lua_pushnil(from);
    while (lua_next(from, -2) != 0) {
        const std::string name = lua_type(from, -2) == LUA_TSTRING ? lua_tostring(from, -2) : "";
        lua_getfield(to, -1, name.c_str());
        if (!name.empty() && name != "_G") note_standard("", name);
        lua_pop(to, 1);
        lua_pop(from, 1);
    }
    lua_pop(from, 1);
    lua_pop(to, 1);
    lua::push_dinal_table(from);
    standard_[lua_topointer(from, -1)] = {"", "dinal"};
    lua_pushglobaltable(from);
    standard_[lua_topointer(from, -1)] = {"", "_G"};
    lua_pop(from, 2);
}

/// Registers the values on the tops of both states as corresponding, if they are the same.
void Carrier::note_standard(const std::string& library, const std::string& name) {
    const int type = lua_type(from_, -1);
    const bool same_type = type == lua_type(to_, -1);
    const bool same_function = type == LUA_TFUNCTION && same_type && lua_tocfunction(from_, -1) != nullptr &&
                               lua_tocfunction(from_, -1) == lua_tocfunction(to_, -1);
    if (same_function || (same_type && (type == LUA_TTABLE || type == LUA_TUSERDATA))) {  // a userdata: io.stdout
        const bool is_new = standard_.try_emplace(lua_topointer(from_, -1), Place{library, name}).second;
        if (is_new && type == LUA_TTABLE && library.empty()) note_library(name);
    } else if (!library.empty() && library != LUA_LOADLIBNAME && type == LUA_TFUNCTION) {
        additions_.push_back({library, name});
    }
}

/// Registers a library, whose tables are on the tops of both states.
void Carrier::note_library(const std::string& library) {
    lua_pushnil(from_);
    while (lua_next(from_, -2) != 0) {
        if (lua_type(from_, -2) == LUA_TSTRING) {
            const std::string member = lua_tostring(from_, -2);
            lua::push_field(to_, -1, member);
            note_standard(library, member);
            lua_pop(to_, 1);
        }
        lua_pop(from_, 1);
    }
}

void Carrier::push_place(const Place& place) {
    lua_pushglobaltable(to_);
    for (const std::string& name : {place.module, place.name}) {
        if (name.empty() || name == "_G") continue;
        lua::push_field(to_, -1, name);
        lua_remove(to_, -2);
    }
}

/// Carries functions that a user has added to libraries, such as string.trim, because ("x"):trim() does not name them.
/// Failures are ignored, as they may be unused.
void Carrier::carry_additions() {
    for (const Place& place : std::exchange(additions_, {})) {
        lua::push_standard_globals(from_);
        lua_getfield(from_, -1, place.module.c_str());
        lua_getfield(from_, -1, place.name.c_str());
        path_ = {place.name};
        if (value(-1)) {
            push_place({place.module, ""});
            lua_insert(to_, -2);
            lua_setfield(to_, -2, place.name.c_str());
            lua_pop(to_, 1);
        }
        lua_pop(from_, 3);
        error_.reset();
    }
}

std::optional<text::Error> Carrier::carry(int index, const std::string& name) {
    index = lua_absindex(from_, index);
    lua_rawgetp(to_, LUA_REGISTRYINDEX, &memory_key);
    memory_ = lua_gettop(to_);
    carry_additions();
    path_ = {name};
    error_.reset();
    const bool good = value(index);
    lua_remove(to_, memory_);
    return good ? std::nullopt : error_;
}

/// The path to the value: "run > helper > cfg.last"; a long one is shortened in the middle.
std::string Carrier::path() const {
    constexpr std::size_t most = 12;
    std::string text;
    for (std::size_t i = 0; i < path_.size(); ++i) {
        const bool left_out = path_.size() > most && i >= most / 2 && i + most / 2 < path_.size();
        if (!left_out) text += path_[i];
        if (left_out && i == most / 2) text += "...";
    }
    return text;
}

bool Carrier::fail(int index, std::string_view cure) {
    const std::string what = lua_iscfunction(from_, index) != 0      ? "a function that is written in C"
                             : lua_type(from_, index) == LUA_TTHREAD ? "a coroutine"
                                                                     : lua::describe(from_, index);
    std::string culprit = path_.back();
    culprit.erase(0, culprit.find_first_not_of(" >."));
    const std::string whole = path();
    const std::string_view first = path_.front();
    error_ =
        path_.size() == 1
            ? text::Error{.sentence = fmt::format("{} is {}, which cannot be in another thread{}", whole, what, cure)}
            : text::Error{.sentence = fmt::format("{} uses {}, {}, which cannot be in another thread{}", first,
                                                  whole.substr(first.size() + (whole[first.size()] == ' ' ? 3 : 0)),
                                                  what, cure),
                          .culprit = culprit};
    return false;
}

/// Registers the value on the top of `to` as the counterpart of `identity`.
void Carrier::remember(const void* identity) {
    lua_pushvalue(to_, -1);
    lua_rawsetp(to_, memory_, identity);
}

/// Pushes the counterpart if the value was carried before or belongs to a library.
bool Carrier::push_counterpart(int index) {
    const void* identity = lua_topointer(from_, index);
    if (lua_rawgetp(to_, memory_, identity) != LUA_TNIL) return true;
    lua_pop(to_, 1);
    const auto found = standard_.find(identity);
    if (found == standard_.end()) return false;
    push_place(found->second);
    return true;
}

/// Pushes the value to `to`; pushes nothing on failure.
bool Carrier::value(int index) {
    luaL_checkstack(from_, 8, "to carry values");
    luaL_checkstack(to_, 12, "for values that are carried");
    index = lua_absindex(from_, index);
    switch (lua_type(from_, index)) {
        case LUA_TNIL:
            lua_pushnil(to_);
            return true;
        case LUA_TBOOLEAN:
            lua_pushboolean(to_, lua_toboolean(from_, index));
            return true;
        case LUA_TNUMBER:
            lua_isinteger(from_, index) != 0 ? lua_pushinteger(to_, lua_tointeger(from_, index))
                                             : lua_pushnumber(to_, lua_tonumber(from_, index));
            return true;
        case LUA_TSTRING:
            lua::push_text(to_, lua::text_at(from_, index));
            return true;
        case LUA_TTABLE:
            return push_counterpart(index) || table(index);
        case LUA_TFUNCTION:
            return push_counterpart(index) ||
                   (lua_iscfunction(from_, index) != 0 ? c_function(index) : function(index));
        case LUA_TUSERDATA:
            return push_counterpart(index) || object(index);
        default:
            return fail(index);
    }
}

bool Carrier::table(int index) {
    if (depth_ >= deepest_value) return fail(index, fmt::format(": it is within {} others", deepest_value));
    ++depth_;
    const int top = lua_gettop(from_), top_there = lua_gettop(to_);
    lua_newtable(to_);
    remember(lua_topointer(from_, index));
    bool good = true;
    lua_pushnil(from_);
    while (good && lua_next(from_, index) != 0) {
        const bool named = lua_type(from_, -2) == LUA_TSTRING && lua::is_name(lua::text_at(from_, -2));
        path_.push_back(named ? fmt::format(".{}", lua_tostring(from_, -2))
                              : fmt::format("[{}]", lua_isinteger(from_, -2) != 0
                                                        ? std::to_string(lua_tointeger(from_, -2))
                                                        : lua::describe(from_, -2)));
        good = value(-2) && value(-1);
        if (good) {
            lua_rawset(to_, top_there + 1);
            path_.pop_back();
            lua_pop(from_, 1);
        }
    }
    if (good && lua_getmetatable(from_, index) != 0) {
        path_.emplace_back(" > its metatable");
        good = value(-1);
        if (good) {
            lua_setmetatable(to_, top_there + 1);
            path_.pop_back();
        }
    }
    lua_settop(from_, top);
    lua_settop(to_, good ? top_there + 1 : top_there);
    --depth_;
    return good;
}

bool Carrier::c_function(int index) {
    const bool plain = lua_getupvalue(from_, index, 1) == nullptr;
    if (!plain) lua_pop(from_, 1);
    if (!plain || lua::documented(from_, index).member == nullptr) return fail(index);
    lua_pushcfunction(to_, lua_tocfunction(from_, index));  // a method of dinal without its object
    return true;
}

bool Carrier::function(int index) {
    if (depth_ >= deepest_value) return fail(index, fmt::format(": it is within {} others", deepest_value));
    int environment = -1;
    for (int i = 1; lua_getupvalue(from_, index, i) != nullptr; ++i) {
        if (lua::is_global_table(from_, -1)) environment = i - 1;
        lua_pop(from_, 1);
    }
    const std::string dumped = lua::dumped_function(from_, index);
    if (luaL_loadbufferx(to_, dumped.data(), dumped.size(), "=carried", "b") != LUA_OK) {
        lua_pop(to_, 1);
        return fail(index);
    }
    remember(lua_topointer(from_, index));
    ++depth_;
    bool good = variables(index, lua_gettop(to_));
    if (const auto facts = facts_of_code(dumped, environment); good && facts && environment >= 0) {
        for (const std::string& name : facts->globals) good = good && global(name);
        const std::vector<std::string> here = path_;
        for (const std::string& name : facts->perhaps) {
            if (!good || global(name)) continue;
            path_ = here;  // the global may not be needed
            error_.reset();
        }
    }
    --depth_;
    if (!good) lua_pop(to_, 1);
    return good;
}

/// Carries the upvalues of the function at `index` to its copy in `to`.
bool Carrier::variables(int index, int copy) {
    for (int i = 1; const char* name = lua_getupvalue(from_, index, i); ++i) {
        const auto [place, is_new] =
            variables_.try_emplace(lua_upvalueid(from_, index, i), Variable{lua_topointer(from_, index), i});
        if (!is_new) {
            lua_rawgetp(to_, memory_, place->second.function);
            lua_upvaluejoin(to_, copy, i, -1, place->second.number);
            lua_pop(to_, 1);
            lua_pop(from_, 1);
            continue;
        }
        path_.push_back(fmt::format(" > {}", *name == '\0' ? "a variable" : name));
        if (!value(-1)) {
            lua_pop(from_, 1);
            return false;
        }
        lua_setupvalue(to_, copy, i);
        path_.pop_back();
        lua_pop(from_, 1);
    }
    return true;
}

/// Carries a global that a function names, if it is a user's.
bool Carrier::global(const std::string& name) {
    if (!globals_.insert(name).second) return true;
    const int type = lua::push_global(from_, name);
    lua::push_standard_globals(from_);
    lua::push_field(from_, -1, name);
    const bool standard = type == LUA_TNIL || lua_rawequal(from_, -1, -3) != 0 || name == "dinal" || name == "_G";
    lua_pop(from_, 2);
    bool good = true;
    if (!standard) {
        path_.push_back(fmt::format(" > {}", name));
        good = value(-1);
        if (good) {
            path_.pop_back();
            lua_pushglobaltable(to_);
            lua_insert(to_, -2);
            lua::push_text(to_, name);
            lua_insert(to_, -2);
            lua_rawset(to_, -3);
            lua_pop(to_, 1);
        }
    }
    lua_pop(from_, 1);
    return good;
}

// Objects of dinal's classes: native parts are shared, user functions in them are carried.

bool Carrier::object(int index) {
    const auto shared = [this](const auto* own) {
        if (own != nullptr) lua::push(to_, *own);
        return own != nullptr;
    };
    const auto part = [this](const auto& own) {
        if constexpr (std::is_same_v<decltype(own), const model::Excitation&>) {
            return excitation(own);
        } else {
            return user_function(own);
        }
    };
    const auto copied = [&](const auto& own) {
        auto copy = model::with_functions(own, part);
        if (!error_) lua::push(to_, std::move(copy));
    };
    const bool known = shared(lua::test<lua::Vector>(from_, index)) ||
                       shared(lua::test<motion::Integrator>(from_, index)) || visit_object(from_, index, copied);
    if (error_) return false;
    if (!known && !other_objects_(from_, index, to_)) {
        const lua::Documented found = lua::documented(from_, index);
        const bool run = found.owner != nullptr && std::string_view(found.owner->name) == "run";
        return fail(index, run ? "; extract what you need before, for example local theta = run.theta" : "");
    }
    remember(lua_topointer(from_, index));
    return true;
}

/// The function in the other state; the same function if it, or an earlier value, cannot be carried.
Carrier::Function Carrier::user_function(const Function& function) {
    if (error_ || function == nullptr) return function;
    const auto* own = dynamic_cast<const lua::LuaFunction*>(function.get());
    if (own == nullptr) return controller(dynamic_cast<const model::Controller&>(*function));
    path_.emplace_back(" > its function");
    own->push(from_);
    const bool good = value(-1);
    lua_pop(from_, 1);
    if (!good) return function;
    path_.pop_back();
    auto copy = std::make_shared<lua::LuaFunction>(to_, lua_gettop(to_), own->role());
    lua_pop(to_, 1);
    if (!own->push_start(from_)) return copy;
    path_.emplace_back(" > start");
    const bool starts = value(-1);
    lua_pop(from_, 1);
    if (!starts) return function;
    path_.pop_back();
    copy->remember_from(to_, -1);
    lua_pop(to_, 1);
    return copy;
}

Carrier::Function Carrier::controller(const model::Controller& own) {
    const Function carried = user_function(own.function);
    if (const auto* relay = dynamic_cast<const model::RelayController*>(&own)) return model::copied(*relay, carried);
    if (const auto* delayed = dynamic_cast<const model::DelayedController*>(&own)) {
        auto copy = std::make_shared<model::DelayedController>();
        copy->function = carried, copy->by = delayed->by;
        return copy;
    }
    const auto& sampled = dynamic_cast<const model::SampledController&>(own);
    auto copy = std::make_shared<model::SampledController>();
    copy->function = carried, copy->carried = true;
    copy->every = sampled.every, copy->delay = sampled.delay, copy->at = sampled.at;
    return copy;
}

model::Excitation Carrier::excitation(const model::Excitation& own) {
    if (!own.has_script()) return own;
    model::Excitation sum;
    for (const model::Component& component : own.components()) {
        model::Term term = component.term;
        if (auto* script = std::get_if<model::Scripted>(&term)) script->function = user_function(script->function);
        // valid, as the original term was
        const model::Excitation one = model::Excitation::make(std::move(term)).value();
        sum = sum + one.scaled(component.gain).windowed(component.from, component.to);
    }
    return sum;
}

}  // namespace dinal::source
