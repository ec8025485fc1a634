#include "lua/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lua/vector.hpp"

namespace dinal::lua {

namespace {

/// "a, b and c", or with `quote` "'a', 'b' or 'c'".
std::string joined(std::span<const std::string_view> names, std::string_view last_separator,
                   std::string_view quote = "") {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        text += i == 0 ? "" : i + 1 == names.size() ? last_separator : ", ";
        text.append(quote).append(names[i]).append(quote);
    }
    return text;
}

}  // namespace

Options::Options(lua_State* L, int index, std::string_view call, std::string_view example,
                 std::initializer_list<std::string_view> names, bool may_be_absent)
    : L_(L), index_(index), call_(call), example_(example) {
    if (may_be_absent && lua_isnoneornil(L, index)) {
        lua_settop(L, index - 1);
        lua_newtable(L);
    }
    if (lua_type(L, index) != LUA_TTABLE || lua_gettop(L) > index) {
        raise(L, {.sentence = fmt::format("{} takes one table of named options, for example {}", call, example),
                  .call = std::string(call)});
    }
    const std::vector<std::string_view> known(names);
    lua_pushnil(L);
    while (lua_next(L, index) != 0) {
        if (lua_type(L, -2) != LUA_TSTRING) {
            raise(L, {.sentence = fmt::format("{} takes named options only, for example {}", call, example),
                      .call = std::string(call),
                      .culprit = written(L, -1)});
        }
        const std::string_view name = lua_tostring(L, -2);
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            raise(L, {.sentence = fmt::format("{} has no option '{}' among {}", call, name, joined(known, " and ")),
                      .call = std::string(call),
                      .culprit = std::string(name),
                      .cure = text::did_you_mean(name, known)});
        }
        lua_pop(L, 1);
    }
}

void Options::push(std::string_view name) const {
    lua_pushlstring(L_, name.data(), name.size());
    lua_rawget(L_, index_);  // raw: a metatable must not hide from the check of names
}

bool Options::has(std::string_view name) const {
    push(name);
    const bool there = !lua_isnil(L_, -1);
    lua_pop(L_, 1);
    return there;
}

double Options::checked_number(std::string_view name, bool infinite_too) const {
    push(name);
    if (lua_isnil(L_, -1)) {
        missing(name);
    }
    const double number = lua_tonumber(L_, -1);
    if (lua_type(L_, -1) != LUA_TNUMBER || std::isnan(number) || (!infinite_too && std::isinf(number))) {
        wrong(name, infinite_too ? "a number" : "a finite number");
    }
    lua_pop(L_, 1);
    return number;
}

double Options::number(std::string_view name) const {
    return checked_number(name, false);
}

double Options::number(std::string_view name, double otherwise) const {
    return has(name) ? checked_number(name, false) : otherwise;
}

std::optional<double> Options::optional_number(std::string_view name) const {
    return has(name) ? std::optional(checked_number(name, false)) : std::nullopt;
}

double Options::extended_number(std::string_view name, double otherwise) const {
    return has(name) ? checked_number(name, true) : otherwise;
}

bool Options::boolean(std::string_view name, bool otherwise) const {
    push(name);
    if (!lua_isnil(L_, -1) && !lua_isboolean(L_, -1)) {
        wrong(name, "true or false");
    }
    const bool value = lua_isnil(L_, -1) ? otherwise : lua_toboolean(L_, -1) != 0;
    lua_pop(L_, 1);
    return value;
}

std::string Options::text(std::string_view name) const {
    push(name);
    if (lua_isnil(L_, -1)) {
        missing(name);
    }
    if (lua_type(L_, -1) != LUA_TSTRING) {
        wrong(name, "a string");
    }
    std::size_t length = 0;
    const char* start = lua_tolstring(L_, -1, &length);
    std::string value(start, length);
    lua_pop(L_, 1);
    return value;
}

std::size_t Options::choice(std::string_view name, std::initializer_list<std::string_view> choices,
                            std::size_t otherwise) const {
    if (!has(name)) {
        return otherwise;
    }
    const std::vector<std::string_view> known(choices);
    push(name);
    const bool is_text = lua_type(L_, -1) == LUA_TSTRING;
    const std::string value = is_text ? lua_tostring(L_, -1) : "";
    const auto found = std::find(known.begin(), known.end(), value);
    if (!is_text || found == known.end()) {
        fail({.sentence = fmt::format("{} must be {}, got {}", name, joined(known, " or ", "'"), describe(L_, -1)),
              .option = std::string(name),
              .culprit = written(L_, -1),
              .cure = is_text ? text::did_you_mean(value, known) : ""});
    }
    lua_pop(L_, 1);
    return static_cast<std::size_t>(found - known.begin());
}

std::vector<double> Options::numbers(std::string_view name) const {
    std::vector<double> values;
    push(name);
    if (!lua_isnil(L_, -1)) {
        values = numbers_at(L_, -1, call_, name);
    }
    lua_pop(L_, 1);
    return values;
}

void Options::fail(text::Error error) const {
    raise(L_, text::in_call(call_, std::move(error)));
}

void Options::fail(std::string_view sentence) const {
    fail(text::Error{std::string(sentence)});
}

void Options::wrong(std::string_view name, std::string_view wanted) const {
    push(name);
    fail({.sentence = fmt::format("{} must be {}, got {}", name, wanted, describe(L_, -1)),
          .option = std::string(name),
          .culprit = written(L_, -1)});
}

void Options::missing(std::string_view name) const {
    raise(L_, {.sentence = fmt::format("{} needs {}, for example {}", call_, name, example_),
               .call = std::string(call_),
               .option = std::string(name),
               .culprit = "nil"});
}

}  // namespace dinal::lua
