#include "source/fingerprint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "lua/standard_globals.hpp"
#include "lua/user_function.hpp"
#include "lua/vector.hpp"
#include "model/laws/user_law.hpp"
#include "model/oscillator.hpp"
#include "model/springs/user_spring.hpp"
#include "source/bytecode.hpp"
#include "source/describe.hpp"

namespace dinal::source {
namespace {

constexpr std::uint64_t being_looked_at = 0x5c0de;  // a value that leads back to itself

std::uint64_t joined_digest(std::uint64_t a, std::uint64_t b) {
    return digest_of({reinterpret_cast<const char*>(&b), sizeof b}, a);
}

std::uint64_t digest_of_numbers(std::span<const double> numbers, std::uint64_t before) {
    return digest_of({reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()}, before);
}

int collect_dump(lua_State* /*L*/, const void* piece, std::size_t size, void* text) {
    static_cast<std::string*>(text)->append(static_cast<const char*>(piece), size);
    return 0;
}

}  // namespace

void Fingerprint::add(std::string_view bytes) {
    number_ = joined_digest(digest_of(bytes, number_), bytes.size());
}

void Fingerprint::add(double number) {
    number_ = joined_digest(number_, std::bit_cast<std::uint64_t>(number));
}

void Fingerprint::add_value(int index) {
    number_ = joined_digest(number_, of_value(lua_absindex(L_, index)));
}

std::string Fingerprint::text() const {
    return fmt::format("{:016x}", number_);
}

std::uint64_t Fingerprint::of_value(int index) {
    luaL_checkstack(L_, 10, "for a fingerprint");
    index = lua_absindex(L_, index);
    const int type = lua_type(L_, index);
    const std::uint64_t start = joined_digest(digest_start, static_cast<std::uint64_t>(type));
    switch (type) {
        case LUA_TBOOLEAN:
            return joined_digest(start, static_cast<std::uint64_t>(lua_toboolean(L_, index)));
        case LUA_TNUMBER:
            return lua_isinteger(L_, index) != 0
                       ? joined_digest(start, static_cast<std::uint64_t>(lua_tointeger(L_, index)))
                       : joined_digest(start + 1, std::bit_cast<std::uint64_t>(lua_tonumber(L_, index)));
        case LUA_TSTRING:
            return digest_of(lua::text_at(L_, index), start);
        case LUA_TTABLE:
        case LUA_TFUNCTION:
        case LUA_TUSERDATA: {
            const void* identity = lua_topointer(L_, index);
            const auto [place, is_new] = known_.try_emplace(identity, being_looked_at);
            if (!is_new) return place->second;
            const std::uint64_t digest = type == LUA_TTABLE      ? of_table(index)
                                         : type == LUA_TFUNCTION ? of_function(index)
                                                                 : of_object(index);
            return known_[identity] = joined_digest(start, digest);
        }
        default:
            return start;
    }
}

std::uint64_t Fingerprint::of_table(int index) {
    lua_pushglobaltable(L_);
    const bool globals = lua_rawequal(L_, -1, index) != 0;
    lua_pop(L_, 1);
    if (globals || lua::documented(L_, index).owner != nullptr) return 0;  // of the library
    std::uint64_t sum = 0;                                                 // in whatever order lua_next gives them
    lua_pushnil(L_);
    while (lua_next(L_, index) != 0) {
        sum += joined_digest(of_value(-2), of_value(-1));
        lua_pop(L_, 1);
    }
    if (lua_getmetatable(L_, index) != 0) {
        sum = joined_digest(sum, of_value(-1));
        lua_pop(L_, 1);
    }
    return sum;
}

std::uint64_t Fingerprint::of_function(int index) {
    if (lua_iscfunction(L_, index) != 0) return 1;  // which one is told by the name that leads to it
    int environment = -1;
    std::uint64_t digest = digest_start;
    for (int i = 1; lua_getupvalue(L_, index, i) != nullptr; ++i) {
        lua_pushglobaltable(L_);
        const bool globals = lua_rawequal(L_, -1, -2) != 0;
        lua_pop(L_, 1);
        environment = globals ? i - 1 : environment;
        digest = joined_digest(digest, globals ? 0 : of_value(-1));
        lua_pop(L_, 1);
    }
    std::string dumped;
    lua_pushvalue(L_, index);
    lua_dump(L_, collect_dump, &dumped, 0);
    lua_pop(L_, 1);
    const auto facts = facts_of_code(dumped, environment);
    if (!facts) return digest_of(dumped, digest);
    digest = joined_digest(digest, facts->digest);
    for (const std::string& name : facts->globals) digest = joined_digest(digest, of_global(name));
    return digest;
}

std::uint64_t Fingerprint::of_global(const std::string& name) {
    lua_pushglobaltable(L_);
    lua::push_text(L_, name);
    lua_rawget(L_, -2);
    lua::push_standard_globals(L_);
    lua::push_text(L_, name);
    lua_rawget(L_, -2);
    const bool standard = lua_rawequal(L_, -1, -3) != 0 || name == "dinal" || name == "_G";
    lua_pop(L_, 2);
    const std::uint64_t digest = standard ? 0 : of_value(-1);
    lua_pop(L_, 2);
    return digest;
}

std::uint64_t Fingerprint::of_user_function(const model::terms::UserFunction& function) {
    const auto* own = dynamic_cast<const lua::LuaFunction*>(&function);
    if (own == nullptr) return 0;
    own->push(L_);
    const std::uint64_t digest = of_value(-1);
    lua_pop(L_, 1);
    return digest;
}

std::uint64_t Fingerprint::of_excitation(const model::Excitation& excitation) {
    std::uint64_t digest = digest_of(describe(L_, excitation));
    for (const model::Component& component : excitation.components()) {
        if (const auto* script = std::get_if<model::Scripted>(&component.term)) {
            digest = joined_digest(digest, of_user_function(*script->function));
        } else if (const auto* line = std::get_if<model::Polyline>(&component.term)) {
            digest = digest_of_numbers(line->samples->M, digest_of_numbers(line->samples->t, digest));
        }
    }
    return digest;
}

std::uint64_t Fingerprint::of_object(int index) {
    if (const auto* vector = lua::test<lua::Vector>(L_, index)) {
        return digest_of_numbers(vector->values(), digest_start);
    }
    if (const auto* excitation = lua::test<model::Excitation>(L_, index)) return of_excitation(*excitation);
    const model::Friction* law = lua::test<model::Friction>(L_, index);
    const model::Spring* spring = lua::test<model::Spring>(L_, index);
    if (const auto* system = lua::test<model::Oscillator>(L_, index)) {
        law = &system->friction();
        spring = &system->spring();
    }
    const auto* written = law == nullptr ? nullptr : law->as<model::laws::UserLaw>();
    std::uint64_t digest = written == nullptr ? 0 : of_user_function(*written->function);
    const auto* own = spring == nullptr ? nullptr : spring->as<model::springs::UserSpring>();
    if (own != nullptr) digest = joined_digest(digest, of_user_function(*own->function));
    if (lua::documented(L_, index).owner != nullptr) {
        digest = digest_of(lua::text_at(L_, (luaL_tolstring(L_, index, nullptr), -1)), digest);
        lua_pop(L_, 1);
    }
    return digest;
}

}  // namespace dinal::source
