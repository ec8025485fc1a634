// The list of everything that Lua sees. A new class is a bind_*.cpp, a line in both lists here, and its tests.
#include "help/library.hpp"

#include "api/classes.hpp"
#include "errors/error_remarks.hpp"
#include "help/help_text.hpp"
#include "lab/lab_course.hpp"
#include "lab/report.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/standard_globals.hpp"
#include "lua/worker_state.hpp"
#include "sweep/sweep_run.hpp"
#include "text/version.hpp"

namespace dinal::help {

namespace {

constexpr void (*register_functions[])(lua_State*) = {
    api::register_system, api::register_friction, api::register_spring,   api::register_excitation,
    api::register_run,    api::register_energy,   api::register_load,     api::register_theory,
    api::register_vector, api::register_data,     api::register_progress, api::register_plot,
    api::register_steady, api::register_identify, sweep::register_sweep,  api::register_integrator,
    lab::register_lab,    lab::register_report,   register_help,
};

// Plain fields of the table: documented here, set by open_library() and sys:simulate.
constexpr lua::Member library_members[] = {
    {{nullptr, lua::Kind::field},
     {"dinal.partial -> run, data or nil",
      "The finished part of the last run that Ctrl-C or an error in M stopped: a run like any other. Of a sweep "
      "stopped by Ctrl-C, the finished points.",
      "pcall(function()\n"
      "    nondimensional{}:simulate{ M = function(t) assert(t < 0.5) return 1 end, t_end = 1, dt = 0.1 }\n"
      "end)\n"
      "print(#dinal.partial)  --> 5"}},
    {{nullptr, lua::Kind::field},
     {"dinal.on_interrupt",
      "A function of yours that is called with dinal.partial (or nil) when Ctrl-C ends a script, to save or print "
      "it. pcall does not catch Ctrl-C. Not called at the prompt and in notebooks.",
      "dinal.on_interrupt = function(partial) if partial then partial:save(\"partial.csv\") end end"}},
    {{nullptr, lua::Kind::field},
     {"dinal.version -> string", "The version of the program.",
      "print(dinal.version == \"" DINAL_VERSION "\")  --> true"}},
};

const lua::Class library_class = {
    "dinal",
    {"dinal.NAME, or NAME alone",
     "The table of all names of dinal. Its members are also globals, which you may overwrite, except the "
     "following ones.",
     "print(dinal.system == system)  --> true"},
    library_members};

const Section all_sections[] = {
    {"Systems", "", &api::system_functions},
    {"A system", "sys", &api::system_class},
    {"Laws of friction", "friction", &api::friction_module},
    {"A law of friction", "law", &api::friction_class},
    {"Springs", "spring", &api::spring_module},
    {"A spring", "spring", &api::spring_class},
    {"Excitations", "excitation", &api::excitation_module},
    {"An excitation", "e", &api::excitation_class},
    {"Integrators", "integrator", &api::integrator_module},
    {"An integrator", "integrator", &api::integrator_class},
    {"A run", "run", &api::run_class},
    {"A steady motion", "s", &api::steady_class},
    {"The energy of a run", "energy", &api::energy_class},
    {"Files", "", &api::load_functions},
    {"Theory", "theory", &api::theory_module},
    {"Vectors", "vector", &api::vector_module},
    {"A vector", "v", &api::vector_class},
    {"Data", "data", &api::data_module},
    {"Named columns", "d", &api::data_class},
    {"Identification", "", &api::identify_functions},
    {"A fit", "fit", &api::fit_class},
    {"Sweeps", "", &sweep::sweep_functions},
    {"Reports", "", &lab::report_functions},
    {"A report", "r", &lab::report_class},
    {"Progress", "", &api::progress_functions},
    {"Plots", "", &api::plot_functions},
    {"A picture", "picture", &api::picture_class},
    {"The lab", "lab", &lab::lab_module},
    {"Answers in the lab", "", &lab::check_functions},
    {"Help", "", &help_functions},
    {"The table dinal", "dinal", &library_class},
};

// dinal.partial is nil until a run fails, so it must not be an unknown name.
int unknown_name(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING || std::string_view(lua_tostring(L, 2)) == "partial") {
        return 0;
    }
    const std::string_view wrong = lua_tostring(L, 2);
    lua::raise(L, {.sentence = "there is no dinal." + std::string(wrong),
                   .call = "dinal",
                   .culprit = std::string(wrong),
                   .cure = text::did_you_mean(wrong, lua::text_keys(L, 1))});
}

}  // namespace

std::span<const Section> sections() {
    return all_sections;
}

void open_library(lua_State* L) {
    lua::set_library(open_library);  // for workers of a sweep
    lua::set_witness(L, errors::first_remarks);
    lua::open_coroutines(L);
    lua::open_terminal_output(L);
    lua::make_dinal_table(L);
    for (const auto add : register_functions) {
        add(L);
    }
    lua_pushglobaltable(L);
    lua::copy_fields(L);
    lua_pop(L, 1);
    lua::note_standard_globals(L);
    lua_newtable(L);
    lua_pushcfunction(L, lua::guarded<unknown_name>);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
    lua_pushliteral(L, DINAL_VERSION);
    lua_setfield(L, -2, "version");
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
    lua_pushvalue(L, -2);
    lua_setfield(L, -2, "dinal");
    lua_pop(L, 1);
    lua_setglobal(L, "dinal");
}

}  // namespace dinal::help
