// run:save(file): which kind of file, which columns, and the comment block that lets the run be repeated.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "api/run.hpp"
#include "files/csv.hpp"
#include "files/record1989.hpp"
#include "lua/options.hpp"
#include "lua/worker_state.hpp"
#include "text/words.hpp"

namespace dinal::api {

namespace {

/// The columns asked for by `columns = { name or number, ... }`, all without it.
std::vector<files::NamedColumn> asked_columns(lua_State* L, const lua::Options& options,
                                              const motion::Trajectory& trajectory) {
    std::vector<files::NamedColumn> all = files::named_columns(trajectory.names(), trajectory.rows.matrix());
    if (!options.has("columns")) {
        return all;
    }
    options.push("columns");
    if (!lua_istable(L, -1) || lua_rawlen(L, -1) == 0) {
        options.wrong("columns", options.row("columns").wanted);
    }
    std::vector<files::NamedColumn> asked;
    for (lua_Integer i = 1; i <= static_cast<lua_Integer>(lua_rawlen(L, -1)); ++i) {
        lua_rawgeti(L, -1, i);
        const auto column = column_at(L, -1, trajectory.names(), fmt::format("columns[{}]", i));
        asked.push_back(all[static_cast<std::size_t>(options.value_or_fail(column))]);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return asked;
}

text::Expected<files::Written> write_record(const std::string& file, const Run& run) {
    if (run.origin) {
        return files::write_record1989(file, run.trajectory, run.origin->system);
    }
    if (run.trajectory.names() == files::record1989_names()) {
        return files::write_record1989(file, run.trajectory.rows.matrix());
    }
    return text::Error{"a .dat file needs the system, which a run read from a file does not have; save it as .csv"};
}

text::Expected<files::Written> write(lua_State* L, const lua::Options& options, const std::string& file,
                                     const Run& run) {
    const std::string ending = text::ending_of(file);
    if (ending == ".csv") {
        return files::write_csv(file, asked_columns(L, options, run.trajectory),
                                run.origin ? source::repeat_lines(*run.origin) : run.comments);
    }
    if (ending != ".dat") {
        return text::Error{.sentence = fmt::format(
                               "the name '{}' must end in .csv (names and numbers) or .dat (the record of 1989)", file),
                           .culprit = file};
    }
    if (options.has("columns")) {
        return text::Error{
            .sentence = "the record of 1989 always has its six columns; save a choice of columns as .csv",
            .option = "columns"};
    }
    return write_record(file, run);
}

}  // namespace

int save_run(lua_State* L) {
    lua::refuse_in_worker(L, "run:save");
    const RunHandle run = lua::self<RunHandle>(L, 1, "run:save(\"run.csv\")");
    if (lua_type(L, 2) != LUA_TSTRING) {
        lua::raise_got(L, 2, "run:save", "run:save: the name of the file must be a string",
                       fmt::format("; for example {}", save_call.example));
    }
    const std::string file = lua_tostring(L, 2);
    const lua::Options options(L, 3, save_call);
    options.value_or_fail(write(L, options, file, *run));
    return 0;
}

}  // namespace dinal::api
