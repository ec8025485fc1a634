// What one does with data: pick and sort rows, pick columns, draw, save, write down.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "api/data.hpp"
#include "api/data_docs.hpp"
#include "files/csv.hpp"
#include "lua/options.hpp"
#include "lua/worker_state.hpp"
#include "text/characters.hpp"
#include "text/html.hpp"
#include "text/words.hpp"

namespace dinal::api::data_functions {
namespace {

/// The same columns with these rows only.
Data with_rows(const Data& data, const std::vector<std::size_t>& rows) {
    Data picked{.columns = {},
                .points_of = data.points_of,
                .points_over = data.points_over,
                .pieces_of = data.pieces_of,
                .dotted_of = data.dotted_of,
                .parameters = data.parameters};
    for (const DataColumn& column : data.columns) {
        if (const lua::Vector* numbers = column.numbers()) {
            std::vector<double> values(rows.size());
            std::transform(rows.begin(), rows.end(), values.begin(),
                           [numbers](std::size_t row) { return numbers->begin()[row]; });
            picked.columns.push_back(column_of(column.name, std::move(values), column.unit));
        } else {
            const std::vector<std::string>& words = *std::get<Words>(column.values);
            std::vector<std::string> values(rows.size());
            std::transform(rows.begin(), rows.end(), values.begin(), [&words](std::size_t row) { return words[row]; });
            picked.columns.push_back(column_of(column.name, std::move(values)));
        }
    }
    return picked;
}

std::string file_argument(lua_State* L, int index, const char* call) {
    if (lua_type(L, index) != LUA_TSTRING) {
        lua::raise_got(L, index, call, fmt::format("{}: the name of the file must be a string", call));
    }
    std::string file = lua_tostring(L, index);
    if (text::ending_of(file) == ".dat") {
        lua::raise(L, {.sentence = fmt::format("{}: '{}' is a name for the record of 1989; data are CSV files, {}",
                                               call, file, "load reads such a record"),
                       .call = call,
                       .culprit = file});
    }
    return file;
}

std::string in_markdown(const std::string& words) {
    return text::markdown(text::displayable(words), "|\\`[");  // the marks end a cell, or are no text
}

}  // namespace

const DataHandle& self(lua_State* L, const char* call) {
    return lua::self<DataHandle>(L, 1, call);
}

const DataColumn& column_or_fail(lua_State* L, const Data& data, std::string_view call, std::string_view name) {
    if (const DataColumn* found = data.find(name)) return *found;
    std::vector<std::string_view> names;
    for (const DataColumn& column : data.columns) names.emplace_back(column.name);
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
        lua::raise(L, {.sentence = fmt::format("d:filter: the vector has {} numbers, but there are {} rows",
                                               mask->size(), data->size()),
                       .call = "d:filter"});
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
    push_data(L, with_rows(*data, rows));
    return 1;
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
    std::stable_sort(rows.begin(), rows.end(), [&](std::size_t i, std::size_t j) {
        if (numbers == nullptr) {
            const std::vector<std::string>& words = *std::get<Words>(column.values);
            return down ? words[j] < words[i] : words[i] < words[j];
        }
        const double a = numbers->begin()[i], b = numbers->begin()[j];
        if (std::isnan(a) || std::isnan(b)) return !std::isnan(a);
        return down ? b < a : a < b;
    });
    Data sorted = with_rows(*data, rows);
    sorted.pieces_of.clear();
    sorted.dotted_of.clear();
    push_data(L, std::move(sorted));
    return 1;
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
    push_data(L, std::move(picked));
    return 1;
}

int save(lua_State* L) {
    lua::refuse_in_worker(L, "d:save");
    const DataHandle data = self(L, "d:save(\"table.csv\")");
    const std::string file = file_argument(L, 2, "d:save");
    std::vector<files::NamedColumn> columns;
    for (const DataColumn& column : data->columns) {
        files::NamedColumn& written = columns.emplace_back(files::NamedColumn{column.name});
        if (const lua::Vector* numbers = column.numbers()) {
            written.values = numbers->values();
        } else {
            written.words = *std::get<Words>(column.values);
        }
    }
    lua::value_or_raise(L, "d:save", files::write_csv(file, columns, {}, files::Gaps::written));
    return 0;
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
