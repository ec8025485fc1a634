// run:explain(): the run told in sentences.
#include "analysis/explain.hpp"
#include "api/run.hpp"

namespace dinal::api {

int explain_run(lua_State* L) {
    const Run& run = *lua::self<RunHandle>(L, 1, "run:explain()");
    const std::string text = run.origin ? analysis::explain(run.trajectory, run.origin->system, run.origin->excitation,
                                                            run.origin->integrator)
                                        : analysis::explain_rows(run.trajectory);
    lua_pushlstring(L, text.data(), text.size());
    return 1;
}

}  // namespace dinal::api
