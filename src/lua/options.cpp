#include "lua/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "lua/lua_text.hpp"
#include "lua/vector.hpp"
#include "text/words.hpp"

namespace dinal::lua {

namespace {

using Names = std::vector<std::string_view>;

/// "a, b and c", or with `quote` "'a', 'b' or 'c'".
std::string joined(const Names& names, std::string_view last_separator, std::string_view quote = "") {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        text += i == 0 ? "" : i + 1 == names.size() ? last_separator : ", ";
        text.append(quote).append(names[i]).append(quote);
    }
    return text;
}

/// "; did you mean 'theta0' for 'theta' and 't_end' for 'tend'?", for names that resemble known ones.
std::string cures(const Names& unknown, const Names& known) {
    std::vector<std::string> words;
    for (const std::string_view name : unknown) {
        const std::vector<std::string> best = text::suggestions(name, known);
        if (!best.empty()) words.push_back(fmt::format("'{}' for '{}'", best.front(), name));
    }
    return words.empty() ? "" : fmt::format("; did you mean {}?", fmt::join(words, " and "));
}

/// Removes options of the neighbouring call from `unknown`, and says where they belong.
std::string options_of_neighbour(Names& unknown, const text::Call* neighbour) {
    if (neighbour == nullptr) return "";
    const auto has = [&](std::string_view name) {
        return text::contains(neighbour->options, name, &text::Option::name);
    };
    const auto theirs = std::stable_partition(unknown.begin(), unknown.end(), [&](auto name) { return !has(name); });
    const Names moved(theirs, unknown.end());
    unknown.erase(theirs, unknown.end());
    if (moved.empty()) return "";
    return fmt::format("; {} {} of {}", joined(moved, " and ", "'"), moved.size() > 1 ? "are options" : "is an option",
                       neighbour->name);
}

}  // namespace

Options::Options(lua_State* L, int index, const text::Call& call) : L_(L), index_(index), call_(call) {
    check_table();
}

std::size_t Options::place(std::string_view name) const {
    for (std::size_t i = 0; i < call_.options.size(); ++i) {
        const char* own = call_.options[i].name;  // the first letter rules out most, which saves strlen
        if (!name.empty() && *own == name.front() && name == own) return i;
    }
    return most_options;
}

void Options::check_table() {
    assert(call_.options.size() <= most_options);
    if (call_.may_be_bare && lua_isnoneornil(L_, index_)) {
        lua_settop(L_, index_ - 1);
        lua_newtable(L_);
    }
    if (*call_.bare_value != '\0' && (lua_type(L_, index_) == LUA_TNUMBER || lua_type(L_, index_) == LUA_TSTRING)) {
        lua_createtable(L_, 0, 1);
        lua_pushvalue(L_, index_);
        lua_setfield(L_, -2, call_.bare_value);
        lua_replace(L_, index_);
    }
    if (lua_type(L_, index_) != LUA_TTABLE || lua_gettop(L_) > index_) {
        raise(L_, {.sentence =
                       fmt::format("{} takes one table of named options, for example {}", call_.name, call_.example),
                   .call = call_.name});
    }
    Names unknown;
    lua_pushnil(L_);
    while (lua_next(L_, index_) != 0) {
        if (lua_type(L_, -2) != LUA_TSTRING) {
            raise(L_,
                  {.sentence = fmt::format("{} takes named options only, for example {}", call_.name, call_.example),
                   .call = call_.name,
                   .culprit = written(L_, -1)});
        }
        const std::string_view name = text_at(L_, -2);
        const std::size_t row = place(name);
        if (row == most_options) {
            unknown.push_back(name);
        } else {
            given_.set(row);
        }
        lua_pop(L_, 1);
    }
    if (!unknown.empty()) refuse(unknown);
    if (look_at_options != nullptr) look_at_options(L_);
}

void Options::refuse(std::vector<std::string_view>& unknown) const {
    std::ranges::sort(unknown);  // tables are unordered; the message must always be the same
    Names known;
    for (const text::Option& option : call_.options) known.emplace_back(option.name);
    const std::string names = joined(unknown, " and ", "'"), first(unknown.front());
    const bool several = unknown.size() > 1;
    const std::string elsewhere = options_of_neighbour(unknown, call_.neighbour);
    raise(L_, {.sentence = known.empty() ? fmt::format("{} has no options, so no {} either", call_.name, names)
                                         : fmt::format("{} has no option{} {} among {}", call_.name, several ? "s" : "",
                                                       names, joined(known, " and ")),
               .call = call_.name,
               .culprit = first,
               .cure = elsewhere + (several           ? cures(unknown, known)
                                    : unknown.empty() ? ""
                                                      : text::did_you_mean(first, known))});
}

void Options::push(std::string_view name) const {
    push_field(L_, index_, name);  // raw: a metatable must not hide options from the check of names
}

const text::Option& Options::row(std::string_view name) const {
    return call_.options[place(name)];
}

void Options::fill(const void* owner, void* object) const {
    for (std::size_t i = 0; i < call_.options.size(); ++i) {
        const text::Option& option = call_.options[i];
        if (option.filled.owner != owner) {
            continue;
        }
        const bool has_others = i + 1 < call_.options.size() && call_.options[i + 1].instead_of_previous;
        if (has_others && !option.instead_of_previous) {
            check_alternatives(i);
        }
        if (given_[i]) {
            option.filled.set(object, value(option));
        } else if (option.otherwise == text::needed && !has_others && !option.instead_of_previous) {
            missing(option.name);
        }
    }
}

void Options::check_alternatives(std::size_t row) const {
    Names all, given;
    for (std::size_t i = row; i == row || (i < call_.options.size() && call_.options[i].instead_of_previous); ++i) {
        all.emplace_back(call_.options[i].name);
        if (given_[i]) given.push_back(all.back());
    }
    if (given.size() > 1) {
        fail(given[1], fmt::format("{} exclude each other; give one of them", joined(given, " and ")));
    }
    if (call_.options[row].otherwise == text::needed && given.empty()) {
        fail(all.front(), fmt::format("{} is needed, for example {}", joined(all, " or "), call_.example));
    }
}

text::OptionValue Options::value(const text::Option& option) const {
    push(option.name);
    text::OptionValue value;
    switch (option.filled.kind) {
        case text::OptionKind::other:
            break;
        case text::OptionKind::number:
            value = number_on_top(option);
            break;
        case text::OptionKind::flag:
            if (!lua_isboolean(L_, -1)) {
                wrong(option.name, "true or false");
            }
            value = lua_toboolean(L_, -1) != 0;
            break;
        case text::OptionKind::choice:
            value = choice_on_top(option);
            break;
        case text::OptionKind::text:
            if (lua_type(L_, -1) != LUA_TSTRING) {
                wrong(option.name, "a string");
            }
            value = std::string(text_at(L_, -1));
            break;
        case text::OptionKind::numbers:
            value = numbers_at(L_, -1, call_.name, option.name);
            break;
    }
    if (auto wrong = text::complaint(option, value)) {
        wrong->culprit = written(L_, -1);
        fail(*wrong);
    }
    lua_pop(L_, 1);
    return value;
}

double Options::number_on_top(const text::Option& option) const {
    const double number = lua_tonumber(L_, -1);
    const bool infinite = option.range.unlimited;
    if (lua_type(L_, -1) != LUA_TNUMBER || std::isnan(number) || (!infinite && std::isinf(number))) {
        wrong(option.name, infinite ? "a number" : "a finite number");
    }
    return number + 0.0;  // no -0: -0.0 * a user's factor means 0, and 1/k must not be -inf
}

std::size_t Options::choice_on_top(const text::Option& option) const {
    const Names known(option.choices.begin(), option.choices.end());
    const bool is_text = lua_type(L_, -1) == LUA_TSTRING;
    const std::string value = is_text ? lua_tostring(L_, -1) : "";
    const auto found = std::ranges::find(known, value);
    if (!is_text || found == known.end()) {
        fail({.sentence =
                  fmt::format("{} must be {}, got {}", option.name, joined(known, " or ", "'"), describe(L_, -1)),
              .option = option.name,
              .culprit = written(L_, -1),
              .cure = is_text ? text::did_you_mean(value, known) : ""});
    }
    return static_cast<std::size_t>(found - known.begin());
}

double Options::number(std::string_view name) const {
    if (!has(name)) {
        missing(name);
    }
    text::Option option = row(name);
    option.filled.kind = text::OptionKind::number;
    return std::get<double>(value(option));
}

std::vector<double> Options::numbers(std::string_view name) const {
    if (!has(name)) {
        return {};
    }
    text::Option option = row(name);
    option.filled.kind = text::OptionKind::numbers;
    option.range = text::any_finite;
    return std::get<std::vector<double>>(value(option));
}

void Options::fail(text::Error error) const {
    raise(L_, text::in_call(call_.name, std::move(error)));
}

void Options::fail(std::string_view option, std::string sentence) const {
    push(option);
    fail({.sentence = std::move(sentence), .option = std::string(option), .culprit = written(L_, -1)});
}

void Options::wrong(std::string_view name, std::string_view wanted) const {
    push(name);
    fail(name, fmt::format("{} must be {}, got {}", name, wanted, describe(L_, -1)));
}

void Options::missing(std::string_view name) const {
    raise(L_, {.sentence = fmt::format("{} needs {}, for example {}", call_.name, name, call_.example),
               .call = call_.name,
               .option = std::string(name),
               .culprit = "nil"});
}

}  // namespace dinal::lua
