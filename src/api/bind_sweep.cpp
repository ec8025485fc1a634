// sweep{ ... }: a function of a point asked at all points of a grid, by several threads.
#include "api/bifurcation.hpp"
#include "api/classes.hpp"
#include "api/sweep_options.hpp"
#include "api/sweep_parameters.hpp"
#include "api/sweep_run.hpp"

namespace dinal::api {
namespace {

Data map_of(const SweepGrid& grid, const SweepResults& results) {
    Data map = results.data(grid, results.done_points());
    map.heading = heading_of_map(grid, results);
    for (const DataColumn& parameter : grid.parameters()) map.parameters.push_back(parameter.name);
    return map;
}

int sweep(lua_State* L) {
    std::vector<DataColumn> parameters = take_parameters(L, sweep_call);
    const lua::Options options(L, 1, sweep_call);
    SweepOptions asked;
    options.fill(asked);
    const int function = push_function(L, options, "run");
    check_parameters(L, sweep_call, parameters);
    check_file_of_sweep(options, asked);
    const SweepGrid grid(std::move(parameters));
    const auto results = swept(L, {.call = sweep_call.name,
                                   .grid = grid,
                                   .function = function,
                                   .workers = asked.workers,
                                   .seed = asked.seed,
                                   .file = asked.file,
                                   .max_time = asked.max_time.value_or(0),
                                   .told = map_of});
    push_data(L, map_of(grid, *results));
    return 1;
}

constexpr lua::Member sweep_members[] = {
    {lua::a_function<sweep>, sweep_doc},
    {lua::a_function<bifurcation>, bifurcation_doc},
    {lua::a_function<minimise>, minimise_doc},
};

}  // namespace

const lua::Class sweep_functions = {
    "sweep",
    {"sweep{ ... } -> data", "Many points in parallel.",
     "print(#sweep{ over = { x = { 1, 2, 3 } }, run = function(p) return { y = p.x^2 } end })  --> 3"},
    sweep_members};

void register_sweep(lua_State* L) {
    register_unfinished_sweep(L);
    lua::add_functions(L, sweep_functions);
}

}  // namespace dinal::api
