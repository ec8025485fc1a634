// A sweep from the call to its results: what was broken off before, the workers, Ctrl-C.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/sweep_files.hpp"
#include "api/sweep_options.hpp"
#include "api/sweep_results.hpp"
#include "lua/options.hpp"

namespace dinal::api {

struct SweepTask {
    const char* call;  ///< heads sentences
    const SweepGrid& grid;
    int function;  ///< its index on the stack
    std::optional<double> workers = {};
    double seed = 0;
    std::string file = {};              ///< none: it is not kept, and not shared with other processes
    double max_time = 0;                ///< seconds of a point; 0: any
    std::vector<double> settings = {};  ///< what else decides about the results
    /// In the state of a worker: replaces the carried function on the top by the one that is asked.
    std::function<void(lua_State* worker)> adapt = {};
    /// The results so far as data.
    std::function<Data(const SweepGrid& grid, const SweepResults& results)> told;
    /// Where the file has other rows than points: takes the results from its columns; false when they are none.
    TakeColumns taken = {};
};

/// An error of the call when the name of the file is none, or several processes would all do all of it.
void check_file_of_sweep(const lua::Options& options, const SweepOptions& asked);

/// All points. Raises when all of them fail; after Ctrl-C, when what is done is in dinal.partial, and the same task
/// goes on from there. With a file, and as one of several processes of a launcher, it does its share, and ends the
/// program unless it was the last.
std::shared_ptr<SweepResults> swept(lua_State* L, const SweepTask& task);

/// What the first line of the data says when points have failed: nobody looks into a column that should be empty.
std::string heading_of_map(const SweepGrid& grid, const SweepResults& results);

void register_unfinished_sweep(lua_State* L);

}  // namespace dinal::api
