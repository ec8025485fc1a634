// What a run object in Lua holds: the trajectory, and where it came from.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lua/memory_limit.hpp"
#include "lua/options.hpp"
#include "lua/values.hpp"
#include "model/units.hpp"
#include "motion/between_rows.hpp"
#include "motion/trajectory.hpp"
#include "source/origin.hpp"

namespace dinal::api {

struct MoreTime;
struct Data;

struct Run {
    motion::Trajectory trajectory;
    std::shared_ptr<const source::Origin> origin = {};  ///< none when it was read from a file
    std::vector<std::string> comments = {};             ///< of the file it was read from
    std::optional<model::Excitation> terms = {};        ///< M as the native terms that its functions were read as
    std::string readings = {};                          ///< which functions were read as formulas: sentences
    model::Units units = {};                            ///< that stand in these; of another run those of its system
    lua::MemoryCharge rows = {};                        ///< of the file it was read from
    std::optional<std::size_t> joint = {};              ///< the body or link with a name that it is seen from
    // As seen from each joint, made when it is asked for. Not kept: they keep the run of all bodies.
    mutable std::vector<std::weak_ptr<const Run>> parts = {};

    [[nodiscard]] const model::System& system() const { return *origin->system; }
    /// Its system has names, and it is seen from none of its bodies and links.
    [[nodiscard]] bool of_all() const { return origin != nullptr && system().named && !joint; }
    /// The place of the joint among those of the system.
    [[nodiscard]] std::size_t place() const { return joint.value_or(0); }
    /// It was simulated, and is that of a body.
    [[nodiscard]] bool of_body() const { return origin != nullptr && !of_all() && !system().is_link(place()); }
};

// Shared, because every column that Lua takes out of a run is a view that keeps the whole run alive.
using RunHandle = std::shared_ptr<const Run>;

/// The new run as a Lua object on the top of the stack.
void push_run(lua_State* L, RunHandle run);

/// The column whose name or number stands at `index`; an error names it `what`.
text::Expected<Eigen::Index> column_at(lua_State* L, int index, std::span<const std::string> names,
                                       std::string_view what);

/// The motion between the rows; keeps a reference to the run. Evaluating it may call functions of the user.
motion::BetweenRows between_rows(const Run& run);

/// The run with rows as close as a picture needs them, within two times if some are given; the run itself where it kept
/// only its rows. Raises when M does.
std::shared_ptr<const motion::Trajectory> drawn_trajectory(lua_State* L, const RunHandle& run,
                                                           const std::vector<double>& window = {});

/// The rows as data, which keep the run.
Data rows_of(const RunHandle& run);

/// Raises that `member`, written as ".theta" or ":cycle", is of one body or link, if the run is that of several.
void check_one(lua_State* L, const Run& run, std::string_view member);

/// The body or link that it is seen from, by itself; none of all bodies, and of a run that was read from a file.
std::optional<model::Oscillator> alone(const Run& run);

/// The run as seen from this body or link: itself where it is seen from one already, or has one body without a name.
std::shared_ptr<const Run> part_of(const std::shared_ptr<const Run>& run, std::size_t joint);

/// The runs, as seen from each of its bodies and links, that make up this one.
std::vector<RunHandle> parts_of(const RunHandle& run);

/// Raises the sentence about a name that is none of the known ones nor of the members of the class.
[[noreturn]] void raise_unknown_name(lua_State* L, std::string sentence, std::string_view wrong,
                                     const std::vector<std::string>& known, const lua::Class& of);

/// How a run ended, in one word.
std::string_view status_word(model::Outcome outcome);

/// tostring(run)
std::string line_of(const Run& run);

/// What run:explain() says; raises what a user's spring does.
std::string story_of_run(lua_State* L, const RunHandle& handle);
/// Lua text that makes the run again, as lines, or the comments of the file that it was read from.
std::vector<std::string> repeat_lines(const Run& run);
/// The t_end that is asked for, the last of the times, or where a run that stopped should have ended.
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
/// run:explain() of what was simulated, and run:energy(), in bind_energy.cpp.
std::string story_of_simulated(lua_State* L, const RunHandle& run);
lua::Pushed energy_of_run(lua_State* L, const RunHandle& run);
/// run:at(t), run.states and run.acceleration.
int run_at(lua_State* L);
lua::Pushed run_acceleration(lua_State* L, const RunHandle& run);
lua::Pushed run_states(lua_State* L, const RunHandle& run);

// The option `units` of a system, a run and its pictures, and the units of what comes of them.

/// What it says; none when it is absent.
std::optional<model::Units> asked_units(lua_State* L, const lua::Options& options);

/// Those of its system, or those that stand in the file that it was read from.
const model::Units& units_of(const Run& run);

/// Their numbers by name, without a wall that is none; none without walls.
std::optional<lua::NamedNumbers> walls_by_name(const std::optional<model::Walls>& walls);

/// Those that have a name, by "theta", "t" and "M".
std::map<std::string, std::string> units_by_name(const model::Units& units);

}  // namespace dinal::api
