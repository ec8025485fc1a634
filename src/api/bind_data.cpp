// data{ ... }, load(file), and the class of what they return: columns, rows by number, methods of
// data_methods.cpp.
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/data_docs.hpp"
#include "lua/values.hpp"
#include "terminal/display.hpp"
#include "text/characters.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dinal::api {
namespace {

int data_row_text(lua_State* L) {
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_getmetatable(L, 1);
    lua_getfield(L, -1, "names");
    std::string text = "{";
    for (lua_Integer i = 1; i <= static_cast<lua_Integer>(lua_rawlen(L, 3)); ++i) {
        lua_rawgeti(L, 3, i);
        const std::string name = text::displayable(lua_tostring(L, -1));
        lua_rawget(L, 1);
        text += (i == 1 ? " " : ", ") + name + " = ";
        text += lua_type(L, -1) == LUA_TSTRING   ? text::quoted(lua_tostring(L, -1))
                : lua_type(L, -1) == LUA_TNUMBER ? fmt::format("{:.6g}", lua_tonumber(L, -1))
                                                 : lua::describe(L, -1);
        lua_pop(L, 1);
    }
    return lua::push_text(L, text + " }");
}

std::vector<std::string_view> names_of(const Data& data) {
    std::vector<std::string_view> names;
    for (const DataColumn& column : data.columns) names.emplace_back(column.name);
    return names;
}

/// The metatable of the rows of the data at `index`, kept with it: it knows the order of the names.
void push_row_metatable(lua_State* L, int index, const Data& data) {
    if (lua_getiuservalue(L, index, 1) == LUA_TTABLE) return;
    lua_pop(L, 1);
    lua_createtable(L, 0, 3);
    lua_pushcfunction(L, lua::guarded<data_row_text>);
    lua_setfield(L, -2, "__tostring");
    lua_pushliteral(L, "row");
    lua_setfield(L, -2, "__name");
    lua::set_value(L, "names", names_of(data));
    lua_pushvalue(L, -1);
    lua_setiuservalue(L, index, 1);
}

int push_column(lua_State* L, const DataColumn& column) {
    if (const lua::Vector* numbers = column.numbers()) {
        lua::push(L, *numbers);
    } else {
        lua::push_value(L, *std::get<Words>(column.values));
    }
    return 1;
}

int data_other_key(lua_State* L) {
    const DataHandle& data = data_functions::self(L, "d.r");
    if (lua_type(L, 2) == LUA_TSTRING) {
        if (const DataCompanion* companion = data->companion(lua_tostring(L, 2))) {
            push_data(L, companion->made());
            return 1;
        }
        return push_column(L, data_functions::column_or_fail(L, *data, "", lua_tostring(L, 2)));
    }
    if (lua_isboolean(L, 2)) {  // d[d.theta > 0]
        lua::raise(L, {.sentence = "a comparison in brackets selects elements of vectors, as in d.x[d.x > 0]; rows are "
                                   "selected by d:filter(function(row) return row.x > 0 end)"});
    }
    int is_integer = 0;
    const lua_Integer i = lua_tointegerx(L, 2, &is_integer);
    if (lua_type(L, 2) != LUA_TNUMBER) return 0;
    if (is_integer != 0 && i < 0) {
        lua::raise(L, {.sentence = fmt::format("d[{}]: rows are counted from 1; the last one is d[#d]", i)});
    }
    if (is_integer == 0 || i < 1 || i > static_cast<lua_Integer>(data->size())) {
        lua_pushnil(L);
        return 1;
    }
    push_row(L, 1, *data, static_cast<std::size_t>(i - 1));
    return 1;
}

int data_length(lua_State* L) {
    lua_pushinteger(L, static_cast<lua_Integer>(data_functions::self(L, "#d")->size()));
    return 1;
}

int data_next_row(lua_State* L) {
    const lua_Integer i = luaL_checkinteger(L, 2) + 1;
    lua_pushinteger(L, i);
    return lua_geti(L, 1, i) == LUA_TNIL ? 1 : 2;
}

int data_pairs(lua_State* L) {
    lua_pushcfunction(L, lua::guarded<data_next_row>);
    lua_pushvalue(L, 1);
    lua_pushinteger(L, 0);
    return 3;
}

int data_to_string(lua_State* L) {
    return lua::push_text(L, text_of(*data_functions::self(L, "tostring(d)"), text::readable_width));
}

std::string data_card(lua_State* L, int index, const terminal::Display& screen) {
    return terminal::spelled(text_of(**lua::test<DataHandle>(L, index), screen.width), screen);
}

// ---- data{ ... }

[[noreturn]] void fail_data(lua_State* L, text::Error error) {
    lua::raise(L, text::in_call("data", std::move(error)));
}

/// The column whose values are on the top of the stack.
DataColumn column_on_top(lua_State* L, const std::string& name) {
    if (const auto* vector = lua::test<lua::Vector>(L, -1)) return {name, *vector};
    if (!lua_istable(L, -1)) {
        fail_data(L, {.sentence = fmt::format("{} must be a vector, or a table of numbers or of strings, got {}", name,
                                              lua::describe(L, -1)),
                      .option = name,
                      .culprit = lua::written(L, -1)});
    }
    const std::size_t n = lua_rawlen(L, -1);
    std::vector<std::string> words;
    std::vector<double> numbers;
    for (std::size_t i = 1; i <= n; ++i) {
        const int type = lua_rawgeti(L, -1, static_cast<lua_Integer>(i));
        if (type == LUA_TSTRING && numbers.empty()) {
            words.emplace_back(lua_tostring(L, -1));
        } else if (type == LUA_TNUMBER && words.empty()) {
            numbers.push_back(lua_tonumber(L, -1));
        } else {
            fail_data(
                L, {.sentence = fmt::format("{}[{}] must be a {}, got {}", name, i,
                                            words.empty() ? "number" : "string as those before", lua::describe(L, -1)),
                    .option = name,
                    .culprit = lua::written(L, -1)});
        }
        lua_pop(L, 1);
    }
    if (const std::string key = lua::key_beside_list(L, -1); !key.empty()) {
        fail_data(L, {.sentence = fmt::format("{} must be a list such as {{ 1, 2, 3 }}, but it has {}", name, key),
                      .option = name});
    }
    return words.empty() ? column_of(name, std::move(numbers)) : column_of(name, std::move(words));
}

/// { "r", v } at the top of the stack.
DataColumn listed_column(lua_State* L, lua_Integer place) {
    const bool pair = lua_istable(L, -1) && lua_rawgeti(L, -1, 1) == LUA_TSTRING;
    if (!pair) {
        fail_data(L, {fmt::format("item {} must be a name and its column, {{ \"r\", v }}; or name it, r = v", place)});
    }
    const std::string name = lua_tostring(L, -1);
    lua_rawgeti(L, -2, 2);
    DataColumn column = column_on_top(L, name);
    lua_pop(L, 2);
    return column;
}

void check_columns(lua_State* L, const Data& data) {
    if (data.columns.empty()) {
        fail_data(L, {"there is no column; for example data{ r = { 0.5, 1 }, A = { 1.3, 4 } }"});
    }
    for (const DataColumn& column : data.columns) {
        const DataColumn& first = data.columns.front();
        if (column.size() != first.size()) {
            fail_data(L, {.sentence = fmt::format("columns must be equally long, but {} has {} and {} has {}",
                                                  first.name, first.size(), column.name, column.size()),
                          .option = column.name});
        }
        if (data.find(column.name) != &column) {
            fail_data(L, {.sentence = fmt::format("there are two columns '{}'", column.name), .option = column.name});
        }
    }
}

int data_make(lua_State* L) {
    if (lua_gettop(L) != 2 || !lua_istable(L, 2)) {
        lua::raise(L,
                   {.sentence = "data takes one table of columns, for example data{ r = { 0.5, 1 }, A = { 1.3, 4 } }",
                    .call = "data"});
    }
    Data data;
    const auto listed = static_cast<lua_Integer>(lua_rawlen(L, 2));
    for (lua_Integer i = 1; i <= listed; ++i) {
        lua_rawgeti(L, 2, i);
        data.columns.push_back(listed_column(L, i));
        lua_pop(L, 1);
    }
    const auto first_named = static_cast<std::ptrdiff_t>(data.columns.size());
    lua_pushnil(L);
    while (lua_next(L, 2) != 0) {
        if (lua_type(L, -2) == LUA_TSTRING) {
            data.columns.push_back(column_on_top(L, lua_tostring(L, -2)));
        }
        lua_pop(L, 1);
    }
    // A Lua table does not know in which order it was written.
    std::sort(data.columns.begin() + first_named, data.columns.end(),
              [](const DataColumn& a, const DataColumn& b) { return a.name < b.name; });
    check_columns(L, data);
    push_data(L, std::move(data));
    return 1;
}

constexpr lua::Member data_members[] = {
    {lua::a_method<data_functions::column>, column_doc},
    {lua::a_method<data_functions::filter>, filter_doc},
    {lua::a_method<data_functions::markdown>, markdown_doc},
    {lua::a_method<data_functions::plot>, plot_data_doc},
    {lua::a_method<data_functions::save>, save_data_doc},
    {lua::a_method<data_functions::select>, select_doc},
    {lua::a_method<data_functions::sort>, sort_doc},
    {lua::a_value<DataHandle, names_of>, names_doc},
    {lua::a_metamethod<data_length>("__len"), length_doc},
    {lua::a_metamethod<data_pairs>("__pairs"), pairs_doc},
    {lua::a_metamethod<data_to_string>("__tostring"), to_string_doc},
};

constexpr lua::Member data_module_members[] = {
    {lua::a_metamethod<data_make>("__call"), make_doc},
    {lua::a_function<data_functions::load>, load_doc},
};

}  // namespace

int data_functions::column(lua_State* L) {
    const DataHandle& data = self(L, "d:column(\"r\")");
    if (lua_type(L, 2) != LUA_TSTRING) {
        lua::raise_got(L, 2, "d:column", "d:column takes the name of a column");
    }
    return push_column(L, column_or_fail(L, *data, "d:column", lua_tostring(L, 2)));
}

void push_row(lua_State* L, int index, const Data& data, std::size_t row) {
    lua_createtable(L, 0, static_cast<int>(data.columns.size()));
    for (const DataColumn& each : data.columns) {
        lua::push_text(L, each.name);
        if (const lua::Vector* numbers = each.numbers()) {
            lua_pushnumber(L, numbers->begin()[row]);
        } else {
            lua::push_text(L, (*std::get<Words>(each.values))[row]);
        }
        lua_rawset(L, -3);
    }
    push_row_metatable(L, index, data);
    lua_setmetatable(L, -2);
}

const lua::Class data_class = {
    "data",
    {"data{ ... }, load(file), run.events -> d",
     "Named columns of one length: d.r is a vector (of words a table of strings), d[1] the "
     "first row. It cannot be changed.",
     "d = data{ r = { 0.5, 1 }, A = { 1.3, 4 } }\nprint(d.r, d[2].A)  --> vector{ 0.5, 1 }\t4.0"},
    data_members,
    lua::guarded<data_other_key>,
    data_card};

const lua::Class data_module = {"data",
                                {"data{ ... } -> d", "Makes tables of named columns, and reads them from files.",
                                 "print(#data{ r = { 0.5, 1 } })  --> 2"},
                                data_module_members};

void register_data(lua_State* L) {
    lua::add_class<DataHandle>(L, data_class);
    lua::add_module(L, data_module);
}

}  // namespace dinal::api
