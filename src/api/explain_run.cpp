// run:explain(): the run told in sentences.
#include "analysis/explain.hpp"
#include "api/run.hpp"

namespace dinal {

int explain_run(lua_State* L) {
    const Run& run = *self<RunHandle>(L, 1, "run:explain()");
    const std::string text =
        run.origin ? explain(run.trajectory, run.origin->system, run.origin->excitation, run.origin->integrator)
                   : explain_rows(run.trajectory);
    lua_pushlstring(L, text.data(), text.size());
    return 1;
}

}  // namespace dinal
