// load(file): reads a file written by dinal, or any CSV file. Other arguments go to Lua's own load.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <optional>
#include <vector>

#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/lua_run.hpp"
#include "files/csv.hpp"
#include "files/record1989.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/options.hpp"
#include "text/words.hpp"

namespace dinal::api {

namespace {

const char original_key = 0;  // registry key of Lua's own load

enum class Duplicates { keep, mean, first, last };
struct LoadOptions {
    int skip = 0;
    bool sort = false;
    Duplicates duplicates = Duplicates::keep;
};
constexpr const char* duplicates_names[] = {"keep", "mean", "first", "last"};
constexpr text::Option load_options[] = {
    text::option<&LoadOptions::skip>(
        "skip", "lines before the names that are no part of the table",
        {.range = {"be a whole number from 0 to 1e+06", [](double x) { return text::is_whole(x, 0, 1e6); }}}),
    {.name = "names",
     .meaning = "the names of the columns, instead of those in the file",
     .wanted = "a list of names such as { \"t\", \"theta\" }"},
    text::option<&LoadOptions::sort>(
        "sort",
        "true puts the rows in the order of their times: of the column t or time, or of the first one of numbers"),
    text::option<&LoadOptions::duplicates>(
        "duplicates",
        "what becomes of rows with the same time: one row with the mean of their numbers, the first or the last",
        {.choices = duplicates_names}),
};
constexpr text::Call load_call{"load", "load(\"log.csv\", { skip = 3, sort = true })", load_options, true};

/// Merges the rows of each group: keeps the first or last, or averages the numbers.
void take_groups(files::ReadColumns& content, const std::vector<std::vector<std::size_t>>& groups, Duplicates which) {
    const auto one = [which](const auto& values, const std::vector<std::size_t>& rows) {
        return values[which == Duplicates::last ? rows.back() : rows.front()];
    };
    for (files::ReadColumn& column : content.columns) {
        std::vector<double> numbers;
        std::vector<std::string> words;
        for (const std::vector<std::size_t>& rows : groups) {
            if (column.of_words) {
                words.push_back(one(column.words, rows));
            } else if (which == Duplicates::mean && rows.size() > 1) {
                double sum = 0;
                for (const std::size_t row : rows) sum += column.numbers[row];
                numbers.push_back(sum / static_cast<double>(rows.size()));
            } else {
                numbers.push_back(one(column.numbers, rows));
            }
        }
        column.numbers = std::move(numbers), column.words = std::move(words);
    }
}

/// Sorts rows by time and merges rows of equal times, as requested.
void arrange(const lua::Options& options, const LoadOptions& asked, files::ReadColumns& content) {
    if (!asked.sort && asked.duplicates == Duplicates::keep) return;
    auto& columns = content.columns;
    auto times = std::ranges::find_if(
        columns, [](const files::ReadColumn& column) { return column.name == "t" || column.name == "time"; });
    const char* option = asked.sort ? "sort" : "duplicates";
    if (times != columns.end() && times->of_words) {
        options.fail(option, "{} needs times, and the column '{}' holds words, such as {}", option, times->name,
                     first_word(times->words));
    }
    if (times == columns.end()) {
        times = std::ranges::find_if(columns, [](const auto& column) { return !column.of_words; });
    }
    if (times == columns.end()) options.fail(option, "{} needs a column of numbers", option);
    const std::vector<double> t = times->numbers;
    const auto gap = std::ranges::find_if(t, [](double x) { return std::isnan(x); });
    if (gap != t.end()) {
        options.fail(option, "{} needs a time in each row, and row {} of column '{}' is empty", option,
                     gap - t.begin() + 1, times->name);
    }
    std::vector<std::size_t> order(t.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return t[a] < t[b]; });
    std::vector<std::vector<std::size_t>> groups;
    for (const std::size_t row : order) {
        const bool joins = asked.duplicates != Duplicates::keep && !groups.empty() && t[groups.back().back()] == t[row];
        joins ? groups.back().push_back(row) : groups.push_back({row});
    }
    if (!asked.sort) {
        std::ranges::sort(groups, [](const auto& a, const auto& b) { return a.front() < b.front(); });
    }
    take_groups(content, groups, asked.duplicates);
}

/// Pushes a run from the rows written by run:save.
int push_loaded_run(lua_State* L, files::Table content, model::Units units) {
    LuaRun run;
    run.comments = std::move(content.comments);
    run.units = std::move(units);
    motion::Run& result = run.result;
    result.computed = false;
    result.own_names = std::move(content.names);
    run.rows = lua::MemoryCharge(static_cast<std::size_t>(content.values.size()) * sizeof(double));
    result.rows = motion::Rows(std::move(content.values));
    if (const auto time = result.find("t"); time && result.size() > 0) {
        result.t_start = result.rows(0, *time);
        result.t_stop = result.rows(result.size() - 1, *time);
    }
    push_run(L, std::make_shared<const LuaRun>(std::move(run)));
    return 1;
}

bool has_column(const files::ReadColumns& content, std::string_view name) {
    return text::contains(content.columns, name, &files::ReadColumn::name);
}

/// In a table of t and theta, the number of the first row that is earlier than the one before.
std::optional<std::size_t> earlier_row(const files::ReadColumns& content) {
    if (!has_column(content, "theta")) return {};
    for (const files::ReadColumn& column : content.columns) {
        const auto end = std::is_sorted_until(column.numbers.begin(), column.numbers.end());
        if (column.name == "t" && end != column.numbers.end()) {
            return static_cast<std::size_t>(end - column.numbers.begin()) + 1;
        }
    }
    return {};
}

/// Pushes data. Comments of run:save declare units; its columns may begin with the names of bodies.
int push_loaded_data(lua_State* L, files::ReadColumns content) {
    const ColumnUnits in(model::Units::from_file(content.comments));
    Data data;
    if (content.cut > 0) {
        const std::size_t rows = content.columns.front().of_words ? content.columns.front().words.size()
                                                                  : content.columns.front().numbers.size();
        data.heading = fmt::format("data: {}; line {} of the file ends in the middle and was left out",
                                   text::counted(rows, "row"), content.cut);
    }
    if (const auto row = earlier_row(content); row && data.heading.empty()) {
        data.heading = fmt::format("data: {}; row {} is earlier than the one before: sort = true puts them in order",
                                   text::counted(content.columns.front().numbers.size(), "row"), *row);
    }
    for (files::ReadColumn& column : content.columns) {
        if (column.unit.empty()) column.unit = in.of(column.name);
        data.columns.push_back(column_of(std::move(column)));
    }
    return push_data(L, std::move(data));
}

/// Returns whether the file is a run: it has the comments of run:save, or times and angles of one body, no gaps, and
/// times that do not decrease.
bool is_run(const files::ReadColumns& content) {
    const auto finite = [](const files::ReadColumn& column) { return column.fault.empty(); };
    const bool only_one_body = std::ranges::none_of(
        content.columns, [](const auto& column) { return column.name.find('.') != std::string::npos; });
    const bool saved = only_one_body && !content.comments.empty() && content.comments.front().starts_with("-- dinal ");
    return (saved || (has_column(content, "t") && has_column(content, "theta"))) &&
           std::ranges::all_of(content.columns, finite) && !earlier_row(content);
}

/// The units in the line of units; default units without one.
model::Units units_of(const files::ReadColumns& content) {
    model::Units units = model::Units::from_file(content.comments);
    for (const files::ReadColumn& column : content.columns) {
        for (const auto& [name, unit] : {std::pair{"theta", &units.theta}, {"t", &units.t}, {"M", &units.M}}) {
            if (column.name == name && !column.unit.empty()) *unit = column.unit;
        }
    }
    return units.complaint() ? model::Units{} : units;
}

int load_file(lua_State* L, const std::string& file) {
    const lua::Options options(L, 2, load_call);
    LoadOptions asked;
    options.fill(asked);
    files::ReadOptions reading{.skip = asked.skip};
    if (options.has("names")) {
        options.push("names");
        const auto count = static_cast<lua_Integer>(lua_istable(L, -1) ? lua_rawlen(L, -1) : 0);
        if (count == 0) options.wrong("names");
        for (lua_Integer i = 1; i <= count; ++i) {
            if (lua_rawgeti(L, -1, i) != LUA_TSTRING) options.wrong("names");
            reading.names.emplace_back(lua::text_at(L, -1));
            lua_pop(L, 1);
        }
        lua_pop(L, 1);
    }
    if (text::ending_of(file) == ".dat") {
        for (const text::Option& option : load_options) {
            if (!options.has(option.name)) continue;
            options.fail(option.name, "the record of 1989 (.dat) has no {}: its six columns are known", option.name);
        }
        auto record = files::read_record1989(file);
        if (lua::interrupt_requested()) lua::raise_interrupted(L);  // the file was read in part only
        return push_loaded_run(L, lua::value_or_raise(L, "load", std::move(record)), {});
    }
    auto read = files::read_columns(file, reading);
    if (lua::interrupt_requested()) lua::raise_interrupted(L);
    files::ReadColumns content = lua::value_or_raise(L, "load", std::move(read));
    arrange(options, asked, content);
    if (!is_run(content) || content.cut > 0) return push_loaded_data(L, std::move(content));
    model::Units units = units_of(content);
    return push_loaded_run(L, lua::value_or_raise(L, "load", files::table_of(std::move(content))), std::move(units));
}

/// The file extension of a text that is not Lua and may be a file name; otherwise "".
std::string ending_of_file(lua_State* L, std::string_view name) {
    constexpr std::size_t longest = 4096;
    const bool options = lua_gettop(L) == 2 && lua_type(L, 2) != LUA_TSTRING;
    const bool one = (lua_gettop(L) == 1 || options) && lua_type(L, 1) == LUA_TSTRING && name.size() < longest;
    std::string ending = one ? text::ending_of(name) : "";
    if (ending.empty()) return "";
    const int status = luaL_loadbufferx(L, name.data(), name.size(), "=load", "t");
    lua_pop(L, 1);
    return status == LUA_OK ? "" : ending;
}

bool is_one_of(std::string_view ending, std::initializer_list<std::string_view> known) {
    return text::contains(known, ending);
}

int load(lua_State* L) {
    const std::string name(lua_type(L, 1) == LUA_TSTRING ? lua::text_at(L, 1) : "");
    const std::string ending = ending_of_file(L, name);
    if (is_one_of(ending, {".csv", ".dat", ".txt", ".tsv"})) return load_file(L, name);
    if (is_one_of(ending, {".xlsx", ".xls", ".ods", ".mat", ".npy", ".json", ".h5", ".parquet"})) {
        lua::raise(L,
                   {.sentence = fmt::format("load reads CSV files, not {}: save the table as CSV in the program that "
                                            "made it",
                                            ending),
                    .call = "load",
                    .culprit = name});
    }
    lua_rawgetp(L, LUA_REGISTRYINDEX, &original_key);
    const lua_CFunction original = lua_tocfunction(L, -1);
    lua_pop(L, 1);
    return original(L);
}

constexpr lua::Member load_members[] = {
    {lua::a_function<load>,
     {"load(file, { OPTIONS }) -> run or data",
      "Reads a file that dinal has written, or any CSV file; the name ends in .csv, .txt, .tsv or .dat (the record "
      "of 1989). A file of run:save gives a run with the same bits, as does a table of numbers with the columns t "
      "(not decreasing) and theta; everything else gives data.\nFields are separated by semicolons, commas, tabs or "
      "blanks. Names are in the first line (without them they are \"1\", \"2\", ...), lines with # are skipped. "
      "Numbers may be among the names, t,100,200, if the first is a word and has only numbers below it. A column with "
      "anything but numbers, nan and empty fields (nan) is one of words. A line of words between the names and the "
      "numbers has the units of the columns. In a file with semicolons or tabs 1,5 is a number, and 1.5D+00 is one "
      "everywhere; in quotes \"1,5\" is one too, and any number if all fields are. A last line that ends in the "
      "middle is left out, as the data says. With other arguments it is Lua's own load.",
      "run = nondimensional{}:simulate{ theta0 = 1, t_end = 1.2, dt = 0.1 }\n"
      "file = os.tmpname() .. \".csv\"\n"
      "run:save(file)\n"
      "print(load(file).theta == run.theta)  --> true\n"
      "run.events:save(file)\n"
      "d = load(file)\n"
      "print(#d, d.kind[1], d.t == run.events.t)  --> 2\tturn\ttrue\n"
      "f = io.open(file, \"w\")\n"
      "f:write(\"Logger 7\\nt;x\\ns;mm\\n0,2;4\\n0,1;2\\n0,1;3\\n\")\n"
      "f:close()\n"
      "d = load(file, { skip = 1, sort = true, duplicates = \"mean\" })\n"
      "print(d.t, d.x, d.units.x)  --> vector{ 0.1, 0.2 }\tvector{ 2.5, 4 }\tmm\n"
      "os.remove(file)",
      {&load_call}}},
};

void add_load(lua_State* L, const lua::Class& functions) {
    lua_getglobal(L, "load");
    lua_rawsetp(L, LUA_REGISTRYINDEX, &original_key);
    lua::add_functions(L, functions);
}

}  // namespace

const lua::Class load_functions = {
    "load",
    {"load(file) -> run or data", "Reads files.", "print(select(2, pcall(load, \"missing.csv\")) ~= nil)  --> true"},
    load_members,
    add_load};

}  // namespace dinal::api
