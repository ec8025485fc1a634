#include "api/sweep_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

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
        std::vector<std::string_view> options;
        for (const text::Option& option : call.options) options.emplace_back(option.name);
        lua::raise(L, {.sentence = fmt::format("{} has no option '{}' among {}, and a parameter must be a vector or a "
                                               "table of values, got {}",
                                               call.name, name, fmt::join(options, ", "), lua::describe(L, -1)),
                       .call = call.name,
                       .option = name,
                       .culprit = name,
                       .cure = text::did_you_mean(name, options)});
    }
    std::vector<double> numbers = lua::numbers_at(L, -1, call.name, name);
    if (numbers.empty()) {
        fail_sweep(L, call,
                   {.sentence = fmt::format("{} has no values: there is no point to ask", name), .option = name});
    }
    return column_of(name, std::move(numbers));
}

/// { "r", v } on the top of the stack, the place-th of them.
DataColumn listed_parameter(lua_State* L, const text::Call& call, lua_Integer place) {
    if (!lua_istable(L, -1) || lua_rawgeti(L, -1, 1) != LUA_TSTRING) {
        fail_sweep(L, call,
                   {fmt::format("item {} must be a name and its values, {{ \"r\", v }}; or name them, r = v", place)});
    }
    const std::string name(lua::text_at(L, -1));
    lua_pop(L, 1);
    lua_rawgeti(L, -1, 2);
    DataColumn parameter = parameter_on_top(L, call, name);
    lua_pop(L, 1);
    return parameter;
}

}  // namespace

std::vector<DataColumn> take_parameters(lua_State* L, const text::Call& call) {
    if (lua_gettop(L) != 1 || !lua_istable(L, 1)) {
        lua::raise(L, {.sentence = fmt::format("{} takes one table, for example {}", call.name, call.example),
                       .call = call.name});
    }
    std::vector<DataColumn> parameters;
    const auto listed = static_cast<lua_Integer>(lua_rawlen(L, 1));
    for (lua_Integer i = 1; i <= listed; ++i) {
        lua_rawgeti(L, 1, i);
        parameters.push_back(listed_parameter(L, call, i));
        lua_pop(L, 1);
    }
    std::set<std::string> names;
    lua_newtable(L);
    lua_pushnil(L);
    while (lua_next(L, 1) != 0) {
        const bool named = lua_type(L, -2) == LUA_TSTRING;
        if (named && is_option(call, lua_tostring(L, -2))) {
            lua_pushvalue(L, -2);
            lua_insert(L, -2);
            lua_rawset(L, 2);
            continue;
        }
        if (named) names.emplace(lua::text_at(L, -2));
        lua_pop(L, 1);
    }
    for (const std::string& name : names) {  // lua_next has no order
        lua::push_text(L, name);
        lua_rawget(L, 1);
        parameters.push_back(parameter_on_top(L, call, name));
        lua_pop(L, 1);
    }
    lua_remove(L, 1);
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

int push_run_function(lua_State* L, const lua::Options& options) {
    options.push("run");
    if (lua_isnil(L, -1)) options.missing("run");
    if (!lua::is_callable(L, -1)) options.wrong("run", options.row("run").wanted);
    return lua_gettop(L);
}

}  // namespace dinal::api
