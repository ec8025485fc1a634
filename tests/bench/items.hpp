// The groups of benchmarks that one program registers.
#pragma once

#include "results.hpp"

namespace bench {

void register_workloads(Results& results);  ///< W1-W4: peers and dinal
void register_work(Results& results);       ///< what work.lua lists

}  // namespace bench
