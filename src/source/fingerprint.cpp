// A value and its references form a graph, possibly deep and cyclic. It is traversed object by object; each new object
// gets the next number, by which later references identify it. So the order of traversal must be the same in every
// process, unlike Lua's order of fields.

#include "source/fingerprint.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <tuple>
#include <type_traits>

#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "lua/prototype.hpp"
#include "lua/standard_globals.hpp"
#include "lua/user_function.hpp"
#include "lua/vector.hpp"
#include "model/controller.hpp"
#include "model/functions.hpp"
#include "source/describe.hpp"

namespace dinal::source {

namespace {

std::uint64_t joined_digest(std::uint64_t a, std::uint64_t b) {
    return digest_of({reinterpret_cast<const char*>(&b), sizeof b}, a);
}

/// Mixes a digest before summation, so that every bit affects every bit (the finalizer of MurmurHash3). Otherwise the
/// sum would often stay the same when two fields exchange values.
std::uint64_t stirred(std::uint64_t digest) {
    digest = (digest ^ digest >> 33U) * 0xff51afd7ed558ccdU;
    digest = (digest ^ digest >> 33U) * 0xc4ceb9fe1a85ec53U;
    return digest ^ digest >> 33U;
}

}  // namespace

void Fingerprint::join(std::uint64_t digest) {
    number_ = joined_digest(number_, digest);
}

void Fingerprint::add(std::string_view bytes) {
    number_ = digest_of(bytes, number_);
    join(bytes.size());
}

void Fingerprint::add(double number) {
    join(std::bit_cast<std::uint64_t>(number));
}

void Fingerprint::add_value(int index) {
    luaL_checkstack(L_, LUA_MINSTACK, "for a fingerprint");
    index = lua_absindex(L_, index);
    lua_newtable(L_);
    objects_ = lua_gettop(L_);
    numbers_.clear();
    order_.clear();
    sketches_ = {};
    libraries();
    join(reference(index));
    for (std::size_t i = 0; i < order_.size(); ++i) {
        lua_rawgetp(L_, objects_, order_[i]);
        content(lua_gettop(L_));
        lua_settop(L_, objects_);
    }
    lua_settop(L_, objects_ - 1);
}

/// Names the initial contents of libraries. Functions added by a user, such as string.trim, belong to every value:
/// ("x"):trim() does not name them.
void Fingerprint::libraries() {
    const int top = lua_gettop(L_), globals = top + 1, fields = top + 2, library = top + 4, copy = top + 5;
    std::vector<std::pair<std::string, Visited>> additions;
    const auto note = [this](int index, const std::string& name) {
        if (const void* identity = lua_topointer(L_, index)) standard_[identity] += stirred(digest_of(name));
    };
    standard_.clear();
    lua::push_dinal_table(L_);
    note(-1, "dinal");
    lua_pop(L_, 1);
    lua::push_standard_globals(L_);
    lua::push_standard_fields(L_);
    lua_pushnil(L_);
    while (lua_next(L_, globals) != 0) {
        const std::string name = lua_type(L_, -2) == LUA_TSTRING ? lua_tostring(L_, -2) : "";
        note(library, name);
        lua_pushvalue(L_, library);
        if (name != LUA_GNAME && lua_istable(L_, library) && lua_rawget(L_, fields) == LUA_TTABLE) {
            lua_pushnil(L_);
            while (lua_next(L_, copy) != 0) {
                if (lua_type(L_, -2) == LUA_TSTRING) note(-1, name + '.' + lua_tostring(L_, -2));
                lua_pop(L_, 1);
            }
            lua_pushnil(L_);
            while (name != LUA_LOADLIBNAME && lua_next(L_, library) != 0) {
                lua_pushvalue(L_, -2);
                lua_rawget(L_, copy);
                const bool own =
                    lua_type(L_, -3) == LUA_TSTRING && lua_isfunction(L_, -2) && lua_rawequal(L_, -1, -2) == 0;
                if (own) additions.emplace_back(name + '.' + lua_tostring(L_, -3), piece(lua_gettop(L_) - 1));
                lua_pop(L_, 2);
            }
        }
        lua_settop(L_, library - 1);
    }
    lua_settop(L_, top);
    std::ranges::sort(additions, [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [name, own] : additions) {
        add(name);
        join(reference(own));
    }
}

Fingerprint::Visited Fingerprint::piece(int index) {
    const int type = lua_type(L_, index);
    const std::uint64_t start = joined_digest(digest_start, static_cast<std::uint64_t>(type));
    switch (type) {
        case LUA_TBOOLEAN:
            return {joined_digest(start, static_cast<std::uint64_t>(lua_toboolean(L_, index)))};
        case LUA_TNUMBER:
            return {lua_isinteger(L_, index) != 0
                        ? joined_digest(start, static_cast<std::uint64_t>(lua_tointeger(L_, index)))
                        : joined_digest(start + 1, std::bit_cast<std::uint64_t>(lua_tonumber(L_, index)))};
        case LUA_TSTRING:
            return {digest_of(lua::text_at(L_, index), start)};
        case LUA_TTABLE:
        case LUA_TFUNCTION:
        case LUA_TUSERDATA: {
            const void* identity = lua_topointer(L_, index);
            if (const auto found = standard_.find(identity); found != standard_.end()) {
                return {joined_digest(start, found->second)};
            }
            lua_pushvalue(L_, index);
            lua_rawsetp(L_, objects_, identity);
            return {start, identity};
        }
        default:
            return {start};
    }
}

std::uint64_t Fingerprint::reference(const Visited& piece) {
    if (piece.object == nullptr) return piece.digest;
    const auto [place, is_new] = numbers_.try_emplace(piece.object, numbers_.size());
    if (is_new) order_.push_back(piece.object);
    return joined_digest(piece.digest, place->second);
}

/// A digest that contains no object numbers, used to sort keys that are objects. Keys with equal digests have no
/// defined order.
std::uint64_t Fingerprint::sketch(int index, int depth) {
    luaL_checkstack(L_, LUA_MINSTACK, "for a fingerprint");
    index = lua_absindex(L_, index);
    const Visited own = piece(index);
    if (own.object == nullptr || depth == 0) return own.digest;
    auto& known = sketches_.at(static_cast<std::size_t>(depth) - 1);
    if (const auto found = known.find(own.object); found != known.end()) return found->second;
    std::uint64_t sum = own.digest;
    if (lua_isfunction(L_, index)) {
        const std::string code = lua_iscfunction(L_, index) != 0 ? "" : lua::dumped_function(L_, index);
        if (const auto facts = facts_of_code(code, -1)) sum += facts->digest;
    } else if (lua_istable(L_, index)) {
        lua_pushnil(L_);
        while (lua_next(L_, index) != 0) {
            sum += stirred(joined_digest(sketch(-2, depth - 1), sketch(-1, depth - 1)));
            lua_pop(L_, 1);
        }
    } else if (lua::documented(L_, index).owner != nullptr) {
        sum += digest_of(printed(index));
    }
    known[own.object] = sum;
    return sum;
}

void Fingerprint::content(int index) {
    switch (lua_type(L_, index)) {
        case LUA_TTABLE:
            return table(index);
        case LUA_TFUNCTION:
            return function(index);
        default:
            return object(index);
    }
}

void Fingerprint::table(int index) {
    if (lua::documented(L_, index).owner != nullptr) return;  // a class of dinal
    struct Entry {
        std::uint64_t key_sketch, value_sketch;
        Visited key, value;
    };
    constexpr int deep_enough = std::tuple_size_v<decltype(sketches_)>;
    std::vector<Entry> entries;
    std::uint64_t sum = 0;  // digest of other fields, independent of the order of lua_next
    lua_pushnil(L_);
    while (lua_next(L_, index) != 0) {
        const Visited key = piece(-2), value = piece(-1);
        if (key.object == nullptr && value.object == nullptr) {
            sum += stirred(joined_digest(key.digest, value.digest));
        } else if (key.object == nullptr) {
            entries.push_back({key.digest, 0, key, value});
        } else {
            entries.push_back({sketch(-2, deep_enough), sketch(-1, deep_enough), key, value});
        }
        lua_pop(L_, 1);
    }
    std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
        return std::tie(a.key_sketch, a.value_sketch) < std::tie(b.key_sketch, b.value_sketch);
    });
    join(sum);
    join(entries.size());
    for (const Entry& entry : entries) {
        join(reference(entry.key));
        join(reference(entry.value));
    }
    if (lua_getmetatable(L_, index) != 0) join(reference(-1));
}

void Fingerprint::function(int index) {
    if (lua_iscfunction(L_, index) != 0) {  // a method taken out of its object; others cannot be carried
        if (const lua::Foreign* other = lua::foreign(L_, index)) return join(other->number);  // its text is unknown
        const lua::Documented found = lua::documented(L_, index);
        if (found.member != nullptr) add(found.member->doc.signature);
        return;
    }
    int environment = -1;
    for (int i = 1; lua_getupvalue(L_, index, i) != nullptr; ++i) {
        if (lua::is_global_table(L_, -1)) {
            environment = i - 1;
        } else {
            join(numbers_.try_emplace(lua_upvalueid(L_, index, i), numbers_.size()).first->second);
            join(reference(-1));
        }
        lua_pop(L_, 1);
    }
    const std::string dumped = lua::dumped_function(L_, index);
    const auto facts = facts_of_code(dumped, environment);
    if (!facts) return add(dumped);
    join(facts->digest);
    for (const std::string& name : facts->globals) global(name);
    for (const std::string& name : facts->perhaps) global(name);
}

void Fingerprint::global(const std::string& name) {
    const int top = lua_gettop(L_);
    lua::push_global(L_, name);
    lua::push_standard_globals(L_);
    lua::push_field(L_, -1, name);
    const bool standard = lua_rawequal(L_, -1, -3) != 0 || name == "dinal" || name == LUA_GNAME;
    join(standard ? 0 : reference(top + 1));
    lua_settop(L_, top);
}

/// The text that print shows.
std::string Fingerprint::printed(int index) {
    luaL_tolstring(L_, index, nullptr);
    std::string text(lua::text_at(L_, -1));
    lua_pop(L_, 1);
    return text;
}

void Fingerprint::user_function(const model::terms::UserFunction& function) {
    if (const auto* own = dynamic_cast<const lua::LuaFunction*>(&function)) {
        own->push(L_);
        join(reference(-1));
        lua_pop(L_, 1);
        if (own->push_start(L_)) {
            join(reference(-1));
            lua_pop(L_, 1);
        }
    } else if (const auto* controller = dynamic_cast<const model::Controller*>(&function)) {
        if (controller->function != nullptr) user_function(*controller->function);
    }
}

void Fingerprint::excitation(const model::Excitation& excitation) {
    const auto numbers = [this](const std::vector<double>& all) {
        join(all.size());
        for (const double x : all) add(x);
    };
    for (const model::Component& component : excitation.components()) {
        if (const auto* script = std::get_if<model::Scripted>(&component.term)) {
            user_function(*script->function);
        } else if (const auto* line = std::get_if<model::Polyline>(&component.term)) {
            numbers(line->samples->t);
            numbers(line->samples->M);
        }
    }
}

/// Adds an object by its text without functions, and by those functions.
void Fingerprint::object(int index) {
    if (const auto* vector = lua::test<lua::Vector>(L_, index)) {
        join(vector->size());
        for (const double x : *vector) add(x);
        return;
    }
    ValueText no_functions(L_, 0);
    const auto part = [this](const auto& own) {
        if constexpr (std::is_same_v<decltype(own), const model::Excitation&>) {
            excitation(own);
        } else {
            user_function(*own);
        }
        return own;
    };
    const auto written = [&](const auto& own) {
        add(lua_text(L_, own, &no_functions));
        static_cast<void>(model::with_functions(own, part));
    };
    if (!visit_object(L_, index, written) && !other_objects_(L_, index, *this) &&
        lua::documented(L_, index).owner != nullptr) {
        add(printed(index));
    }
}

// Facts in the bytecode of a function.

namespace {

constexpr std::uint32_t get_upvalue = 9, get_global = 11, set_global = 15;  // OP_GETUPVAL, OP_GETTABUP, OP_SETTABUP
constexpr int no_environment = -1;

/// The upvalue of an inner function that is this function's table of globals.
int environment_within(const lua::Prototype& inner, int environment) {
    int found = no_environment;
    for (std::size_t i = 0; i < inner.variables.size(); ++i) {
        const std::string_view about = inner.variables[i];
        if (about[0] == 0 && static_cast<std::uint8_t>(about[1]) == environment) found = static_cast<int>(i);
    }
    return found;
}

void note_names(const lua::Prototype& function, int environment, CodeFacts& facts) {
    if (environment == no_environment) return;
    constexpr std::size_t most_indexed = 255;  // names of later constants are passed in a register
    const auto& texts = function.constants;
    bool hidden = texts.size() > most_indexed;
    for (std::size_t at = 0; at < function.size(); ++at) {
        const std::uint32_t instruction = function.instruction(at), operation = instruction & 0x7fU;
        const std::uint32_t a = instruction >> 7U & 0xffU, b = instruction >> 16U & 0xffU, c = instruction >> 24U;
        const auto own = static_cast<std::uint32_t>(environment);
        if (operation == get_global && b == own && c < texts.size()) facts.globals.emplace_back(texts[c].text);
        if (operation == set_global && a == own && b < texts.size()) facts.globals.emplace_back(texts[b].text);
        hidden = hidden || (operation == get_upvalue && b == own) ||
                 (operation == get_global && b == own && c < texts.size() && texts[c].text == "_G");
    }
    if (!hidden) return;
    for (const auto& constant : texts) facts.perhaps.emplace_back(constant.text);
}

void add_facts(const lua::Prototype& function, int environment, CodeFacts& facts) {
    const auto digest = [&facts](std::string_view bytes) { facts.digest = digest_of(bytes, facts.digest); };
    digest(function.frame);
    digest(function.code);
    for (const auto& constant : function.constants) {
        digest({reinterpret_cast<const char*>(&constant.type), 1});
        digest(constant.number);
        const bool is_text = constant.type == lua::Prototype::short_text || constant.type == lua::Prototype::long_text;
        if (is_text) digest(constant.text), digest({"\0", 1});
    }
    for (const std::string_view variable : function.variables) digest(variable);
    note_names(function, environment, facts);
    for (const lua::Prototype& inner : function.inner) add_facts(inner, environment_within(inner, environment), facts);
}

}  // namespace

std::optional<CodeFacts> facts_of_code(std::string_view dumped, int environment) {
    const auto function = lua::prototype_in(dumped);
    if (!function) return std::nullopt;
    CodeFacts facts;
    facts.digest = digest_start;
    add_facts(*function, environment, facts);
    return facts;
}

std::uint64_t digest_of(std::string_view bytes, std::uint64_t before) {
    constexpr std::uint64_t prime = 0x100000001b3U;
    for (const char c : bytes) before = (before ^ static_cast<std::uint8_t>(c)) * prime;
    return before;
}

}  // namespace dinal::source
