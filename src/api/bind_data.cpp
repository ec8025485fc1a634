// data{ ... }, load(file), and the class of their result: columns, rows by number, and operations on them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <string>

#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/picture.hpp"
#include "files/csv.hpp"
#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "lua/options.hpp"
#include "lua/values.hpp"
#include "lua/worker_state.hpp"
#include "plots/figure.hpp"
#include "plots/run_figure.hpp"
#include "plots/shades.hpp"
#include "terminal/display.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::api {

// Documentation of data, and the options of its methods.

/// d:plot{ x, y }.
inline constexpr text::Option data_plot_options[] = {
    {.name = "x", .otherwise = "the first column", .meaning = "name of a column"},
    {.name = "y", .otherwise = "the second column", .meaning = "name of a column, or a list of them"},
    {.name = "z", .meaning = "name of a column to draw as a map over a grid of x and y"},
    {.name = "overlay",
     .meaning = "name of an additional curve, or a list: the data of a response have \"jumps\" and, if it "
                "exists, \"linearised\" and \"den_hartog\""},
    {.name = "zlim", .meaning = "{ from, to }: values beyond get the first or last shade of the map"},
    text::option<&plots::Curve::style>("style", "style of the curves; numbers that are not finite are gaps",
                                       {.choices = plots::style_names}),
};
inline constexpr auto plot_data_options = text::joined(data_plot_options, figure_options, target_options);
inline constexpr text::Call plot_data_call{"d:plot", "d:plot{ x = \"r\", y = \"A\" }", plot_data_options, true};

struct SortOptions {
    bool descending = false;
};
inline constexpr text::Option sort_options[] = {
    text::option<&SortOptions::descending>("descending", "the greatest first"),
};
inline constexpr text::Call sort_call{"d:sort", "d:sort(\"A\", { descending = true })", sort_options, true};

#define DINAL_DATA "d = data{ r = { 0.5, 1, 2 }, A = { 1.3, 4, 0.3 } }\n"

inline constexpr lua::Doc column_doc{
    "d:column(name) -> vector or table",
    "The column of this name, also where d.name is a method: a vector, or a table of strings.",
    DINAL_DATA "print(d:column(\"A\"))  --> vector{ 1.3, 4, 0.3 }"};
inline constexpr lua::Doc filter_doc{
    "d:filter(f) -> data",
    "The rows for which f(row) is true; row is a table such as { r = 0.5, A = 1.3 }. A vector with a number for "
    "each row, not 0 to keep it, works as well.",
    DINAL_DATA "print(d:filter(function(row) return row.A > 1 end).r)  --> vector{ 0.5, 1 }"};
inline constexpr lua::Doc markdown_doc{"d:markdown() -> string", "All rows as a table in Markdown.",
                                       DINAL_DATA
                                       "print(d:markdown())\n"
                                       "--> | A | r |\n"
                                       "--> |---:|---:|\n"
                                       "--> | 1.3 | 0.5 |\n"
                                       "--> | 4 | 1 |\n"
                                       "--> | 0.3 | 2 |"};
inline constexpr lua::Doc plot_data_doc{
    "d:plot{ OPTIONS }",
    "Draws columns over a column, or a map if z is given. A sweep over two parameters is drawn as the map of its "
    "first result; if y names a result, as a curve for each value of the first parameter.",
    DINAL_DATA "print(#tostring(d:plot{ x = \"r\", y = \"A\", show = false }) > 500)  --> true",
    {&plot_data_call}};
inline constexpr lua::Doc save_data_doc{
    "d:save(file)", "Writes file.csv: a line of names, then the rows; nan is an empty field. load reads it back.",
    DINAL_DATA
    "file = os.tmpname() .. \".csv\"\n"
    "d:save(file)\n"
    "print(load(file).A == d.A)  --> true\n"
    "os.remove(file)"};
inline constexpr lua::Doc select_doc{"d:select(name, ...) -> data", "These columns, in this order.",
                                     DINAL_DATA "print(table.concat(d:select(\"r\", \"A\").names, \" \"))  --> r A"};
inline constexpr lua::Doc sort_doc{"d:sort(name, { OPTIONS }) -> data",
                                   "The rows sorted by a column; equal rows keep their order, nan comes last.",
                                   DINAL_DATA "print(d:sort(\"A\").r)  --> vector{ 2, 0.5, 1 }",
                                   {&sort_call}};
inline constexpr lua::Doc names_doc{"d.names -> table",
                                    "The names of the columns, in the order in which they are printed and saved.",
                                    DINAL_DATA "print(table.concat(d.names, \" \"))  --> A r"};
inline constexpr lua::Doc units_of_columns_doc{
    "d.units -> table", "The units of the columns that have one, by their names.",
    "run = system{ I = 1, k = 4, units = { t = \"s\" } }:simulate{ theta0 = 1, t_end = 1 }\n"
    "print(run:data().units.t)  --> s"};
inline constexpr lua::Doc length_doc{
    "#d -> integer", "The number of rows. d[1] is the first one, a table with a field for each column; beyond is nil.",
    DINAL_DATA "print(#d, d[2].A)  --> 3\t4.0"};
inline constexpr lua::Doc pairs_doc{
    "for i, row in pairs(d)", "Goes through the rows; ipairs does the same.",
    DINAL_DATA "for i, row in pairs(d) do print(i, row.r) end\n--> 1\t0.5\n--> 2\t1.0\n--> 3\t2.0"};
inline constexpr lua::Doc to_string_doc{
    "tostring(d) -> string", "The number of rows, and the first rows as a table; columns that do not fit are left out.",
    DINAL_DATA
    "print(d)\n"
    "--> data: 3 rows of A, r\n"
    "-->   i    A    r\n"
    "-->   1  1.3  0.5\n"
    "-->   2    4    1\n"
    "-->   3  0.3    2"};
inline constexpr lua::Doc make_doc{
    "data{ NAME = column, ... } -> data",
    "Columns of one length: vectors, or tables of numbers or of strings. They are in the order of their names; "
    "data{ { \"r\", v }, { \"A\", w } } gives them in another one.",
    DINAL_DATA "print(d.A:max())  --> 4.0"};
#undef DINAL_DATA

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

/// The units of the columns that have one.
std::map<std::string, std::string> units_of_columns(const Data& data) {
    std::map<std::string, std::string> units;
    for (const DataColumn& column : data.columns) {
        if (!column.unit.empty()) units.emplace(column.name, column.unit);
    }
    return units;
}

/// Pushes the metatable of the rows of the data at `index`, kept with the data: it stores the order of the names.
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
    const lua::Vector* numbers = column.numbers();
    numbers != nullptr ? lua::push_value(L, *numbers) : lua::push_value(L, column.words());
    return 1;
}

int data_other_key(lua_State* L) {
    const DataHandle& data = data_functions::self(L, "d.r");
    if (lua_type(L, 2) == LUA_TSTRING) {
        if (const DataCompanion* companion = data->companion(lua_tostring(L, 2))) {
            return push_data(L, companion->made());
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
        lua::raise(L, "d[{}]: rows are counted from 1; the last one is d[#d]", i);
    }
    if (is_integer == 0 || i < 1 || i > static_cast<lua_Integer>(data->size())) {
        lua_pushnil(L);
        return 1;
    }
    push_row(L, 1, *data, static_cast<std::size_t>(i - 1));
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

std::string data_card(lua_State* L, int index, const terminal::Display& screen) {
    return terminal::spelled(text_of(**lua::test<DataHandle>(L, index), screen.width), screen);
}

// ---- data{ ... }

[[noreturn]] void fail_data(lua_State* L, text::Error error) {
    lua::fail(L, "data", std::move(error));
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
    data.columns = columns_in(
        L, 2, [L](const std::string& name) { return read_column(L, "data", name); },
        [L](lua_Integer i) {
            fail_data(L, {fmt::format("item {} must be a name and its column, {{ \"r\", v }}; or name it, r = v", i)});
        });
    check_columns(L, data);
    return push_data(L, std::move(data));
}

constexpr lua::Member data_members[] = {
    {lua::a_method<data_functions::column>, column_doc},
    {lua::a_method<data_functions::filter>, filter_doc},
    {lua::a_question<DataHandle, markdown_of>, markdown_doc},
    {lua::a_method<data_functions::plot>, plot_data_doc},
    {lua::a_method<data_functions::save>, save_data_doc},
    {lua::a_method<data_functions::select>, select_doc},
    {lua::a_method<data_functions::sort>, sort_doc},
    {lua::a_value<DataHandle, names_of>, names_doc},
    {lua::a_value<DataHandle, units_of_columns>, units_of_columns_doc},
    {lua::a_length<DataHandle, &Data::size>, length_doc},
    {lua::a_metamethod<data_pairs>("__pairs"), pairs_doc},
    {lua::a_text<DataHandle, [](const Data& data) { return text_of(data, text::readable_width); }>, to_string_doc},
};

constexpr lua::Member data_module_members[] = {
    {lua::a_metamethod<data_make>("__call"), make_doc},
};

}  // namespace

DataColumn read_column(lua_State* L, const char* call, const std::string& name) {
    if (const auto* vector = lua::test<lua::Vector>(L, -1)) return {name, *vector};
    if (!lua_istable(L, -1)) {
        lua::fail(L, call,
                  {.sentence = fmt::format("{} must be a vector, or a table of numbers or of strings, got {}", name,
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
            words.emplace_back(lua::text_at(L, -1));
        } else if (type == LUA_TNUMBER && words.empty()) {
            numbers.push_back(lua_tonumber(L, -1));
        } else {
            lua::fail(
                L, call,
                {.sentence = fmt::format("{}[{}] must be a {}, got {}", name, i,
                                         words.empty() ? "number" : "string as those before", lua::describe(L, -1)),
                 .option = name,
                 .culprit = lua::written(L, -1)});
        }
        lua_pop(L, 1);
    }
    if (const std::string key = lua::key_beside_list(L, -1); !key.empty()) {
        lua::fail(L, call,
                  {.sentence = fmt::format("{} must be a list such as {{ 1, 2, 3 }}, but it has {}", name, key),
                   .option = name});
    }
    return words.empty() ? column_of(name, std::move(numbers)) : column_of(name, std::move(words));
}

std::vector<DataColumn> columns_in(lua_State* L, int table, const std::function<DataColumn(const std::string&)>& read,
                                   const std::function<void(lua_Integer)>& no_pair) {
    std::vector<DataColumn> columns;
    const auto listed = static_cast<lua_Integer>(lua_rawlen(L, table));
    for (lua_Integer i = 1; i <= listed; ++i) {
        lua_rawgeti(L, table, i);
        if (!lua_istable(L, -1) || lua_rawgeti(L, -1, 1) != LUA_TSTRING) no_pair(i);
        const std::string name(lua::text_at(L, -1));
        lua_rawgeti(L, -2, 2);
        columns.push_back(read(name));
        lua_pop(L, 3);
    }
    for (const std::string& name : lua::text_keys(L, table)) {
        lua::push_field(L, table, name);
        columns.push_back(read(name));
        lua_pop(L, 1);
    }
    return columns;
}

namespace {

/// Reads the parameter values on the top of the stack.
DataColumn parameter_on_top(lua_State* L, const lua::Options& options, const std::string& name) {
    if (!lua_istable(L, -1) && lua::test<lua::Vector>(L, -1) == nullptr) {
        options.fail("over", "over.{} must be a vector or a table of values, got {}", name, lua::describe(L, -1));
    }
    if (lua_istable(L, -1)) {
        const bool of_words = lua_rawgeti(L, -1, 1) == LUA_TSTRING;
        lua_pop(L, 1);
        if (of_words) return read_column(L, options.call(), name);
    }
    std::vector<double> numbers = lua::numbers_at(L, -1, options.call(), name);
    if (numbers.empty()) options.fail("over", "{} has no values", name);
    return column_of(name, std::move(numbers));
}

}  // namespace

std::vector<DataColumn> asked_parameters(lua_State* L, const lua::Options& options) {
    options.push("over");
    if (lua_isnil(L, -1)) options.missing("over");
    if (!lua_istable(L, -1)) options.wrong("over");
    std::vector<DataColumn> parameters = columns_in(
        L, lua_gettop(L), [&](const std::string& name) { return parameter_on_top(L, options, name); },
        [&](lua_Integer i) {
            options.fail("over", "over[{}] must be a name and its values, {{ \"r\", v }}; or name them, r = v", i);
        });
    if (parameters.empty()) options.wrong("over");
    lua_pop(L, 1);
    double points = 1;
    std::set<std::string> names;
    for (const DataColumn& parameter : parameters) {
        if (parameter.name == "error") {
            options.fail("over", "'error' is the column of messages: give the parameter another name");
        }
        if (!names.insert(parameter.name).second) {
            options.fail("over", "there are two parameters '{}'", parameter.name);
        }
        points *= static_cast<double>(parameter.size());
    }
    constexpr double most = 1e9;
    if (points > most) {
        options.fail(text::error("{:.3g} points are more than the {:.0e} that one sweep can hold", points, most));
    }
    return parameters;
}

std::vector<DataColumn> varied_in(lua_State* L, const lua::Options& options) {
    std::vector<DataColumn> parameters = asked_parameters(L, options);
    if (parameters.size() > 2) {
        options.fail("over", "over has {} names: a response varies one or two, and sweep varies more",
                     parameters.size());
    }
    for (const DataColumn& parameter : parameters) {
        if (parameter.numbers() == nullptr) {
            options.fail("over", "over.{} must be a list of numbers", parameter.name);
        }
    }
    return parameters;
}

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
        each.push(L, row);
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
    lua::add_class<DataHandle>,
    lua::guarded<data_other_key>,
    data_card};

const lua::Class data_module = {"data",
                                {"data{ ... } -> d", "Makes tables of named columns, and reads them from files.",
                                 "print(#data{ r = { 0.5, 1 } })  --> 2"},
                                data_module_members,
                                lua::add_module};

}  // namespace dinal::api

// Operations on data: pick and sort rows, pick columns, draw, save, write down.

namespace dinal::api::data_functions {
namespace {

/// A copy with these rows only.
Data with_rows(const Data& data, const std::vector<std::size_t>& rows) {
    Data picked{.columns = {},
                .points_of = data.points_of,
                .points_over = data.points_over,
                .pieces_of = data.pieces_of,
                .dotted_of = data.dotted_of,
                .parameters = data.parameters};
    for (const DataColumn& column : data.columns) picked.columns.push_back(column.rows(rows));
    return picked;
}

std::string file_argument(lua_State* L, int index, const char* call) {
    if (lua_type(L, index) != LUA_TSTRING) {
        lua::raise_got(L, index, call, fmt::format("{}: the name of the file must be a string", call));
    }
    std::string file = lua_tostring(L, index);
    if (text::ending_of(file) == ".dat") {
        lua::fail(L, call,
                  {.sentence = fmt::format("'{}' is a name for the record of 1989; data are CSV files, {}", file,
                                           "load reads such a record"),
                   .culprit = file});
    }
    return file;
}

std::string in_markdown(const std::string& words) {
    return text::markdown(text::displayable(words), "|\\`[");  // | ends a cell, the others are markup
}

}  // namespace

const DataHandle& self(lua_State* L, const char* call) {
    return lua::self<DataHandle>(L, 1, call);
}

const DataColumn& column_or_fail(lua_State* L, const Data& data, std::string_view call, std::string_view name) {
    if (const DataColumn* found = data.find(name)) return *found;
    std::vector<std::string> names;
    for (const DataColumn& column : data.columns) names.push_back(column.name);
    if (const auto place = files::place_without_unit(names, name)) return data.columns[*place];
    text::Error error{.sentence = fmt::format("there is no column '{}' among {}", name, fmt::join(names, ", ")),
                      .culprit = std::string(name),
                      .cure = text::did_you_mean(name, names)};
    lua::raise(L, call.empty() ? error : text::in_call(call, error));
}

int filter(lua_State* L) {
    const DataHandle data = self(L, "d:filter(f)");
    const auto* mask = lua::test<lua::Vector>(L, 2);
    if (mask == nullptr && lua_type(L, 2) != LUA_TFUNCTION) {
        lua::raise_got(L, 2, "d:filter", "d:filter takes a function of a row, or a vector with a number for each row");
    }
    if (mask != nullptr && mask->size() != data->size()) {
        lua::fail(L, "d:filter", "the vector has {} numbers, but there are {} rows", mask->size(), data->size());
    }
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < data->size(); ++i) {
        bool stays = mask != nullptr && mask->begin()[i] != 0;
        if (mask == nullptr) {
            lua_pushvalue(L, 2);
            push_row(L, 1, *data, i);
            lua_call(L, 1, 1);
            stays = lua_toboolean(L, -1) != 0;
            lua_pop(L, 1);
        }
        if (stays) rows.push_back(i);
    }
    return push_data(L, with_rows(*data, rows));
}

int sort(lua_State* L) {
    const DataHandle data = self(L, "d:sort(\"A\")");
    if (lua_type(L, 2) != LUA_TSTRING) {
        lua::raise_got(L, 2, "d:sort", "d:sort: the name of a column must be a string",
                       fmt::format("; for example {}", sort_call.example));
    }
    const DataColumn& column = column_or_fail(L, *data, "d:sort", lua_tostring(L, 2));
    const bool down = lua::read<SortOptions>(L, 3, sort_call).descending;
    std::vector<std::size_t> rows(data->size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    const lua::Vector* numbers = column.numbers();
    std::ranges::stable_sort(rows, [&](std::size_t i, std::size_t j) {
        if (numbers == nullptr) {
            const std::vector<std::string>& words = column.words();
            return down ? words[j] < words[i] : words[i] < words[j];
        }
        const double a = numbers->begin()[i], b = numbers->begin()[j];
        if (std::isnan(a) || std::isnan(b)) return !std::isnan(a);
        return down ? b < a : a < b;
    });
    Data sorted = with_rows(*data, rows);
    sorted.pieces_of.clear();
    sorted.dotted_of.clear();
    return push_data(L, std::move(sorted));
}

int select(lua_State* L) {
    const DataHandle data = self(L, "d:select(\"r\", \"A\")");
    Data picked;
    for (int i = 2; i <= lua_gettop(L); ++i) {
        if (lua_type(L, i) != LUA_TSTRING) {
            lua::raise_got(L, i, "d:select", "d:select takes names of columns");
        }
        const DataColumn& column = column_or_fail(L, *data, "d:select", lua_tostring(L, i));
        if (picked.find(column.name) == nullptr) picked.columns.push_back(column);
    }
    if (picked.columns.empty()) {
        lua::raise(L, {.sentence = "d:select needs the name of a column, for example d:select(\"r\", \"A\")",
                       .call = "d:select"});
    }
    return push_data(L, std::move(picked));
}

int save_rows(lua_State* L, const std::vector<std::string>& comments) {
    lua::refuse_in_worker(L, "d:save");
    const DataHandle data = self(L, "d:save(\"table.csv\")");
    const std::string file = file_argument(L, 2, "d:save");
    if (text::ending_of(file) != ".csv") {  // safe mode guarantees that scripts write no other files
        lua::fail(L, "d:save", {.sentence = fmt::format("the name '{}' must end in .csv", file), .culprit = file});
    }
    std::vector<files::NamedColumn> columns;
    for (const DataColumn& column : data->columns) columns.push_back(column.named());
    lua::value_or_raise(L, "d:save", files::write_csv(file, columns, comments, files::Gaps::written));
    return 0;
}

int save(lua_State* L) {
    return save_rows(L, {});
}

int markdown(lua_State* L) {
    return lua::push_text(L, markdown_of(*self(L, "d:markdown()")));
}

}  // namespace dinal::api::data_functions

namespace dinal::api {

std::string markdown_of(const Data& data) {
    std::string text = "|", rule = "\n|";
    for (const DataColumn& column : data.columns) {
        text += " " + data_functions::in_markdown(column.label()) + " |";
        rule += column.numbers() != nullptr ? "---:|" : "---|";
    }
    text += rule;
    for (std::size_t row = 0; row < data.size(); ++row) {
        text += "\n|";
        for (const DataColumn& column : data.columns)
            text += " " + data_functions::in_markdown(column.text(row)) + " |";
    }
    return text;
}

}  // namespace dinal::api

namespace dinal::api::data_functions {

// d:plot{ ... }: curves over a column, maps, and the overlays that data provide.

namespace {

// ---- maps: a column in shades over the grid of two others

constexpr int vermilion = 2;  // colour that is visible on both dark and bright shades

/// The distinct values, increasing.
std::vector<double> different_values(std::span<const double> all, bool logarithmic) {
    std::vector<double> values;
    std::ranges::copy_if(all, std::back_inserter(values),
                         [logarithmic](double v) { return plots::drawable(v, logarithmic); });
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

std::size_t place_among(const std::vector<double>& values, double value) {
    return static_cast<std::size_t>(std::ranges::lower_bound(values, value) - values.begin());
}

plots::Shades shades_of(const lua::Options& options, const std::array<std::string, 3>& names,
                        const std::array<plots::Numbers, 3>& columns) {
    const auto [x, y, z] = std::array{columns[0].values, columns[1].values, columns[2].values};
    const auto is_asked = [&](const char* name) {
        return options.has(name) && std::get<bool>(options.value(options.row(name)));
    };
    const bool xlog = is_asked("xlog"), ylog = is_asked("ylog");
    plots::Shades shades{.x = different_values(x, xlog), .y = different_values(y, ylog), .z = {}, .label = names[2]};
    constexpr double sparse = 16;  // maximum number of grid points per row; scattered points would form a huge grid
    const double places = static_cast<double>(shades.x.size()) * static_cast<double>(shades.y.size());
    if (shades.x.empty() || shades.y.empty() || places > sparse * static_cast<double>(z.size())) {
        options.fail("z", "{} and {} form no grid: {} rows have {} different values of {} and {} of {}", names[0],
                     names[1], z.size(), shades.x.size(), names[0], shades.y.size(), names[1]);
    }
    shades.z.assign(shades.x.size() * shades.y.size(), std::numeric_limits<double>::quiet_NaN());
    std::vector<bool> filled(shades.z.size());
    for (std::size_t row = 0; row < z.size(); ++row) {
        if (!plots::drawable(x[row], xlog) || !plots::drawable(y[row], ylog)) continue;
        const std::size_t place = place_among(shades.y, y[row]) * shades.x.size() + place_among(shades.x, x[row]);
        if (filled[place]) {
            options.fail("z",
                         "there are two rows with {} = {:.6g}, {} = {:.6g}: pick one, as with "
                         "d:filter",
                         names[0], x[row], names[1], y[row]);
        }
        filled[place] = true;
        shades.z[place] = z[row];
    }
    return shades;
}

/// A map of z over x and y, with the option zlim. Fails unless x and y form a grid.
plots::Figure figure_of_map(const lua::Options& options, const std::array<std::string, 3>& names,
                            const std::array<plots::Numbers, 3>& columns) {
    plots::Shades shades = shades_of(options, names, columns);
    if (options.has("zlim")) {
        const std::vector<double> ends = options.numbers("zlim");
        if (ends.size() != 2 || !(ends[0] < ends[1])) {
            options.fail("zlim", "zlim must be two increasing numbers such as { 0, 10 }");
        }
        shades.limits = plots::Interval{ends[0], ends[1]};
    }
    plots::Figure figure;
    figure.x.label = names[0];
    figure.y.label = names[1];
    figure.shades = std::make_shared<const plots::Shades>(std::move(shades));
    return figure;
}

/// The rows of a map. If several branches exist at one point, the stable one with the greatest z is used.
std::array<plots::Numbers, 3> stable_rows(const Data& data, const std::array<plots::Numbers, 3>& columns) {
    const DataColumn* stable = data.pieces_of.empty() ? nullptr : data.find(data.dotted_of);
    if (stable == nullptr || stable->numbers() == nullptr) return columns;
    std::map<std::pair<double, double>, double> shown;
    for (std::size_t row = 0; row < columns[2].values.size(); ++row) {
        if (stable->numbers()->begin()[row] == 0) continue;
        const double z = columns[2].values[row];
        const auto place = shown.try_emplace({columns[0].values[row], columns[1].values[row]}, z).first;
        if (z > place->second) place->second = z;
    }
    std::array<std::vector<double>, 3> rows;
    for (const auto& [place, z] : shown) {
        rows[0].push_back(place.first);
        rows[1].push_back(place.second);
        rows[2].push_back(z);
    }
    return {plots::Numbers::own(std::move(rows[0])), plots::Numbers::own(std::move(rows[1])),
            plots::Numbers::own(std::move(rows[2]))};
}

// ---- curves

/// The names given in `option`: one or a list.
std::vector<std::string> asked_names(lua_State* L, const lua::Options& options, const char* option) {
    options.push(option);
    const auto names = lua::strings_at(L, -1);
    if (!names || (names->empty() && !lua_isnil(L, -1))) {
        options.wrong(option, "the name of a column or a list of them");
    }
    lua_pop(L, 1);
    return *names;
}

plots::Numbers drawn(lua_State* L, const Data& data, const std::string& name) {
    const DataColumn& column = column_or_fail(L, data, "d:plot", name);
    if (column.numbers() == nullptr) {
        lua::fail(L, "d:plot",
                  {.sentence = fmt::format("the column '{}' holds words, not numbers", name), .culprit = name});
    }
    const auto kept = std::make_shared<const lua::Vector>(*column.numbers());
    return {kept, kept->values()};
}

std::string label_of(const Data& data, const std::string& name) {
    const DataColumn* column = data.find(name);
    return column != nullptr ? model::name_with_unit(plots::symbol_for(name), column->unit) : name;
}

constexpr double spectrum_decades = 1e-6;  // smallest plotted amplitude of a spectrum, relative to the largest

/// The frequencies with larger amplitudes than this, if they cover only part of the spectrum.
std::optional<plots::Interval> significant_frequencies(const Data& data, const plots::Curve& curve) {
    if (!data.is_spectrum || curve.size() == 0) return std::nullopt;
    double greatest = 0, last = 0;
    for (const double y : curve.y.values) greatest = y > greatest ? y : greatest;
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (curve.y.values[i] > spectrum_decades * greatest) last = curve.x.values[i];
    }
    constexpr double room = 1.2, good_part = 0.8;
    const double end = curve.x.values[curve.size() - 1];
    return last > 0 && room * last < good_part * end ? std::optional(plots::Interval{0, room * last}) : std::nullopt;
}

/// Limits of y that show the interesting part of a curve: six decades of a spectrum; of a response a few times its
/// typical height, as it is unbounded near a pole.
std::optional<plots::Interval> significant_limits(const Data& data, const plots::Curve& curve) {
    std::vector<double> values;
    std::ranges::copy_if(curve.y.values, std::back_inserter(values), [](double y) { return std::isfinite(y); });
    if (values.empty() || (!data.is_spectrum && data.pieces_of.empty())) return std::nullopt;
    const auto [least, greatest] = std::ranges::minmax_element(values);
    const plots::Interval all{*least, *greatest};
    if (data.is_spectrum) {
        return all.high > 0 && all.low < spectrum_decades * all.high
                   ? std::optional(plots::Interval{spectrum_decades * all.high, 2 * all.high})
                   : std::nullopt;
    }
    constexpr double most = 0.9, much_higher = 10, shown = 4;
    const auto place = static_cast<std::ptrdiff_t>(most * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    const double usual = values[static_cast<std::size_t>(place)];
    return usual > 0 && all.high > much_higher * usual
               ? std::optional(plots::Interval{std::min(0.0, all.low), shown * usual})
               : std::nullopt;
}

/// Splits a line where its data are interrupted; unstable parts become a dotted line.
std::vector<plots::Curve> curve_in_pieces(const Data& data, const std::string& pieces, const plots::Curve& whole) {
    constexpr double gap = std::numeric_limits<double>::quiet_NaN();
    const auto numbers_of = [&data](const std::string& name) -> const lua::Vector* {
        const DataColumn* column = data.find(name);
        return column != nullptr ? column->numbers() : nullptr;
    };
    const lua::Vector* piece = numbers_of(pieces);
    const lua::Vector* solid = numbers_of(data.dotted_of);
    std::array<std::vector<double>, 2> x, y;  // the dotted and the solid line
    std::array<bool, 2> any{};
    std::size_t before = 1;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const std::size_t line = solid == nullptr || solid->begin()[i] != 0 ? 1 : 0;
        const bool new_piece = i > 0 && piece != nullptr && piece->begin()[i] != piece->begin()[i - 1];
        const auto put = [&](std::size_t of, double px, double py) {
            x[of].push_back(px);
            y[of].push_back(py);
        };
        if (i > 0 && (new_piece || line != before)) {
            put(before, gap, gap);
            // One line continues from the end of the other.
            if (!new_piece) put(line, whole.x.values[i - 1], whole.y.values[i - 1]);
        }
        put(line, whole.x.values[i], whole.y.values[i]);
        any[line] = true;
        before = line;
    }
    std::vector<plots::Curve> curves;
    for (const std::size_t line : {std::size_t{1}, std::size_t{0}}) {
        if (!any[line]) continue;
        plots::Curve curve = whole;
        curve.x = plots::Numbers::own(std::move(x[line]));
        curve.y = plots::Numbers::own(std::move(y[line]));
        if (line == 0) {
            curve.dashes = plots::Dashes::dotted;
            curve.label = "unstable";
        } else if (any[0] && curve.label.empty()) {
            curve.label = "stable";
        }
        curves.push_back(std::move(curve));
    }
    return curves;
}

/// Splits a curve by the words of a column, each of which becomes a label.
std::vector<plots::Curve> parts_by(const std::vector<std::string>& words, const plots::Curve& whole) {
    std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> parts;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        auto& [x, y] = parts[words[i]];
        x.push_back(whole.x.values[i]);
        y.push_back(whole.y.values[i]);
    }
    std::vector<plots::Curve> curves;
    for (auto& [word, places] : parts) {
        plots::Curve& curve = curves.emplace_back(whole);
        curve.x = plots::Numbers::own(std::move(places.first));
        curve.y = plots::Numbers::own(std::move(places.second));
        curve.label = word == "hopf" ? "Hopf" : word;
    }
    return curves;
}

/// The curves of an overlay in the same columns: one, or one for each kind of point on a map.
std::vector<plots::Curve> overlay_curves(const lua::Options& options, const Data& data, const std::string& name,
                                         const std::string& x, const std::string& y) {
    const DataCompanion* companion = data.companion(name);
    if (companion == nullptr) {
        std::vector<std::string_view> names;
        for (const DataCompanion& known : data.companions) names.emplace_back(known.name);
        options.fail({.sentence = names.empty()
                                      ? fmt::format("these data have no overlay '{}', nor any other", name)
                                      : fmt::format("there is no overlay '{}' among {}", name, fmt::join(names, ", ")),
                      .option = "overlay",
                      .culprit = name,
                      .cure = text::did_you_mean(name, names)});
    }
    const Data drawn = companion->drawn ? companion->drawn() : companion->made();
    plots::Curve curve;
    for (const auto& [column, numbers] : {std::pair(&x, &curve.x), std::pair(&y, &curve.y)}) {
        const DataColumn* found = drawn.find(*column);
        if (found == nullptr || found->numbers() == nullptr) {
            options.fail("overlay", "the overlay '{}' has no {}", name, *column);
        }
        const std::span<const double> values = found->numbers()->values();
        *numbers = plots::Numbers::own({values.begin(), values.end()});
    }
    curve.label = name;
    const DataColumn* kind = companion->drawn ? drawn.find("kind") : nullptr;
    return kind == nullptr ? std::vector{curve} : parts_by(kind->words(), curve);
}

/// The parameters with more than one value.
std::vector<std::string> different_parameters(const Data& data) {
    std::vector<std::string> names;
    for (const std::string& name : data.parameters) {
        const DataColumn* column = data.find(name);
        if (column == nullptr) continue;
        const auto differ = [](const auto& values) {
            return std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) != values.end();
        };
        const lua::Vector* numbers = column->numbers();
        if (numbers != nullptr ? differ(*numbers) : differ(column->words())) names.push_back(name);
    }
    return names;
}

/// The numeric columns that are neither x nor parameters of a grid.
std::vector<std::string> drawable_results(const Data& data, const std::string& x) {
    std::vector<std::string> names;
    for (const DataColumn& column : data.columns) {
        const bool given = text::contains(data.parameters, column.name);
        if (!given && column.name != x && column.numbers() != nullptr) names.push_back(column.name);
    }
    return names;
}

/// The columns that a plot draws; z is empty unless it is a map.
struct DrawnColumns {
    std::string x;
    std::vector<std::string> y;
    std::string z;
    std::vector<std::string> over;  // parameters with more than one value
};

/// Selects the columns. Points over two parameters are drawn as a map, by default of the first result, or as a curve
/// for each value of the first parameter.
DrawnColumns asked_columns(lua_State* L, const lua::Options& options, const Data& data) {
    std::vector<std::string> x = asked_names(L, options, "x"), y = asked_names(L, options, "y");
    if (x.size() > 1) options.fail("x", "x must be one column");
    std::vector<std::string> z = asked_names(L, options, "z");
    const std::vector<std::string> over = different_parameters(data);
    const bool curves = !y.empty() || options.has("style");
    const bool is_map = over.size() > 1 && (!z.empty() || (x.empty() && !curves));
    if (is_map && z.empty() && over.size() > 2) {
        options.fail(text::error("points over {} are not a map: pick those of one {} with d:filter, or name x, y and z",
                                 fmt::join(over, ", "), over.front()));
    }
    if (x.empty() && !over.empty()) x = {over.size() == 2 && !is_map ? over[1] : over[0]};
    if (x.empty()) x.push_back(data.points_over.empty() ? data.columns.front().name : data.points_over);
    const std::vector<std::string> results = drawable_results(data, x.front());
    if (y.empty() && results.empty()) options.fail({"there is no other column of numbers to draw"});
    if (is_map && z.empty()) z = {results.front()};
    if (y.empty()) y = {is_map ? over[x.front() == over[1] ? 0 : 1] : results.front()};
    if (data.size() == 0) options.fail({"there are no rows to draw"});
    if (z.empty()) return {x.front(), y, "", over};
    if (options.has("style")) options.fail("style", "style is for curves: leave it out, or z");
    if (z.size() > 1) options.fail("z", "z must be one column");
    if (options.has("y") && y.size() > 1) options.fail("y", "y must be one column where z is drawn over x and y");
    return {x.front(), {y.front()}, z.front(), over};
}

int plot_map(lua_State* L, const lua::Options& options, const Data& data, const DrawnColumns& columns) {
    const std::string &x = columns.x, &y = columns.y.front(), &z = columns.z;
    std::vector<plots::Figure> map{figure_of_map(
        options, {x, y, z}, stable_rows(data, {drawn(L, data, x), drawn(L, data, y), drawn(L, data, z)}))};
    map.front().x.label = label_of(data, x);
    map.front().y.label = label_of(data, y);
    for (const std::string& name : asked_names(L, options, "overlay")) {
        for (plots::Curve& curve : overlay_curves(options, data, name, x, y)) {
            curve.colour = vermilion;
            map.front().curves.push_back(std::move(curve));
        }
    }
    apply_options(L, options, map.front());
    return deliver(L, options, std::move(map));
}

/// Adds the curves of all columns y, in the style of `curve`, which becomes the last of them.
void add_curves(lua_State* L, const Data& data, const DrawnColumns& columns, plots::Curve& curve,
                plots::Figure& figure) {
    const auto& [x, y, z, over] = columns;
    const Data& shown = data.between && curve.style == plots::Style::line ? *data.between : data;
    const std::string pieces = over.size() == 2 && data.pieces_of.empty() ? over[0] : data.pieces_of;
    for (const std::string& name : y) {
        curve.x = drawn(L, shown, x);
        curve.y = drawn(L, shown, name);
        curve.label = y.size() == 1 ? "" : name;
        if (pieces.empty() || curve.style != plots::Style::line) {
            figure.curves.push_back(curve);
        } else {
            for (plots::Curve& piece : curve_in_pieces(shown, pieces, curve)) figure.curves.push_back(std::move(piece));
        }
    }
}

void add_overlays(lua_State* L, const lua::Options& options, const Data& data, const DrawnColumns& columns,
                  plots::Figure& figure) {
    constexpr std::array<plots::Dashes, 3> dashes{plots::Dashes::dashed, plots::Dashes::dash_dotted,
                                                  plots::Dashes::dotted};
    const std::string& y = columns.y.front();
    std::size_t overlays = 0;
    for (const std::string& name : asked_names(L, options, "overlay")) {
        if (figure.curves.front().label.empty()) figure.curves.front().label = label_of(data, y);
        for (plots::Curve& overlay : overlay_curves(options, data, name, columns.x, y)) {
            overlay.dashes = dashes[overlays++ % dashes.size()];
            figure.curves.push_back(std::move(overlay));
        }
    }
}

int plot_curves(lua_State* L, const lua::Options& options, const Data& data, DrawnColumns columns) {
    if (!options.numbers("zlim").empty()) options.fail("zlim", "zlim is for maps: name a column z, too");
    const std::string& x = columns.x;
    std::vector<std::string>& y = columns.y;
    plots::Figure figure;
    figure.x.label = label_of(data, x);
    plots::Curve curve;
    if (!data.points_of.empty() && !options.has("y") && x != data.points_of) y = {data.points_of};
    // x is the outer parameter: a line would jump between grid rows
    const bool leaps = columns.over.size() == 2 && x == columns.over[0];
    if (!data.points_of.empty() || leaps) curve.style = plots::Style::points;
    figure.y.label = y.size() == 1 ? label_of(data, y.front()) : "";
    options.fill(curve);
    add_curves(L, data, columns, curve, figure);
    add_overlays(L, options, data, columns, figure);
    figure.y.logarithmic = data.is_spectrum;
    if (y.size() == 1) {
        figure.x.limits = significant_frequencies(data, curve);
        figure.y.limits = significant_limits(data, curve);
    }
    apply_options(L, options, figure);
    if (!options.has("ylim") && figure.y.logarithmic != data.is_spectrum) figure.y.limits.reset();
    if (!options.has("xlim") && figure.x.logarithmic) figure.x.limits.reset();
    std::vector<plots::Figure> figures{std::move(figure)};
    return deliver(L, options, std::move(figures));
}

}  // namespace

int plot(lua_State* L) {
    const DataHandle data = self(L, "d:plot{ x = \"r\", y = \"A\" }");
    const lua::Options options(L, 2, plot_data_call);
    DrawnColumns columns = asked_columns(L, options, *data);
    return columns.z.empty() ? plot_curves(L, options, *data, std::move(columns))
                             : plot_map(L, options, *data, columns);
}

}  // namespace dinal::api::data_functions
