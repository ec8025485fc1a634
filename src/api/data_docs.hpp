// What help() and the manual say about data, and the options of its methods.
#pragma once

#include "api/plot_options.hpp"
#include "lua/bind.hpp"

namespace dinal::api {

/// d:plot{ x, y }, in data_methods.cpp.
inline constexpr text::Option data_plot_options[] = {
    {.name = "x", .otherwise = "the first column", .meaning = "name of a column"},
    {.name = "y", .otherwise = "the second column", .meaning = "name of a column, or a list of them"},
    {.name = "z", .meaning = "name of a column to draw as a map over a grid of x and y"},
    {.name = "overlay",
     .meaning = "name of an additional curve, or a list: the data of a response have \"jumps\" and, if it "
                "exists, \"linearised\" and \"den_hartog\""},
    {.name = "zlim", .meaning = "{ from, to }: values beyond get the first or last shade of the map"},
    {.name = "contours", .meaning = "a list of values of z whose lines are drawn on the map"},
    {.name = "style",
     .meaning = "style of the curves; numbers that are not finite are gaps",
     .filled = text::fills<&plots::Curve::style>,
     .choices = plots::style_names},
};
inline constexpr auto plot_data_options = text::joined(data_plot_options, figure_options, target_options);
inline constexpr text::Call plot_data_call{"d:plot", "d:plot{ x = \"r\", y = \"A\" }", plot_data_options, true};

struct SortOptions {
    bool descending = false;
};
inline constexpr text::Option sort_options[] = {
    {.name = "descending", .meaning = "the greatest first", .filled = text::fills<&SortOptions::descending>},
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
inline constexpr lua::Doc load_doc{
    "data.load(file)", "Its name is load now.",
    "print(select(2, pcall(data.load, \"run.csv\")):match(\"load%(.*\"))  --> load(\"run.csv\")"};

#undef DINAL_DATA

}  // namespace dinal::api
