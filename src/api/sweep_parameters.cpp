#include "api/sweep_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "api/sweep_options.hpp"
#include "lua/lua_text.hpp"
#include "lua/user_function.hpp"

namespace dinal::api {
namespace {

[[noreturn]] void fail_sweep(lua_State* L, const text::Call& call, text::Error error) {
    lua::raise(L, text::in_call(call.name, std::move(error)));
}

bool is_option(const text::Call& call, std::string_view name) {
    return std::any_of(call.options.begin(), call.options.end(),
                       [name](const text::Option& option) { return option.name == name; });
}

/// The values on the top of the stack.
DataColumn parameter_on_top(lua_State* L, const text::Call& call, const std::string& name) {
    bool of_words = false;
    if (lua_istable(L, -1)) {
        of_words = lua_rawgeti(L, -1, 1) == LUA_TSTRING;
        lua_pop(L, 1);
    }
    if (of_words) {
        std::vector<std::string> words;
        for (std::size_t i = 1; i <= lua_rawlen(L, -1); ++i) {
            if (lua_rawgeti(L, -1, static_cast<lua_Integer>(i)) != LUA_TSTRING) {
                fail_sweep(L, call,
                           {.sentence = fmt::format("{}[{}] must be a string as those before, got {}", name, i,
                                                    lua::describe(L, -1)),
                            .option = name,
                            .culprit = lua::written(L, -1)});
            }
            words.emplace_back(lua::text_at(L, -1));
            lua_pop(L, 1);
        }
        if (const std::string key = lua::key_beside_list(L, -1); !key.empty()) {
            fail_sweep(
                L, call,
                {.sentence = fmt::format("{} must be a list such as {{ \"a\", \"b\" }}, but it has {}", name, key),
                 .option = name});
        }
        return column_of(name, std::move(words));
    }
    if (!lua_istable(L, -1) && lua::test<lua::Vector>(L, -1) == nullptr) {
        fail_sweep(L, call,
                   {.sentence = fmt::format("over.{} must be a vector or a table of values, got {}", name,
                                            lua::describe(L, -1)),
                    .option = "over",
                    .culprit = name});
    }
    std::vector<double> numbers = lua::numbers_at(L, -1, call.name, name);
    if (numbers.empty()) {
        fail_sweep(L, call, {.sentence = fmt::format("{} has no values", name), .option = name});
    }
    return column_of(name, std::move(numbers));
}

/// { "r", v } on the top of the stack, the place-th of them.
DataColumn listed_parameter(lua_State* L, const text::Call& call, lua_Integer place) {
    if (!lua_istable(L, -1) || lua_rawgeti(L, -1, 1) != LUA_TSTRING) {
        fail_sweep(L, call,
                   {fmt::format("over[{}] must be a name and its values, {{ \"r\", v }}; or name them, r = v", place)});
    }
    const std::string name(lua::text_at(L, -1));
    lua_pop(L, 1);
    lua_rawgeti(L, -1, 2);
    DataColumn parameter = parameter_on_top(L, call, name);
    lua_pop(L, 1);
    return parameter;
}

/// Names the new form of a call that has its parameters among its options.
void refuse_old_form(lua_State* L, const text::Call& call) {
    for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1)) {
        const bool named = lua_type(L, -2) == LUA_TSTRING;
        const bool values = lua_istable(L, -1) || lua::test<lua::Vector>(L, -1) != nullptr;
        if (!values || (named && is_option(call, lua_tostring(L, -2)))) continue;
        const std::string name = named ? lua_tostring(L, -2) : "NAME";
        fail_sweep(L, call,
                   {.sentence = fmt::format("parameters and their values stand in over = {{ {} = values }}", name),
                    .option = "over"});
    }
}

}  // namespace

std::vector<DataColumn> take_parameters(lua_State* L, const text::Call& call) {
    if (lua_gettop(L) != 1 || !lua_istable(L, 1)) {
        lua::raise(L, {.sentence = fmt::format("{} takes one table, for example {}", call.name, call.example),
                       .call = call.name});
    }
    refuse_old_form(L, call);
    lua_getfield(L, 1, "over");
    if (!lua_isnoneornil(L, -1) && !lua_istable(L, -1)) {
        fail_sweep(L, call,
                   {.sentence = fmt::format("over must be {}, got {}", over_option[0].wanted, lua::describe(L, -1)),
                    .option = "over",
                    .culprit = lua::written(L, -1)});
    }
    std::vector<DataColumn> parameters;
    if (lua_istable(L, -1)) parameters = parameters_in(L, lua_gettop(L), call);
    lua_pop(L, 1);
    return parameters;
}

std::vector<DataColumn> parameters_in(lua_State* L, int table, const text::Call& call) {
    std::vector<DataColumn> parameters;
    const auto listed = static_cast<lua_Integer>(lua_rawlen(L, table));
    for (lua_Integer i = 1; i <= listed; ++i) {
        lua_rawgeti(L, table, i);
        parameters.push_back(listed_parameter(L, call, i));
        lua_pop(L, 1);
    }
    std::set<std::string> names;
    for (lua_pushnil(L); lua_next(L, table) != 0; lua_pop(L, 1)) {
        if (lua_type(L, -2) == LUA_TSTRING) names.emplace(lua::text_at(L, -2));
    }
    for (const std::string& name : names) {  // lua_next has no order
        lua::push_text(L, name);
        lua_rawget(L, table);
        parameters.push_back(parameter_on_top(L, call, name));
        lua_pop(L, 1);
    }
    return parameters;
}

void check_parameters(lua_State* L, const text::Call& call, const std::vector<DataColumn>& parameters) {
    if (parameters.empty()) {
        fail_sweep(L, call, {fmt::format("there is no parameter; for example {}", call.example)});
    }
    double points = 1;
    std::set<std::string> names;
    for (const DataColumn& parameter : parameters) {
        if (!names.insert(parameter.name).second || parameter.name == "error") {
            fail_sweep(L, call,
                       {.sentence = parameter.name == "error"
                                        ? "'error' is the column of messages: give the parameter another name"
                                        : fmt::format("there are two parameters '{}'", parameter.name),
                        .option = parameter.name});
        }
        points *= static_cast<double>(parameter.size());
    }
    constexpr double most = 1e9;
    if (points > most) {
        fail_sweep(L, call,
                   {fmt::format("{:.3g} points are more than the {:.0e} that one sweep can hold", points, most)});
    }
}

int push_function(lua_State* L, const lua::Options& options, const char* name) {
    options.push(name);
    if (lua_isnil(L, -1)) options.missing(name);
    if (!lua::is_callable(L, -1)) options.wrong(name, options.row(name).wanted);
    return lua_gettop(L);
}

}  // namespace dinal::api
