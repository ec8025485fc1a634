#include "api/bind_simulate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "api/bind_excitation.hpp"
#include "api/bodies.hpp"
#include "api/classes.hpp"
#include "api/drive_options.hpp"
#include "api/lua_run.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/standard_globals.hpp"
#include "lua/user_function.hpp"
#include "model/controller.hpp"
#include "model/functions.hpp"
#include "model/springs.hpp"
#include "source/fingerprint.hpp"
#include "terminal/progress.hpp"

namespace dinal::api {

namespace {

/// The memory of the rows in bytes; 0 if window or grid is invalid, which simulate() reports.
std::size_t bytes_of_rows(const source::Task& task) {
    if (!(task.window.start < task.window.end)) {
        return 0;
    }
    const auto grid = task.rows.within(task.window);
    const std::size_t row = motion::columns_of(*task.system, task.drive) * sizeof(double);
    return grid ? std::min<std::size_t>(grid->count(), 1ULL << 40U) * row : 0;
}

/// The machine's memory in bytes, cached: the query takes a tenth of a short run.
std::optional<std::size_t> memory_of_machine() {
    static const std::optional<std::size_t> bytes = []() -> std::optional<std::size_t> {
        const long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
        if (!(pages > 0 && page_size > 0)) return std::nullopt;
        return static_cast<std::size_t>(pages) * static_cast<std::size_t>(page_size);
    }();
    return bytes;
}

/// The memory limits of a run: half of the machine's memory, and most of what the script has left.
motion::Limits limits_of_run(bool dense) {
    motion::Limits limits{.dense = dense};
    if (const auto machine = memory_of_machine()) limits.memory = *machine / 2;
    limits.memory = std::min(limits.memory, lua::memory_left() / 4 * 3);
    return limits;
}

/// The default of dt; `natural_period` is infinite if there is none.
double usual_dt(const motion::Window& window, double natural_period) {
    constexpr double rows_a_period = 40, least = 1e3, most = 1e5;
    const double length = window.end - window.start;
    return length / std::clamp(std::ceil(rows_a_period * length / natural_period), least, most);
}

/// The drive with M as native terms if its functions can be read; used for the choice of the integrator.
model::Drive drive_of_terms(lua_State* L, const source::Task& task) {
    model::Drive played = task.drive;
    if (auto terms = terms_alone(L, *task.system, task.drive, task.window.start, task.window.end)) {
        played.loads = {*terms};
    }
    return played;
}

source::Task asked_task(lua_State* L, const lua::Options& options, const RunOptions& asked,
                        const SystemHandle& system) {
    const auto* integrator = options.object<motion::Integrator>("integrator");
    source::Task task{.system = system,
                      .drive = asked_drive(L, options, *system),
                      .window = {.start = asked.t_start},
                      .rows = motion::Grid::at(asked.times),
                      .integrator = {}};
    if (!asked.t_end && asked.times.empty()) {
        options.missing("t_end");
    }
    // The latest, not the last time: decreasing times are a separate error.
    task.window.end = asked.t_end ? *asked.t_end : *std::max_element(asked.times.begin(), asked.times.end());
    task.integrator = integrator != nullptr ? *integrator
                      : system->is_alone()
                          ? motion::integrator_for(model::oscillator_at(*system, 0).value(), drive_of_terms(L, task))
                          : motion::Spectral{};
    if (!options.has("times") && task.window.end > task.window.start) {
        task.rows = motion::Grid::every(asked.dt.value_or(usual_dt(task.window, system->shortest_natural_period())));
    }
    return task;
}

/// A hash of the memory of M's functions, and of everything else they use.
std::uint64_t memory_of(lua_State* L, const model::Excitation& M) {
    source::Fingerprint print(L, [](lua_State*, int, source::Fingerprint&) { return false; });
    lua::push(L, M);
    print.add_value(-1);
    lua_pop(L, 1);
    return print.number();
}

/// Refuses sampled controllers that still have the memory of an earlier run, their own or a variable shared with
/// controllers of the last run: their outputs would depend on it.
class Memories {
public:
    Memories(lua_State* L, const lua::Options& options, const model::Excitation& M, bool goes_on)
        : L_(L), options_(options), M_(M), wanted_(model::has_memory<model::SampledController>(M)), goes_on_(goes_on) {
        if (!wanted_) return;
        before_ = memory_of(L, M);
        if (!goes_on && is_used(M, before_)) fail();
        lua_getfield(L, LUA_REGISTRYINDEX, last_run);
        if (const auto* last = lua::test<model::Excitation>(L, -1)) last_ = *last;
        lua_pop(L, 1);
        last_before_ = memory_of(L, last_);
    }
    void note(const void* run) const {
        if (!wanted_) return;
        const bool changed = memory_of(L_, M_) != before_;
        for (const model::Component& component : M_.components()) {
            const auto* sampled = model::controller_of<model::SampledController>(component);
            if (sampled == nullptr) continue;
            sampled->latest = run;
            if (changed) sampled->first = sampled->first.value_or(before_);
            if (changed && (sampled->carried || run == nullptr)) fail();
        }
        const bool shared = is_used(last_, last_before_) && memory_of(L_, last_) != last_before_;
        if (shared && !goes_on_) fail();
        lua::push(L_, M_);
        lua_setfield(L_, LUA_REGISTRYINDEX, last_run);
    }

private:
    static constexpr const char* last_run = "dinal.sampled";

    static bool is_used(const model::Excitation& M, std::uint64_t memory) {
        const auto& components = M.components();
        return std::any_of(components.begin(), components.end(), [&](const model::Component& component) {
            const auto* sampled = model::controller_of<model::SampledController>(component);
            return sampled != nullptr && sampled->first.value_or(memory) != memory;
        });
    }
    [[noreturn]] void fail() const {
        options_.fail("M",
                      "the function of excitation.sampled keeps a memory from one run to the next: keep it in "
                      "the table that start = function() return { e = 0 } end makes for each run, its fifth argument");
    }

    lua_State* L_;
    const lua::Options& options_;
    const model::Excitation& M_;
    model::Excitation last_;
    std::uint64_t before_ = 0, last_before_ = 0;
    bool wanted_, goes_on_;
};

}  // namespace

std::string readings_of(const model::System& system, const model::Drive& drive, bool located, bool native) {
    std::string all;
    const auto tell = [&](const std::string& name, const model::Excitation& excitation) {
        for (const model::Component& component : excitation.components()) {
            const auto* script = std::get_if<model::Scripted>(&component.term);
            if (script == nullptr) continue;
            const auto* function = dynamic_cast<const lua::LuaFunction*>(script->function.get());
            if (function == nullptr) continue;
            const model::Formula* read = function->formula();
            std::string reading;
            if (read == nullptr || read->gave_up()) {
                if (function->last_obstacle().empty()) continue;
                reading = fmt::format("{} is evaluated in Lua ({}).", name, function->last_obstacle());
            } else {
                const bool of_motion = read->has_conditions_of_motion();
                const char* conditions =
                    !read->has_conditions() ? ""
                    : !of_motion            ? ": the times at which its conditions change are events"
                    : located
                        ? ": the times at which its conditions change, also those on theta, velocity or states, are located"
                        : ": the times at which its conditions change are events, except for conditions on theta, velocity or states, which are sampled";
                reading =
                    fmt::format("{} is read as a {}{}.", name, native ? "sum of native terms" : "formula", conditions);
            }
            if (all.find(reading) == std::string::npos) all += (all.empty() ? "" : " ") + reading;
        }
    };
    const auto each = [&](const char* name, const std::vector<model::Excitation>& acting, const char* of) {
        for (std::size_t j = 0; j < acting.size(); ++j) {
            tell(acting.size() == 1 ? name : name + (of + system.joints[j].name), acting[j]);
        }
    };
    each("M", drive.loads, " of ");
    each("The belt", drive.belts, " under ");
    tell("The base", drive.base);
    return all;
}

bool reads_all_functions(const model::System& system, const model::Drive& drive, bool located) {
    bool all = true;
    const auto see = [&](const model::UserFunction& function) {
        if (dynamic_cast<const model::SampledController*>(&function) != nullptr) return;  // nothing between instants
        const auto* relay = dynamic_cast<const model::RelayController*>(&function);
        if (relay != nullptr && relay->function == nullptr) return;
        const auto* delayed = dynamic_cast<const model::DelayedController*>(&function);
        const auto* own = dynamic_cast<const lua::LuaFunction*>(relay != nullptr     ? relay->function.get()
                                                                : delayed != nullptr ? delayed->function.get()
                                                                                     : &function);
        const model::Formula* read = own == nullptr ? nullptr : own->formula();
        const bool sees_motion = located && relay == nullptr && delayed == nullptr;
        all = all && read != nullptr && !read->gave_up() && (sees_motion || !read->has_conditions_of_motion());
    };
    const auto see_in = [&](const std::optional<model::Excitation>& acting) {
        if (acting) acting->each_function(see);
    };
    for (const auto* acting : {&drive.loads, &drive.belts}) std::for_each(acting->begin(), acting->end(), see_in);
    see_in(drive.base);
    for (const model::OwnState& state : drive.states) see(*state.rate);
    for (const model::WantedEvent& event : drive.events) see(*event.when);
    for (const model::Body& body : system.bodies) {
        if (body.moved) see_in(body.moved->motion);
    }
    for (const model::Joint& joint : system.joints) {
        if (const auto* spring = joint.spring.as<model::springs::UserSpring>()) see(*spring->function);
        if (const auto* law = model::user_law(joint.friction.law)) see(*law->function);
        if (joint.friction.function != nullptr) see(*joint.friction.function);
        see_in(joint.friction.normal);
        for (const auto* varying : {&joint.friction.sliding, &joint.friction.holding}) {
            std::for_each(varying->begin(), varying->end(), see_in);
        }
    }
    return all;
}

std::function<void(const void*)> watched_memories(lua_State* L, const lua::Options& options, const model::Excitation& M,
                                                  bool goes_on) {
    const auto memories = std::make_shared<const Memories>(L, options, M, goes_on);
    return [memories](const void* run) { memories->note(run); };
}

int run_task(lua_State* L, const lua::Options& options, source::Origin origin, double from, bool dense,
             const Compute& compute) {
    if (lua::memory_limit() > 0) lua::make_room(L, bytes_of_rows(origin));
    const double to = origin.window.end;
    const auto run = std::make_shared<LuaRun>();
    run->origin = std::make_shared<const source::Origin>(std::move(origin));
    const motion::Limits limits = limits_of_run(dense);
    const source::Task& asked = *run->origin;
    const model::System& system = *asked.system;
    if (system.is_alone() && std::holds_alternative<motion::Exact>(asked.integrator)) {
        run->terms = terms_alone(L, system, asked.drive, asked.window.start, to);
    }

    const model::Excitation loads = asked.drive.sum_of_loads();
    const Memories memories(L, options, loads, from != asked.window.start);
    lua::CallState call(L);
    name_functions(call, system, asked.drive);
    call.set_span(to - from);
    terminal::Progress progress = terminal::Progress::of_time(from, to);
    const auto monitor = [&progress](double t) {
        progress.advance(t);
        return !lua::interrupt_requested();
    };
    source::Task played = asked;
    if (run->terms) played.drive.loads = {*run->terms};
    run->result = options.value_or_fail(compute(played, monitor, limits));
    if (call.failed() && lua::interrupt_requested()) {
        run->result.outcome = model::Outcome::interrupted;  // M was stopped, it did not fail
    }
    run->readings = readings_of(system, asked.drive, run->result.located, run->terms.has_value());
    if (reads_all_functions(system, asked.drive, run->result.located)) run->result.gap = run->result.unproven;
    const bool interrupted = run->result.outcome == model::Outcome::interrupted;
    push_run(L, run);
    memories.note(run.get());
    if (call.failed() || interrupted) {
        set_partial(L);
        call.failed() ? call.raise_error() : lua::raise_interrupted(L);
    }
    return 1;
}

int simulate_system(lua_State* L) {
    SystemHandle handle = lua::self<SystemHandle>(L, 1, simulate_call.example);
    const lua::Options options(L, 2, simulate_call);
    if (const auto units = asked_units(L, options)) {
        model::System renamed = *handle;
        renamed.units = *units;
        handle = std::make_shared<const model::System>(std::move(renamed));
    }
    RunOptions asked;
    options.fill(asked);
    source::Task task = asked_task(L, options, asked, handle);
    const double from = task.window.start;
    const auto compute = [](const source::Task& given, const motion::Monitor& monitor, const motion::Limits& limits) {
        return motion::simulate(*given.system, given.drive, given.window, given.rows, given.integrator, monitor,
                                limits);
    };
    // Record what M refers to before the run, because M may change it.
    return run_task(L, options, source::origin_of(L, std::move(task)), from, asked.dense, compute);
}

namespace {

constexpr lua::FunctionRole::Motion with_motion = lua::FunctionRole::Motion::always;

/// The function in an option, or nullptr if absent; `role` is its name in errors.
std::shared_ptr<model::UserFunction> function_at(lua_State* L, const lua::Options& options, const char* name,
                                                 const std::string& role) {
    options.push(name);
    std::shared_ptr<model::UserFunction> function;
    if (lua::is_callable(L, -1)) {
        function = std::make_shared<lua::LuaFunction>(L, -1, lua::FunctionRole{.name = role, .motion = with_motion});
    } else if (!lua_isnil(L, -1)) {
        options.wrong(name);
    } else if (options.row(name).otherwise == text::needed) {
        options.missing(name);
    }
    lua_pop(L, 1);
    return function;
}

}  // namespace

void check_name(const lua::Options& options, const char* option, const std::string& name, const lua::Class& of) {
    const auto refuse = [&](std::string_view why) {
        options.fail({.sentence = fmt::format("{}: '{}' {}", option, name, why), .option = option, .culprit = name});
    };
    if (!lua::is_name(name)) refuse("is not a name; use letters, digits and _");
    for (const lua::Member& member : of.members) {
        const bool gives_way = &of == &system_class && member.kind == lua::Kind::field && !is_of_whole(name);
        if (name == member.name && !gives_way)
            refuse(fmt::format("is a name that a {} has already; take another", of.name));
    }
}

std::vector<std::string> names_in_table(lua_State* L, const lua::Options& options, const char* option) {
    if (!lua_istable(L, -1) || lua_rawlen(L, -1) > 0) options.wrong(option);
    return lua::text_keys(L, -1);
}

int push_function(lua_State* L, const lua::Options& options, const char* name) {
    options.push(name);
    if (lua_isnil(L, -1)) options.missing(name);
    if (!lua::is_callable(L, -1)) options.wrong(name);
    return lua_gettop(L);
}

void set_partial(lua_State* L) {
    lua::push_dinal_table(L);
    lua_insert(L, -2);
    lua_setfield(L, -2, "partial");
    lua_pop(L, 1);
}

std::vector<model::OwnState> read_states(lua_State* L, const lua::Options& options) {
    std::vector<model::OwnState> states;
    if (!options.has("states")) return states;
    options.push("states");
    for (const std::string& name : names_in_table(L, options, "states")) {
        check_name(options, "states", name, run_class);
        const std::string of = "states." + name, call = fmt::format("{}: {}", options.call(), of);
        lua_getfield(L, -1, name.c_str());
        if (lua_type(L, -1) != LUA_TTABLE) {
            options.fail({.sentence = fmt::format("{} must be a table such as {{ start = 0, rate = function(t, theta, "
                                                  "velocity, z) return 1 - theta end }}, got {}",
                                                  of, lua::describe(L, -1)),
                          .option = name,
                          .culprit = lua::written(L, -1)});
        }
        const lua::Options own(L, lua_gettop(L), {call.c_str(), state_call.example, state_call.options});
        model::OwnState state;
        own.fill(state);
        state.name = name;
        state.rate = function_at(L, own, "rate", of + ".rate");
        states.push_back(std::move(state));
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return states;
}

namespace {

/// Reads the event in the table on the top.
model::WantedEvent read_event(lua_State* L, const char* simulate, const std::string& of) {
    const std::string call = fmt::format("{}: {}", simulate, of);
    const lua::Options own(L, lua_gettop(L), {call.c_str(), event_call.example, event_call.options});
    model::WantedEvent wanted;
    own.fill(wanted);
    wanted.when = function_at(L, own, "when", of + ".when");
    own.push("act");
    if (!lua_isnil(L, -1)) {
        if (!lua::is_callable(L, -1)) own.wrong("act");
        wanted.act = std::make_shared<lua::LuaAction>(L, -1, of + ".act");
    }
    lua_pop(L, 1);
    return wanted;
}

}  // namespace

std::vector<model::WantedEvent> read_events(lua_State* L, const lua::Options& options) {
    std::vector<model::WantedEvent> events;
    if (!options.has("events")) return events;
    options.push("events");
    if (lua_type(L, -1) != LUA_TTABLE) {
        options.wrong("events");
    }
    const auto count = static_cast<lua_Integer>(lua_rawlen(L, -1));
    for (lua_Integer i = 1; i <= count; ++i) {
        if (lua_rawgeti(L, -1, i) != LUA_TTABLE) {
            options.wrong("events");
        }
        events.push_back(read_event(L, options.call(), fmt::format("events[{}]", i)));
        lua_pop(L, 1);
    }
    lua_pushnil(L);
    if (count == 0 && lua_next(L, -2) != 0) {
        options.fail("events",
                     "events must be a list, in which each event has braces of its own, such as "
                     "{ { when = function(t, theta) return theta - 1 end, name = \"limit\" } }");
    }
    lua_settop(L, lua_gettop(L) - (count == 0 ? 0 : 1));
    lua_pop(L, 1);
    return events;
}

model::Excitation read_motion(lua_State* L, const lua::Options& options, const char* name) {
    if (!options.has(name)) return {};
    options.push(name);
    model::Excitation motion = to_excitation(L, -1, fmt::format("{}: {}", options.call(), name), name);
    if (motion.has_feedback() || model::has_memory(motion)) {
        options.fail(name, "{} must be a number, an excitation or a function of t alone", name);
    }
    lua_pop(L, 1);
    return motion;
}

void check_relays(const lua::Options& options, const model::Excitation& excitation, std::vector<std::string> known,
                  const std::string& M) {
    using Of = model::RelayController::Of;
    for (const model::Component& component : excitation.components()) {
        const auto* relay = model::controller_of<model::RelayController>(component);
        if (relay == nullptr || relay->of == Of::function) continue;
        const std::string of = relay->of == Of::theta ? "theta" : relay->of == Of::velocity ? "velocity" : relay->state;
        if (std::find(known.begin(), known.end(), of) != known.end()) continue;
        options.fail({.sentence = fmt::format("{}: the relay looks at '{}'; in this run it may look at {}", M, of,
                                              fmt::join(known, ", ")),
                      .option = "M",
                      .culprit = of,
                      .cure = text::did_you_mean(of, known)});
    }
}

}  // namespace dinal::api
