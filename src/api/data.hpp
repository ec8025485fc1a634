// Named columns of equal length, of numbers or words, in Lua: data{ ... }, load(file), run.events.
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
    std::string unit = {};  ///< shown with the name in tables and at axes

    std::size_t size() const;
    const lua::Vector* numbers() const { return std::get_if<lua::Vector>(&values); }
    const std::vector<std::string>& words() const { return *std::get<Words>(values); }
    /// A copy with the values of these rows.
    DataColumn rows(const std::vector<std::size_t>& rows) const;
    void push(lua_State* L, std::size_t row) const;
    /// The column as written to a file.
    files::NamedColumn named() const;
    /// The value as text: six digits, or a word unchanged.
    std::string text(std::size_t row) const;
    /// "t, s"
    std::string label() const { return model::name_with_unit(name, unit); }
};

/// The first of these words that is not a number, in quotes: it makes the column of a file one of words.
std::string first_word(const std::vector<std::string>& words);

struct Data;

/// Additional data, made on demand: d.jumps, d:plot{ overlay = "linearised" }.
struct DataCompanion {
    std::string name;
    std::function<Data()> made;
    std::function<Data()> drawn = {};  ///< the overlay of plots, if it differs from the data
};

struct Data {
    std::vector<DataColumn> columns;
    std::string heading = {};                  ///< first line of its text; by default the numbers of rows and columns
    std::string points_of = {};                ///< column that d:plot() draws as points by default
    std::string points_over = {};              ///< default x of these points; empty: the first column
    std::string pieces_of = {};                ///< column that divides the lines of d:plot() where its value changes
    std::string dotted_of = {};                ///< column that makes lines of d:plot() dotted where it is 0
    bool is_spectrum = false;                  ///< whether d:plot() has a logarithmic axis
    std::vector<std::string> parameters = {};  ///< columns that span a grid of points, the fastest last
    std::vector<DataCompanion> companions = {};
    std::shared_ptr<const Data> between = {};  ///< additional rows between these, for lines in d:plot()

    std::size_t size() const { return columns.empty() ? 0 : columns.front().size(); }
    const DataColumn* find(std::string_view name) const;
    const DataCompanion* companion(std::string_view name) const;
};
// Shared: pictures and iterations keep their data.
using DataHandle = std::shared_ptr<const Data>;

DataColumn column_of(std::string name, std::vector<double> numbers, std::string unit = {});
DataColumn column_of(std::string name, std::vector<std::string> words);
DataColumn column_of(files::ReadColumn column);
/// A view of numbers owned by `owner`.
template <class Numbers>
lua::Vector view_of(std::shared_ptr<const void> owner, const Numbers& numbers) {
    return {std::move(owner), numbers.data(), static_cast<std::size_t>(numbers.size())};
}

/// A column of a table with one row for each list element: `get` returns its number or word.
template <class Get>
struct ListColumn {
    std::string name;
    Get get;
    std::string unit = {};

    template <class List>
    DataColumn column_from(const List& list) const {
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
    return {.columns = {columns.column_from(list)...}};
}

/// The units of columns; empty if unknown.
struct ColumnUnits {
    explicit ColumnUnits(const model::Units& units);
    std::optional<model::Units> named;  ///< none for the usual units, which are not written
    std::string t, theta, M, speed, frequency;

    /// The unit of a column of a run; empty for a state.
    std::string of(std::string_view column) const;
};

/// The column of the values (numbers or strings) on the top of the stack; errors begin with `call`.
DataColumn read_column(lua_State* L, const char* call, const std::string& name);

/// The columns in the table at `table`, each read from the top of the stack: first the listed ones, { "r", v }, then
/// the named ones sorted by name, since tables are unordered. `no_pair` raises an error if item i is not such a pair.
std::vector<DataColumn> columns_in(lua_State* L, int table, const std::function<DataColumn(const std::string&)>& read,
                                   const std::function<void(lua_Integer)>& no_pair);

/// The points of a sweep: all combinations of parameter values, the last parameter changing fastest.
class PointGrid {
public:
    /// Each column is a parameter with at least one value.
    explicit PointGrid(std::vector<DataColumn> parameters);

    std::size_t size() const { return size_; }
    const std::vector<DataColumn>& parameters() const { return parameters_; }
    /// The index of the parameter's value at this point.
    std::size_t place(std::size_t parameter, std::size_t point) const {
        return point / strides_[parameter] % parameters_[parameter].size();
    }
    /// Sets the parameters of this point in the table on the top of the stack.
    void set_fields(lua_State* L, std::size_t point) const;
    /// The parameters as columns with one row for each of these points.
    std::vector<DataColumn> columns(const std::vector<std::size_t>& points) const;

private:
    std::vector<DataColumn> parameters_;
    std::vector<std::size_t> strides_;
    std::size_t size_ = 1;
};

/// The parameters in the option `over`, with their values: at least one, with distinct names.
std::vector<DataColumn> asked_parameters(lua_State* L, const lua::Options& options);

/// The one or two parameters in `over` of a response, with their values; raises errors.
std::vector<DataColumn> varied_in(lua_State* L, const lua::Options& options);

/// Pushes the data and returns 1, the number of results.
int push_data(lua_State* L, Data data);

/// Pushes a row of the data at `index` as a table with __tostring.
void push_row(lua_State* L, int index, const Data& data, std::size_t row);

/// Pushes events as data: t, kind, where (for several bodies and links), theta, M, velocity and, if any, the user's
/// names.
void push_events(lua_State* L, std::span<const model::Event> events, std::span<const std::string> user_names,
                 const model::Units& units, const model::System* several);

/// The heading and a table of the first rows; columns beyond the width are omitted.
std::string text_of(const Data& data, std::size_t width);

/// A Markdown table, without a final newline.
std::string markdown_of(const Data& data);

/// An HTML table of the first rows, with their total number if there are more.
std::string html_of(const Data& data, std::size_t rows);

/// Methods of the class in bind_data.cpp, in their own files.
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
/// The data on which a method is called, such as d:plot{}.
const DataHandle& self(lua_State* L, const char* call);
/// The column of this name; otherwise raises an error with a suggestion.
const DataColumn& column_or_fail(lua_State* L, const Data& data, std::string_view call, std::string_view name);
}  // namespace data_functions

}  // namespace dinal::api
