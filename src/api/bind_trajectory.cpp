// trajectory.load(file): what run:save has written, or any other table of numbers, as a run.
#include <algorithm>
#include <cctype>

#include "api/classes.hpp"
#include "api/run.hpp"
#include "files/csv.hpp"
#include "files/record1989.hpp"
#include "lua/interrupt.hpp"
#include "text/words.hpp"

namespace dinal::api {

namespace {

text::Expected<files::Table> read(const std::string& file) {
    if (text::ending_of(file) == ".dat") {
        return files::read_record1989(file);
    }
    if (text::ending_of(file) == ".csv") {
        return files::read_csv(file);
    }
    return text::Error{
        .sentence = "the name '" + file + "' must end in .csv (names and numbers) or .dat (the record of 1989)",
        .culprit = file};
}

int load(lua_State* L) {
    if (lua_type(L, 1) != LUA_TSTRING) {
        lua::raise_got(L, 1, "trajectory.load", "trajectory.load: the name of the file must be a string");
    }
    auto table = read(lua_tostring(L, 1));
    if (lua::interrupt_requested()) {
        lua::raise_interrupted(L);  // what was read is not all
    }
    files::Table content = lua::value_or_raise(L, "trajectory.load", std::move(table));
    Run run;
    run.comments = std::move(content.comments);
    run.units = model::Units::from_file(run.comments);
    motion::Trajectory& trajectory = run.trajectory;
    trajectory.computed = false;
    trajectory.own_names = std::move(content.names);
    run.rows = lua::MemoryCharge(static_cast<std::size_t>(content.values.size()) * sizeof(double));
    trajectory.rows = motion::Rows(std::move(content.values));
    if (const auto time = trajectory.find("t"); time && trajectory.size() > 0) {
        trajectory.t_start = trajectory.rows(0, *time);
        trajectory.t_stop = trajectory.rows(trajectory.size() - 1, *time);
    }
    push_run(L, std::make_shared<const Run>(std::move(run)));
    return 1;
}

constexpr lua::Member trajectory_module_members[] = {
    {lua::a_function<load>,
     {"trajectory.load(file) -> run",
      "Reads file.csv or file.dat (the record of 1989) back: the same numbers to the last bit, with the columns of the "
      "file as fields. Those of a .dat file are t, theta, velocity_over_omega0, M_over_k, friction_over_k, "
      "damping_over_k.",
      "run = nondimensional{}:simulate{ theta0 = 1, t_end = 1, dt = 0.25 }\n"
      "file = os.tmpname() .. \".dat\"\n"
      "run:save(file)\n"
      "old = trajectory.load(file)\n"
      "print(#old, old.theta == run.theta)  --> 5\ttrue\n"
      "os.remove(file)"}},
};

}  // namespace

const lua::Class trajectory_module = {"trajectory",
                                      {"trajectory.load(file) -> run", "Runs that were saved.",
                                       "print(select(2, pcall(trajectory.load, \"missing.csv\")) ~= nil)  --> true"},
                                      trajectory_module_members};

void register_trajectory(lua_State* L) {
    lua::add_module(L, trajectory_module);
}

}  // namespace dinal::api
