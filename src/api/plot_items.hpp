// The list part of plot{ ... }: curves made of vectors, runs, or pictures to set side by side.
#pragma once

#include <vector>

#include "api/run.hpp"
#include "lua/lua_headers.hpp"
#include "plots/figure.hpp"

namespace dinal::api {

struct PlotItems {
    std::vector<plots::Curve> curves = {};
    std::vector<plots::Figure> panels = {};  ///< of pictures
    RunHandle run = {};                      ///< the first one, when each of the curves is theta over t of a run
};

/// Raises when something in the list of the table at `table` is none of these.
PlotItems plot_items(lua_State* L, int table);

/// Copies the table at `from` without its first `listed` places to a new table on the top, where Options can check it.
void push_named(lua_State* L, int from, lua_Integer listed);

}  // namespace dinal::api
