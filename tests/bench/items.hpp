// The groups of benchmarks that one program registers.
#pragma once

#include "results.hpp"

namespace bench {

void register_workloads(Results& results);     ///< W1-W4: peers and dinal
void register_closed_forms(Results& results);  ///< exact with many samples and many harmonics
void register_analysis(Results& results);      ///< steady motions, sweeps, a response, a fit
void register_rows(Results& results);          ///< rows kept in memory, rows written to a file
void register_lua(Results& results);           ///< M(t) in Lua
void register_systems(Results& results);       ///< controllers with a memory, friction laws, jumps, short runs
void register_plots(Results& results);         ///< pictures of many rows
void register_start(Results& results);         ///< the program as a process

}  // namespace bench
