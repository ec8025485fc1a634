#include "api/sweep_workers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <system_error>

#include "lua/foreign.hpp"
#include "lua/lua_text.hpp"
#include "lua/standard_globals.hpp"
#include "source/carry.hpp"
#include "terminal/progress.hpp"

namespace dinal::api {
namespace {

double now_in_seconds() {
    using std::chrono::duration;
    return duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Carrying {
    lua_State* from;
    int index;
    const SweepWork& work;
    std::optional<text::Error> error = {};
};

bool carry_data(lua_State* from, int index, lua_State* to) {
    const auto* data = lua::test<DataHandle>(from, index);
    if (data != nullptr) lua::push<DataHandle>(to, *data);
    return data != nullptr;
}

/// Called in the new state with a Carrying; returns the function.
int carry_function(lua_State* L) {
    auto& carrying = *static_cast<Carrying*>(lua_touserdata(L, 1));
    source::Carrier carrier(carrying.from, L, carry_data);
    carrying.error = carrier.carry(carrying.index, "run");
    lua::forbid_exit(L);
    if (carrying.error) return 0;
    if (carrying.work.adapt) carrying.work.adapt(L);
    return 1;
}

/// The same text whichever worker it is: not where a table lies in memory.
int error_as_text(lua_State* L) {
    lua_settop(L, 1);
    if (lua_isstring(L, 1) != 0) return 1;
    if (luaL_getmetafield(L, 1, "__tostring") == LUA_TNIL) {
        return lua::push_text(L, fmt::format("(error object is a {} value)", luaL_typename(L, 1)));
    }
    luaL_tolstring(L, 1, nullptr);
    return 1;
}

/// The loop of one worker: the places of its stack that stay.
struct PointLoop {
    static constexpr int handler = 1, function = 2, seed = 3, columns = 4;

    lua_State* L;
    SweepWork& work;
    lua::WorkerWatch& watch;

    void run() {
        std::size_t first = 0, last = 0;
        while (take(first, last)) {
            for (std::size_t i = first; i < last; ++i) {
                if (lua::interrupt_requested() || work.ends || !point(work.points[i])) return;
                work.finished.fetch_add(1, std::memory_order_relaxed);
                if (work.after_point) work.after_point();
            }
        }
    }

    /// Many points at once as long as there are many: they may be short, and the last ones must not be waited for.
    [[nodiscard]] bool take(std::size_t& first, std::size_t& last) const {
        constexpr std::size_t most = 64;
        const std::size_t count = work.points.size();
        const std::size_t left = count - std::min(count, work.next.load(std::memory_order_relaxed));
        const std::size_t some = std::clamp<std::size_t>(left / (8 * work.workers), 1, most);
        first = std::min(count, work.next.fetch_add(some));
        last = std::min(count, first + some);
        return first < last;
    }

    /// False when it was stopped.
    [[nodiscard]] bool point(std::size_t number) const {
        lua_settop(L, columns);
        lua_pushvalue(L, seed);
        lua_pushinteger(L, static_cast<lua_Integer>(number) + 1);
        lua_pushinteger(L, work.seed);
        lua_call(L, 2, 0);
        lua_pushvalue(L, function);
        lua_createtable(L, 0, static_cast<int>(work.grid.parameters().size()));
        work.grid.set_fields(L, number);
        if (work.max_time > 0) {
            watch.since = now_in_seconds();
            ++watch.task;
        }
        const int status = lua_pcall(L, 1, 1, handler);
        if (work.max_time > 0 && is_given_up(number)) return true;
        if (status != LUA_OK && lua::interrupt_requested()) return false;
        const std::string trouble = status != LUA_OK ? std::string(lua::text_at(L, -1)) : complaint();
        if (!trouble.empty()) {
            work.results.fail(number, trouble);
            return true;
        }
        lua_pushnil(L);
        while (lua_next(L, columns + 1) != 0) {
            lua_pushvalue(L, -2);
            lua_rawget(L, columns);
            static_cast<double*>(lua_touserdata(L, -1))[number] = lua_type(L, -2) == LUA_TSTRING
                                                                      ? work.results.word(lua::text_at(L, -2))
                                                                  : lua_isboolean(L, -2) ? lua_toboolean(L, -2)
                                                                                         : lua_tonumber(L, -2);
            lua_pop(L, 2);
        }
        work.results.finish(number);
        return true;
    }

    /// Ends the task; whether it was given up, which is then its result.
    [[nodiscard]] bool is_given_up(std::size_t number) const {
        const bool late = watch.has_given_up();
        ++watch.task;
        watch.since = std::numeric_limits<double>::infinity();
        if (!late || lua::interrupt_requested()) return false;
        lua_sethook(L, nullptr, 0, 0);
        work.results.fail(number, fmt::format("it ran longer than the {:g} s that max_time allows", work.max_time));
        return true;
    }

    /// What is wrong with the result on the top of the stack. Afterwards each name in it has its column.
    [[nodiscard]] std::string complaint() const {
        if (!lua_istable(L, -1)) {
            return fmt::format("run must return a table of named numbers such as {{ A = s.amplitude }}, got {}",
                               lua::describe(L, -1));
        }
        lua_pushnil(L);
        while (lua_next(L, columns + 1) != 0) {
            if (lua_type(L, -2) != LUA_TSTRING) {
                return fmt::format("run must return named numbers such as {{ A = s.amplitude }}, but {} has no name",
                                   lua::describe(L, -1));
            }
            const int type = lua_type(L, -1);
            if (type != LUA_TNUMBER && type != LUA_TBOOLEAN && type != LUA_TSTRING) {
                return fmt::format("run returned {} = {}, which is neither a number nor a string", lua_tostring(L, -2),
                                   lua::describe(L, -1));
            }
            lua_pop(L, 1);
            lua_pushvalue(L, -1);
            if (lua_rawget(L, columns) == LUA_TNIL) {
                if (std::string trouble = new_column(lua::text_at(L, -2)); !trouble.empty()) return trouble;
            }
            lua_pop(L, 1);
        }
        return "";
    }

    [[nodiscard]] std::string new_column(std::string_view name) const {
        for (const DataColumn& parameter : work.grid.parameters()) {
            if (parameter.name == name) {
                return fmt::format("run returned '{}', which is the name of a parameter: give it another", name);
            }
        }
        if (name == "error") return "run returned 'error', which is the column of messages: give it another name";
        double* numbers = work.results.column(name);
        if (numbers == nullptr) return fmt::format("run returned more than {} names", SweepResults::most_columns);
        lua::push_text(L, name);
        lua_pushlightuserdata(L, numbers);
        lua_rawset(L, columns);
        return "";
    }
};

/// Called with the function, the SweepWork and the WorkerWatch.
int work_on_points(lua_State* L) {
    auto& work = *static_cast<SweepWork*>(lua_touserdata(L, 2));
    auto& watch = *static_cast<lua::WorkerWatch*>(lua_touserdata(L, 3));
    lua_settop(L, 1);
    lua_pushcfunction(L, lua::guarded<error_as_text>);
    lua_insert(L, 1);
    lua::push_standard_globals(L);  // a user may have a `math` of his own
    lua_getfield(L, -1, LUA_MATHLIBNAME);
    lua_getfield(L, -1, "randomseed");
    lua_insert(L, 3);
    lua_settop(L, 3);
    lua_newtable(L);
    PointLoop{L, work, watch}.run();
    return 0;
}

}  // namespace

SweepWorkers::SweepWorkers(lua_State* L, int index, SweepWork& work) : work_(work) {
    if (const lua::Foreign* other = lua::foreign(L, index)) {
        if (work.max_time > 0) {
            lua::raise(L, {.sentence = fmt::format("{}: max_time needs a Lua function, and this one is of {}",
                                                   work.call, other->language),
                           .call = work.call,
                           .option = "max_time"});
        }
        other->runs_alone(L, work.call);
        function_ = lua_absindex(L, index);
        work.workers = 1;
        return;
    }
    for (std::size_t i = 0; i < work.workers; ++i) {
        states_.push_back(lua::new_state_like(L));
        lua_State* worker = states_.back().get();
        Carrying carrying{L, lua_absindex(L, index), work};
        lua_pushcfunction(worker, lua::guarded<carry_function>);
        lua_pushlightuserdata(worker, &carrying);
        const bool carried = lua_pcall(worker, 1, 1, 0) == LUA_OK;
        if (carrying.error) lua::raise(L, text::in_call(work.call, *carrying.error));
        if (!carried) lua::raise(L, std::string(work.call) + ": not enough memory for another worker");
    }
}

void SweepWorkers::run_here(lua_State* L) {
    terminal::Progress progress = terminal::Progress::of_steps(work_.call, static_cast<double>(work_.points.size()));
    lua::WorkerWatch watch;
    work_.after_point = [&] { progress.advance(static_cast<double>(work_.finished.load(std::memory_order_relaxed))); };
    lua_pushcfunction(L, lua::guarded<work_on_points>);
    lua_pushvalue(L, function_);
    if (work_.adapt) work_.adapt(L);
    lua_pushlightuserdata(L, &work_);
    lua_pushlightuserdata(L, &watch);
    lua_call(L, 3, 0);
}

void SweepWorkers::run_one(lua_State* worker, lua::WorkerWatch& watch) {
    std::string trouble;
    {
        const lua::WorkerScope scope(worker, &watch);
        lua_pushcfunction(worker, lua::guarded<work_on_points>);
        lua_insert(worker, -2);
        lua_pushlightuserdata(worker, &work_);
        lua_pushlightuserdata(worker, &watch);
        if (lua_pcall(worker, 3, 0, 0) != LUA_OK && !lua::interrupt_requested()) {
            trouble = lua_isstring(worker, -1) != 0 ? lua::text_at(worker, -1) : "a worker has failed";
        }
    }
    const std::lock_guard lock(ending_);
    if (!trouble.empty()) trouble_ = trouble;
    --running_;
    ended_.notify_one();
}

/// As many as the system allows; one does all, too.
void SweepWorkers::start(std::vector<std::thread>& threads) {
    const lua::SignalsForOthers blocked;
    for (const lua::OwnedState& state : states_) {
        {
            const std::lock_guard lock(ending_);
            ++running_;
        }
        lua::WorkerWatch& own = watches_.emplace_back();
        own.since = std::numeric_limits<double>::infinity();
        own.outer = lua::watch_here();
        try {
            threads.emplace_back([this, worker = state.get(), &own] { run_one(worker, own); });
        } catch (const std::system_error&) {
            const std::lock_guard lock(ending_);
            --running_;
            return;
        }
    }
}

void SweepWorkers::watch(std::vector<std::thread>& threads) {
    const double now = now_in_seconds();
    for (std::size_t i = 0; i < threads.size(); ++i) {
        lua::WorkerWatch& own = watches_[i];
        const std::uint64_t task = own.task;
        if (now - own.since <= work_.max_time) continue;
        own.given_up = task;  // no other one, should it have ended meanwhile
        lua::nudge(threads[i].native_handle());
    }
}

void SweepWorkers::run(lua_State* L) {
    using std::chrono::milliseconds;
    constexpr milliseconds look_again{20};
    if (function_ != 0) return run_here(L);
    terminal::Progress progress = terminal::Progress::of_steps(work_.call, static_cast<double>(work_.points.size()));
    std::vector<std::thread> threads;
    threads.reserve(states_.size());
    start(threads);
    if (threads.empty()) lua::raise(L, std::string(work_.call) + ": the operating system refuses to start a thread");
    std::unique_lock lock(ending_);
    while (!ended_.wait_for(lock, look_again, [this] { return running_ == 0; })) {
        progress.advance(static_cast<double>(work_.finished.load(std::memory_order_relaxed)));
        if (work_.look && !work_.ends && !work_.look()) work_.ends = true;
        if (work_.max_time > 0) watch(threads);
        if (lua::interrupt_requested()) {
            for (std::thread& thread : threads) lua::nudge(thread.native_handle());
        }
    }
    lock.unlock();
    for (std::thread& thread : threads) thread.join();
    if (work_.look && !work_.ends) work_.look();
    if (!trouble_.empty()) lua::raise(L, std::string(work_.call) + ": " + trouble_);
}

}  // namespace dinal::api
