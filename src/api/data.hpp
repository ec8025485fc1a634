// Named columns of one length, of numbers or of words, as Lua sees them: data{ ... }, load(file), run.events.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "files/csv.hpp"
#include "lua/bind.hpp"
#include "lua/options.hpp"
#include "lua/vector.hpp"
#include "model/event.hpp"
#include "model/system.hpp"
#include "model/units.hpp"

namespace dinal::api {

using Words = std::shared_ptr<const std::vector<std::string>>;

struct DataColumn {
    std::string name;
    std::variant<lua::Vector, Words> values;
    std::string unit = {};  ///< a word that stands beside the name, in tables and at axes

    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] const lua::Vector* numbers() const { return std::get_if<lua::Vector>(&values); }
    [[nodiscard]] const std::vector<std::string>& words() const { return *std::get<Words>(values); }
    /// The same column with the values of these rows.
    [[nodiscard]] DataColumn rows(const std::vector<std::size_t>& rows) const;
    /// Pushes the value of a row.
    void push(lua_State* L, std::size_t row) const;
    /// As a file has it.
    [[nodiscard]] files::NamedColumn named() const;
    /// As text for people: six digits, a word as it is.
    [[nodiscard]] std::string text(std::size_t row) const;
    /// "t, s"
    [[nodiscard]] std::string label() const { return model::of_unit(name, unit); }
};

struct Data;

/// What data bring along besides their columns, made when it is asked for: d.jumps, d:plot{ overlay = "linearised" }.
struct DataCompanion {
    std::string name;
    std::function<Data()> made;
    std::function<Data()> drawn = {};  ///< what an overlay draws, where that is something else
};

struct Data {
    std::vector<DataColumn> columns;
    std::string heading = {};      ///< what the first line of its text says, else how many rows of which columns
    std::string points_of = {};    ///< d:plot() draws this column as points, unless it is told otherwise
    std::string points_over = {};  ///< and over this one, else over the first
    std::string pieces_of = {};    ///< a line of d:plot() breaks where this column changes
    std::string dotted_of = {};    ///< and is dotted where this one is 0
    bool is_spectrum = false;      ///< d:plot() has a logarithmic axis
    std::vector<std::string> parameters = {};  ///< columns over which all is a grid of points, the fastest one last
    std::vector<DataCompanion> companions = {};
    std::shared_ptr<const Data> between = {};  ///< these rows and more between them, for the lines of d:plot()

    [[nodiscard]] std::size_t size() const { return columns.empty() ? 0 : columns.front().size(); }
    [[nodiscard]] const DataColumn* find(std::string_view name) const;
    [[nodiscard]] const DataCompanion* companion(std::string_view name) const;
};
// Shared, so that a picture or an iteration keeps what it shows.
using DataHandle = std::shared_ptr<const Data>;

DataColumn column_of(std::string name, std::vector<double> numbers, std::string unit = {});
DataColumn column_of(std::string name, std::vector<std::string> words);
DataColumn column_of(files::ReadColumn column);
/// Numbers that `owner` keeps, without a copy.
template <class Numbers>
lua::Vector view_of(std::shared_ptr<const void> owner, const Numbers& numbers) {
    return {std::move(owner), numbers.data(), static_cast<std::size_t>(numbers.size())};
}

/// A column of a table that has a row for each element of a list: what it gets of the element is a number or a word.
template <class Get>
struct ListColumn {
    std::string name;
    Get get;
    std::string unit = {};

    template <class List>
    [[nodiscard]] DataColumn of(const List& list) const {
        using Value = std::decay_t<std::invoke_result_t<const Get&, decltype(*std::begin(list))>>;
        constexpr bool number = std::is_convertible_v<Value, double>;
        std::vector<std::conditional_t<number, double, std::string>> values;
        values.reserve(static_cast<std::size_t>(std::distance(std::begin(list), std::end(list))));
        for (const auto& element : list) values.emplace_back(std::invoke(get, element));
        if constexpr (number) {
            return column_of(name, std::move(values), unit);
        } else {
            return column_of(name, std::move(values));
        }
    }
};
template <class Name, class Get>
ListColumn(Name, Get) -> ListColumn<Get>;
template <class Name, class Get, class Unit>
ListColumn(Name, Get, Unit) -> ListColumn<Get>;

template <class List, class... Get>
Data table_of(const List& list, const ListColumn<Get>&... columns) {
    return {.columns = {columns.of(list)...}};
}

/// What stands beside the names of columns: nothing where nobody has said in what they are measured.
struct ColumnUnits {
    explicit ColumnUnits(const model::Units& units);
    std::string t, theta, M, speed, frequency;

    /// That of a column of a run; none of a state.
    [[nodiscard]] std::string of(std::string_view column) const;
};

/// The column whose values, numbers or strings, are on the top of the stack; `call` raises what is wrong with them.
DataColumn read_column(lua_State* L, const char* call, const std::string& name);

/// The columns in the table at `table`, each read from the top of the stack: first those that are listed, { "r", v },
/// then the named ones by their names, since a table does not know in which order it was written. `no_pair` raises that
/// item i is no such pair.
std::vector<DataColumn> columns_in(lua_State* L, int table, const std::function<DataColumn(const std::string&)>& read,
                                   const std::function<void(lua_Integer)>& no_pair);

/// The points of a sweep: every combination of the values of its parameters, the last parameter changing fastest.
class PointGrid {
public:
    /// Each column is a parameter with at least one value.
    explicit PointGrid(std::vector<DataColumn> parameters);

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] const std::vector<DataColumn>& parameters() const { return parameters_; }
    /// Which value of the parameter this point has.
    [[nodiscard]] std::size_t place(std::size_t parameter, std::size_t point) const {
        return point / strides_[parameter] % parameters_[parameter].size();
    }
    /// "r = 0.5, g = 1"
    [[nodiscard]] std::string text(std::size_t point) const;
    /// Sets the table on the top of the stack to the parameters of this point.
    void set_fields(lua_State* L, std::size_t point) const;
    /// The parameters as columns with a row for each of these points.
    [[nodiscard]] std::vector<DataColumn> columns(const std::vector<std::size_t>& points) const;

private:
    std::vector<DataColumn> parameters_;
    std::vector<std::size_t> strides_;
    std::size_t size_ = 1;
};

/// The parameters that the option `over` names, with their values: one at least, with different names.
std::vector<DataColumn> asked_parameters(lua_State* L, const lua::Options& options);

/// The one or two names under `over` of a response, and their lists of numbers; raises errors.
std::vector<DataColumn> varied_in(lua_State* L, const lua::Options& options);

/// The data as a Lua object on the top of the stack; returns 1, as a function with one result.
int push_data(lua_State* L, Data data);

/// Pushes a row of the data at `index` as a table that knows how to write itself.
void push_row(lua_State* L, int index, const Data& data, std::size_t row);

/// What happened: t, kind, where (of several bodies and links), theta, M, velocity and, where a user gave some, names.
void push_events(lua_State* L, std::span<const model::Event> events, std::span<const std::string> user_names,
                 const model::Units& units, const model::System* several);

/// Its first line, and a table of its first rows; a column that does not fit into the width is left out.
std::string text_of(const Data& data, std::size_t width);

/// A table in Markdown, without a line end behind it.
std::string markdown_of(const Data& data);

/// A table in HTML of its first rows, and how many there are if there are more.
std::string html_of(const Data& data, std::size_t rows);

/// Methods of the class in bind_data.cpp, which have files of their own.
namespace data_functions {
int plot(lua_State* L);
int filter(lua_State* L);
int sort(lua_State* L);
int select(lua_State* L);
int save(lua_State* L);
/// d:save(file) with comments before the rows.
int save_rows(lua_State* L, const std::vector<std::string>& comments);
int column(lua_State* L);
int markdown(lua_State* L);
/// The data of a call such as d:plot{}.
const DataHandle& self(lua_State* L, const char* call);
/// The column of this name, or an error of the call with a suggestion.
const DataColumn& column_or_fail(lua_State* L, const Data& data, std::string_view call, std::string_view name);
}  // namespace data_functions

}  // namespace dinal::api
