// The contents of a run object: the result and its origin.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lua/memory_limit.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "lua/values.hpp"
#include "model/units.hpp"
#include "motion/between_rows.hpp"
#include "motion/run.hpp"
#include "source/origin.hpp"

namespace dinal::api {

struct MoreTime;
struct Data;

struct LuaRun {
    motion::Run result;
    std::shared_ptr<const source::Origin> origin = {};  ///< null if it was read from a file
    std::vector<std::string> comments = {};             ///< comments of that file
    std::optional<model::Excitation> terms = {};        ///< M as native terms, if its functions could be read
    std::string readings = {};                          ///< sentences on functions that were read as formulas
    model::Units units = {};                            ///< from a file; a simulated run has those of its system
    lua::MemoryCharge rows = {};                        ///< memory of rows read from a file
    std::optional<std::size_t> joint = {};              ///< the named body or link that this view shows
    std::shared_ptr<const LuaRun> whole = {};           ///< the run of all bodies, if this is a view
    // The run as seen from each joint, made on demand. Weak, as these keep the run of all bodies.
    mutable std::vector<std::weak_ptr<const LuaRun>> parts = {};

    const model::System& system() const { return *origin->system; }
    /// Returns whether it is the run of a named system as a whole.
    bool of_all() const { return origin != nullptr && system().named && !joint; }
    /// The index of its joint in the system.
    std::size_t place() const { return joint.value_or(0); }
    /// Returns whether this is a simulated run of one body.
    bool of_body() const { return origin != nullptr && !of_all() && !system().is_link(place()); }
};

/// Sets up calls of user functions of a run, which receive the motion by the names of its bodies and states.
class RunCall : public lua::CallState {
public:
    RunCall(lua_State* L, const LuaRun& run);
};

// Shared: every column in Lua is a view that keeps the whole run alive.
using RunHandle = std::shared_ptr<const LuaRun>;

void push_run(lua_State* L, RunHandle run);

/// The column whose name or number is at `index`; errors name it `what`.
text::Expected<Eigen::Index> column_at(lua_State* L, int index, std::span<const std::string> names,
                                       std::string_view what);

/// The motion between the rows; keeps a reference to the run. Evaluating it may call user functions.
motion::BetweenRows between_rows(const LuaRun& run);

/// The run with rows close enough for a picture, within `window` if given; the run itself if it kept only its rows.
/// Raises an error if M fails.
std::shared_ptr<const motion::Run> drawn_run(lua_State* L, const RunHandle& run,
                                             const std::vector<double>& window = {});

/// The rows as data, which keep the run alive.
Data rows_of(const RunHandle& run);

/// Raises an error that `member`, written as ".theta" or ":cycle", needs one body or link, if the run has several.
void check_one(lua_State* L, const LuaRun& run, std::string_view member);

/// The body or link that the run shows, as an oscillator; none for all bodies, or for a run read from a file.
std::optional<model::Oscillator> alone(const LuaRun& run);

/// The run as seen from this joint; the run itself if it is already seen from one or has a single unnamed body.
std::shared_ptr<const LuaRun> part_of(const std::shared_ptr<const LuaRun>& run, std::size_t joint);

/// The runs as seen from each body and link that add up to this one.
std::vector<RunHandle> parts_of(const RunHandle& run);

/// Raises an error for a name that is neither known nor a member of the class.
[[noreturn]] void raise_unknown_name(lua_State* L, std::string sentence, std::string_view wrong,
                                     const std::vector<std::string>& known, const lua::Class& of);

/// The outcome of a run in one word.
std::string_view status_word(model::Outcome outcome);

/// tostring(run)
std::string line_of(const LuaRun& run);

/// The text of run:explain(); raises errors of a user's spring.
std::string story_of_run(lua_State* L, const RunHandle& handle);
/// Lua text that repeats the run, as lines; or the comments of the file from which it was read.
std::vector<std::string> repeat_lines(const LuaRun& run);
/// The requested t_end, or the last requested time; otherwise the end at which a stopped run should have ended.
double asked_end(const lua::Options& options, const MoreTime& asked, double stopped, double wanted);

/// run:save(file [, { columns = { "t", "theta" } }]).
inline constexpr text::Option save_options[] = {
    {.name = "columns",
     .meaning = "only these, for a .csv: names or numbers of columns",
     .wanted = "a list such as { \"t\", \"theta\" }"},
};
inline constexpr text::Call save_call{"run:save", "run:save(\"run.csv\", { columns = { \"t\", \"theta\" } })",
                                      save_options, true};
int save_run(lua_State* L);
/// run:continue{ t_end }.
int continue_run(lua_State* L);
/// run:explain() of a simulated run, and run:energy(); both are defined in bind_energy.cpp.
std::string story_of_simulated(lua_State* L, const RunHandle& run);
lua::Pushed energy_of_run(lua_State* L, const RunHandle& run);
/// run:at(t), run.states and run.acceleration.
int run_at(lua_State* L);
lua::Pushed run_acceleration(lua_State* L, const RunHandle& run);
lua::Pushed run_states(lua_State* L, const RunHandle& run);

// The option `units` of systems, runs and pictures, and the units derived from it.

/// The units in the option; none if absent.
std::optional<model::Units> asked_units(lua_State* L, const lua::Options& options);

/// The units of the run's system, or those in the file from which it was read.
const model::Units& units_of(const LuaRun& run);

/// The walls by name, without absent ones; none without walls.
std::optional<lua::NamedNumbers> walls_by_name(const std::optional<model::Walls>& walls);

/// Unit names by "theta", "t" and "M"; empty ones omitted.
std::map<std::string, std::string> units_by_name(const model::Units& units);

}  // namespace dinal::api
