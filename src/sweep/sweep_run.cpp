#include "sweep/sweep_run.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "api/drive_options.hpp"
#include "files/file.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/memory_limit.hpp"
#include "lua/standard_globals.hpp"
#include "lua/user_function.hpp"
#include "lua/values.hpp"
#include "lua/worker_state.hpp"
#include "source/carry.hpp"
#include "source/fingerprint.hpp"
#include "terminal/progress.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::sweep {

using namespace api;

namespace {

// ---- The threads of a sweep, each with its own Lua state and a copy of the user's function.

/// Shared by the workers.
struct SweepWork {
    const PointGrid& grid;
    SweepResults& results;
    std::vector<std::size_t> points;  ///< still to be computed
    std::size_t first = 0;            ///< the point of the first result
    long long seed = 0;               ///< seed of math.random, combined with the number of the point
    const char* call = "sweep";       ///< beginning of error sentences
    double max_time = 0;              ///< time limit of a point, seconds; 0: none
    /// Runs in a worker's state: replaces the copied function on the top by the function to be called.
    const std::function<void(lua_State* worker)>& adapt;
    /// Called 50 times a second on the waiting thread, and at the end; false stops the sweep.
    std::function<bool()> keeps_going = {};
    std::atomic<std::size_t> next = 0;
    std::atomic<std::size_t> finished = 0;
    std::atomic<bool> ends = false;
    std::size_t workers = 1;
};

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

/// Copies a function to a new state, in which it runs; receives a Carrying and returns the function.
int carry_function(lua_State* L) {
    auto& carrying = *static_cast<Carrying*>(lua_touserdata(L, 1));
    source::Carrier carrier(carrying.from, L, carry_data);
    carrying.error = carrier.carry(carrying.index, "run");
    lua::forbid_exit(L);
    if (carrying.error) return 0;
    if (carrying.work.adapt) carrying.work.adapt(L);
    return 1;
}

/// An error text independent of the worker: without memory addresses.
int error_as_text(lua_State* L) {
    lua_settop(L, 1);
    if (lua_isstring(L, 1) != 0) return 1;
    if (luaL_getmetafield(L, 1, "__tostring") == LUA_TNIL) {
        return lua::push_text(L, fmt::format("(error object is a {} value)", luaL_typename(L, 1)));
    }
    luaL_tolstring(L, 1, nullptr);
    return 1;
}

/// The loop of a worker, with its fixed stack indices.
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
            }
        }
    }

    /// Takes many points at once while many are left, as they may be short, and few at the end, so that no worker
    /// waits.
    bool take(std::size_t& first, std::size_t& last) const {
        constexpr std::size_t most = 64;
        const std::size_t count = work.points.size();
        const std::size_t left = count - std::min(count, work.next.load(std::memory_order_relaxed));
        const std::size_t some = std::clamp<std::size_t>(left / (8 * work.workers), 1, most);
        first = std::min(count, work.next.fetch_add(some));
        last = std::min(count, first + some);
        return first < last;
    }

    /// Computes a point; returns false if it was stopped.
    bool point(std::size_t number) const {
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
        lua::stop_after_refusal();
        const std::size_t place = number - work.first;
        if (work.max_time > 0 && end_time_limit(place)) return true;
        if (status != LUA_OK && lua::interrupt_requested()) return false;
        const std::string trouble = status != LUA_OK ? std::string(lua::text_at(L, -1)) : complaint();
        if (!trouble.empty()) {
            work.results.fail(place, trouble);
            return true;
        }
        lua_pushnil(L);
        while (lua_next(L, columns + 1) != 0) {
            lua_pushvalue(L, -2);
            lua_rawget(L, columns);
            static_cast<double*>(lua_touserdata(L, -1))[place] = lua_type(L, -2) == LUA_TSTRING
                                                                     ? work.results.word(lua::text_at(L, -2))
                                                                 : lua_isboolean(L, -2) ? lua_toboolean(L, -2)
                                                                                        : lua_tonumber(L, -2);
            lua_pop(L, 2);
        }
        work.results.finish(place);
        return true;
    }

    /// Ends the time limit of a point; returns whether it was exceeded, and then stores that as the failure of the
    /// point.
    bool end_time_limit(std::size_t place) const {
        const bool late = watch.has_given_up();
        ++watch.task;
        watch.since = std::numeric_limits<double>::infinity();
        if (!late || lua::interrupt_requested()) return false;
        lua_sethook(L, nullptr, 0, 0);
        work.results.fail(place, fmt::format("it ran longer than the {:g} s that max_time allows", work.max_time));
        return true;
    }

    /// Returns the error in the table of results on the top of the stack; if there is none, each of its names has a
    /// column afterwards.
    std::string complaint() const {
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

    std::string new_column(std::string_view name) const {
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

/// Receives the function, the SweepWork and the WorkerWatch.
int work_on_points(lua_State* L) {
    auto& work = *static_cast<SweepWork*>(lua_touserdata(L, 2));
    auto& watch = *static_cast<lua::WorkerWatch*>(lua_touserdata(L, 3));
    lua_settop(L, 1);
    lua_pushcfunction(L, lua::guarded<error_as_text>);
    lua_insert(L, 1);
    lua::push_standard_globals(L);  // a user may have redefined `math`
    lua_getfield(L, -1, LUA_MATHLIBNAME);
    lua_getfield(L, -1, "randomseed");
    lua_insert(L, 3);
    lua_settop(L, 3);
    lua_newtable(L);
    PointLoop{L, work, watch}.run();
    return 0;
}

class SweepWorkers {
public:
    /// Copies the function at `index` to a new state for each worker; raises an error if that is impossible. A function
    /// of another language is not copied: the calling thread computes all points.
    SweepWorkers(lua_State* L, int index, SweepWork& work) : work_(work) {
        if (const lua::Foreign* other = lua::foreign(L, index)) {
            if (work.max_time > 0) {
                lua::fail(
                    L, work.call,
                    {.sentence = fmt::format("max_time needs a Lua function, and this one is of {}", other->language),
                     .option = "max_time"});
            }
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
            if (carrying.error) lua::fail(L, work.call, *carrying.error);
            if (!carried) lua::raise(L, std::string(work.call) + ": not enough memory for another worker");
        }
    }

    /// Computes all points, or until a stop is requested. Raises an error if memory is insufficient.
    void run(lua_State* L) {
        using std::chrono::milliseconds;
        constexpr milliseconds between_checks{20};
        if (function_ != 0) return run_here(L);
        terminal::Progress progress =
            terminal::Progress::of_steps(work_.call, static_cast<double>(work_.points.size()));
        std::vector<std::thread> threads;
        threads.reserve(states_.size());
        start(threads);
        if (threads.empty())
            lua::raise(L, std::string(work_.call) + ": the operating system refuses to start a thread");
        std::unique_lock lock(ending_);
        while (!ended_.wait_for(lock, between_checks, [this] { return running_ == 0; })) {
            progress.advance(static_cast<double>(work_.finished.load(std::memory_order_relaxed)));
            if (work_.keeps_going && !work_.ends && !work_.keeps_going()) work_.ends = true;
            if (work_.max_time > 0) watch(threads);
            if (lua::interrupt_requested()) {
                for (std::thread& thread : threads) lua::nudge(thread.native_handle());
            }
        }
        lock.unlock();
        for (std::thread& thread : threads) thread.join();
        if (work_.keeps_going && !work_.ends) work_.keeps_going();
        if (!trouble_.empty()) lua::raise(L, std::string(work_.call) + ": " + trouble_);
    }

private:
    void run_here(lua_State* L) {
        lua::WorkerWatch watch;
        lua_pushcfunction(L, lua::guarded<work_on_points>);
        lua_pushvalue(L, function_);
        if (work_.adapt) work_.adapt(L);
        lua_pushlightuserdata(L, &work_);
        lua_pushlightuserdata(L, &watch);
        lua_call(L, 3, 0);
    }

    void start(std::vector<std::thread>& threads) {
        const lua::NoSignalsForNewThreads blocked;
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

    void run_one(lua_State* worker, lua::WorkerWatch& watch) {
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
    /// Gives up tasks that take too long.
    void watch(std::vector<std::thread>& threads) {
        const double now = now_in_seconds();
        for (std::size_t i = 0; i < threads.size(); ++i) {
            lua::WorkerWatch& own = watches_[i];
            const std::uint64_t task = own.task;
            if (now - own.since <= work_.max_time) continue;
            own.given_up = task;  // only this task: the worker may already have a new one
            lua::nudge(threads[i].native_handle());
        }
    }

    SweepWork& work_;
    std::vector<lua::OwnedState> states_;
    std::deque<lua::WorkerWatch> watches_;  // one for each thread
    std::mutex ending_;
    std::condition_variable ended_;
    std::size_t running_ = 0;
    std::string trouble_;
    int function_ = 0;  // stack index of a function of another language; 0: it is in the states
};

void add_column(source::Fingerprint& print, const DataColumn& column) {
    print.add(column.name);
    print.add(static_cast<double>(column.size()));
    if (const lua::Vector* numbers = column.numbers()) {
        for (const double x : numbers->values()) print.add(x);
    } else {
        for (const std::string& word : column.words()) print.add(word);
    }
}

bool add_data(lua_State* L, int index, source::Fingerprint& print) {
    const auto* data = lua::test<DataHandle>(L, index);
    if (data == nullptr) return false;
    print.add((*data)->heading);
    for (const DataColumn& column : (*data)->columns) {
        add_column(print, column);
        print.add(column.unit);
    }
    return true;
}

std::uint64_t fingerprint_of(lua_State* L, const SweepTask& task) {
    source::Fingerprint print(L, add_data);
    print.add(std::string_view(task.call));
    for (const double number : task.settings) print.add(number);
    const PointGrid& grid = task.grid;
    for (const DataColumn& parameter : grid.parameters()) add_column(print, parameter);
    print.add(task.seed);
    task.mark.empty() ? print.add_value(task.function) : print.add(std::string_view(task.mark));
    return print.number();
}

struct Failures {
    std::size_t count = 0;
    std::string place, message;  ///< the first failure: "r = 0.5, g = 1"
};

Failures failures_in(const Data& data, const PointGrid& grid) {
    Failures found;
    const std::vector<std::string>& errors = data.columns.back().words();
    for (std::size_t row = 0; row < errors.size(); ++row) {
        if (errors[row].empty() || ++found.count > 1) continue;
        for (std::size_t i = 0; i < grid.parameters().size(); ++i) {
            found.place += (i == 0 ? "" : ", ") + data.columns[i].name + " = " + data.columns[i].text(row);
        }
        found.message = errors[row];
    }
    return found;
}

/// The greatest number of threads for a sweep: DINAL_WORKERS, if set by an administrator or user.
std::size_t most_workers(lua_State* L) {
    const char* variable = std::getenv("DINAL_WORKERS");
    if (variable == nullptr || *variable == '\0') return std::numeric_limits<std::size_t>::max();
    const std::string_view text = variable;
    std::size_t most = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), most);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size() || most == 0) {
        lua::raise(L, "DINAL_WORKERS, the most threads of a sweep, must be a whole number from 1, not '{}'", text);
    }
    return most;
}

std::size_t worker_count(lua_State* L, const std::optional<double>& asked, std::size_t points) {
    const std::size_t cores = lua::in_worker() ? 1 : std::max(1U, std::thread::hardware_concurrency());
    const std::size_t asked_for = asked ? static_cast<std::size_t>(*asked) : cores;
    // each worker needs memory
    const std::size_t wanted = lua::memory_limit() > 0 ? std::min(asked_for, cores) : asked_for;
    return std::clamp<std::size_t>(std::min(wanted, most_workers(L)), 1, std::max<std::size_t>(points, 1));
}

class SweepRun {
public:
    /// Loads points computed before from the file.
    SweepRun(lua_State* L, const SweepTask& task) : L_(L), task_(task) {
        if (!task.file.empty()) open_journal();
        const std::size_t size = task.points ? task.points->second - task.points->first : task.grid.size();
        if (!results_) results_ = std::make_shared<SweepResults>(size, chunk_size_for(size));
    }

    Data run() {
        if (journal_ && journal_->result()) return with_heading(*journal_->result());
        work();
        if (lua::interrupt_requested()) stop();
        if (trouble_) fail();
        return finished();
    }

    // For Python's executors, which compute the points. Each of these calls may come from another Lua thread.

    std::vector<double> left() const {
        std::vector<double> firsts;
        for (std::size_t chunk = 0; chunk < (journal_ && journal_->result() ? 0 : results_->chunks()); ++chunk) {
            if (!results_->is_complete(chunk)) firsts.push_back(static_cast<double>(chunk * results_->chunk_size()));
        }
        return firsts;
    }
    /// Stores results; returns the number of finished points.
    std::size_t take(lua_State* L, std::size_t first, const Data& data) {
        L_ = L;
        std::vector<std::size_t> points(data.size());
        std::iota(points.begin(), points.end(), first);
        results_->take(points, std::span(data.columns).subspan(task_.grid.parameters().size()));
        if (journal_) trouble_ = journal_->write(false);
        if (trouble_) fail();
        return results_->done();
    }
    /// Puts the finished points in dinal.partial.
    void keep(lua_State* L) {
        L_ = L;
        push_data(L_, finished_data());
        set_partial(L_);
    }
    Data finish(lua_State* L) {
        L_ = L;
        return journal_ && journal_->result() ? with_heading(*journal_->result()) : finished();
    }

private:
    void open_journal() {
        lua::refuse_in_worker(L_, "a sweep with a file");
        const lua::Foreign* other = task_.mark.empty() ? lua::foreign(L_, task_.function) : nullptr;
        if (other != nullptr) {
            lua::fail(L_, task_.call,
                      {.sentence = fmt::format(
                           "file needs a Lua function, because a change in one of {} cannot be detected; save the "
                           "result instead",
                           other->language),
                       .option = "file"});
        }
        results_ = std::make_shared<SweepResults>(task_.grid.size(), chunk_size_for(task_.grid.size()));
        journal_.emplace(task_.file, fmt::format("{:016x}", fingerprint_of(L_, task_)), *results_);
        if (const auto wrong = journal_->open()) lua::fail(L_, task_.call, *wrong);
    }

    /// The point of the first result.
    std::size_t first() const { return task_.points ? task_.points->first : 0; }

    void work() {
        SweepWork work{.grid = task_.grid,
                       .results = *results_,
                       .points = {},
                       .first = first(),
                       .seed = static_cast<long long>(task_.seed),
                       .call = task_.call,
                       .max_time = task_.max_time,
                       .adapt = task_.adapt};
        for (std::size_t place = 0; place < results_->size(); ++place) {
            if (!results_->is_done(place)) work.points.push_back(work.first + place);
        }
        if (journal_) {
            work.keeps_going = [this] {
                trouble_ = journal_->write(false);
                return !trouble_;
            };
        }
        work.workers = worker_count(L_, task_.workers, work.points.size());
        SweepWorkers workers(L_, task_.function, work);
        workers.run(L_);
    }

    /// Adds a heading that reports failed points, because users rarely check a column that should be empty.
    Data with_heading(std::vector<DataColumn> columns) const {
        Data data = task_.form;
        data.columns = std::move(columns);
        if (const Failures failed = failures_in(data, task_.grid); failed.count > 0) {
            data.heading = text::wrapped(fmt::format("data: {} points, {} of them failed; the first one, {}: {}",
                                                     task_.grid.size(), failed.count, failed.place, failed.message));
        }
        return data;
    }

    Data finished_data() const {
        const std::vector<std::size_t> points = results_->done_points();
        if (task_.make_columns) return with_heading(task_.make_columns(*results_, points));
        std::vector<std::size_t> places = points;
        for (std::size_t& place : places) place += first();
        std::vector<DataColumn> columns = task_.grid.columns(places);
        for (DataColumn& column : results_->columns(points)) columns.push_back(std::move(column));
        return with_heading(std::move(columns));
    }

    [[noreturn]] void stop() {
        if (journal_ && lua::stop_requested() != lua::Stop::memory) {
            const lua::InSpiteOfStop writes;
            static_cast<void>(journal_->write(true));
        }
        keep(L_);
        lua::raise_interrupted(L_);
    }

    [[noreturn]] void fail() {
        push_data(L_, finished_data());
        set_partial(L_);
        trouble_->sentence += fmt::format(
            "; finished points are kept in '{}' and dinal.partial, and the same call continues", journal_->path());
        lua::fail(L_, task_.call, *trouble_);
    }

    /// Raises an error if all points failed, as from a mistake in the function.
    void raise_if_all_failed(const Data& data) const {
        const Failures failed = failures_in(data, task_.grid);
        if (failed.count < task_.grid.size()) return;
        const std::string sentence =
            failed.count == 1 ? fmt::format("{}: the point {} failed: {}", task_.call, failed.place, failed.message)
                              : fmt::format("{}: all {} points failed; the first one, {}: {}", task_.call, failed.count,
                                            failed.place, failed.message);
        if (journal_) journal_->discard();
        lua::raise(L_, {.sentence = sentence, .call = task_.call});
    }

    Data finished() {
        if (task_.points) return finished_data();
        Data data = finished_data();
        raise_if_all_failed(data);
        if (journal_) trouble_ = journal_->finish(data);
        if (trouble_) fail();
        return data;
    }

    lua_State* L_;
    const SweepTask& task_;
    std::shared_ptr<SweepResults> results_;
    std::optional<SweepJournal> journal_;
    std::optional<text::Error> trouble_;
};

// ---- a sweep computed by Python's executors, an undocumented Lua object

struct PartedSweep {
    explicit PartedSweep(std::vector<DataColumn> parameters) : grid(std::move(parameters)) {}

    PointGrid grid;
    std::optional<SweepTask> task = {};
    std::optional<SweepRun> run = {};
};
using PartedHandle = std::shared_ptr<PartedSweep>;

/// The first points of the remaining chunks.
std::vector<double> left_of(const PartedHandle& sweep) {
    return sweep->run->left();
}
std::size_t take_part(lua_State* L, const PartedHandle& sweep, double first, const DataHandle& data) {
    return sweep->run->take(L, static_cast<std::size_t>(first), *data);
}
bool keep_parts(lua_State* L, const PartedHandle& sweep) {
    sweep->run->keep(L);
    return true;
}
DataHandle finish_parts(lua_State* L, const PartedHandle& sweep) {
    return std::make_shared<const Data>(sweep->run->finish(L));
}

constexpr lua::Member parted_members[] = {
    {lua::a_typed_method<left_of>, {"sweep:left()", "", ""}},
    {lua::a_typed_method<take_part>, {"sweep:take(first, data)", "", ""}},
    {lua::a_typed_method<keep_parts>, {"sweep:keep()", "", ""}},
    {lua::a_typed_method<finish_parts>, {"sweep:finish()", "", ""}},
    {lua::a_value<PartedHandle, [](const PartedSweep& sweep) { return sweep.grid.size(); }>, {"sweep.size", "", ""}},
    {lua::a_value<PartedHandle, [](const PartedSweep& sweep) { return chunk_size_for(sweep.grid.size()); }>,
     {"sweep.chunk", "", ""}}};
const lua::Class parted_class = {"sweep in parts", {"", "", ""}, parted_members};

}  // namespace

void check_file_of_sweep(const lua::Options& options, const SweepOptions& asked) {
    if (!options.has("file") || text::ending_of(asked.file) == ".csv") return;
    options.fail("file", "the name '{}' must end in .csv", asked.file);
}

Data swept(lua_State* L, const SweepTask& task) {
    return SweepRun(L, task).run();
}

void push_parted(lua_State* L, std::vector<DataColumn> parameters,
                 const std::function<SweepTask(const PointGrid&)>& task) {
    const auto sweep = std::make_shared<PartedSweep>(std::move(parameters));
    sweep->task.emplace(task(sweep->grid));
    sweep->run.emplace(L, *sweep->task);
    lua::push<PartedHandle>(L, sweep);
}

void register_parted_sweep(lua_State* L) {
    lua::add_class<PartedHandle>(L, parted_class);
}

namespace {

namespace fs = std::filesystem;

/// Columns as CSV, after a line with size and digest that detect truncation.
std::string block_of(std::span<const DataColumn> columns) {
    std::string text;
    for (const DataColumn& column : columns) text += (text.empty() ? "" : ",") + files::field_of(column.name);
    for (std::size_t row = 0; row < columns.front().size(); ++row) {
        for (const DataColumn& column : columns) {
            text += &column == &columns.front() ? '\n' : ',';
            const lua::Vector* numbers = column.numbers();
            if (numbers == nullptr) {
                text += files::field_of(column.words()[row]);
            } else if (const double x = numbers->begin()[row]; !std::isnan(x)) {
                fmt::format_to(std::back_inserter(text), "{}", x);
            }
        }
    }
    text += '\n';
    return fmt::format("# {} bytes, {:016x}\n", text.size(), source::digest_of(text)) + text;
}

/// Takes the first block off the text and returns its columns; none if it is incomplete.
std::optional<std::vector<DataColumn>> take_block(std::string_view& text) {
    const std::size_t line = text.find('\n') + 1;
    std::size_t bytes = 0;
    const bool has_head = line > 0 && text.starts_with("# ") &&
                          std::from_chars(text.data() + 2, text.data() + line, bytes).ec == std::errc();
    if (!has_head || bytes > text.size() - line) return std::nullopt;
    const std::string_view content = text.substr(line, bytes);
    if (text.substr(0, line) != fmt::format("# {} bytes, {:016x}\n", bytes, source::digest_of(content)))
        return std::nullopt;
    auto read = files::parse_columns(content, "");
    if (!read) return std::nullopt;
    text.remove_prefix(line + bytes);
    std::vector<DataColumn> columns;
    for (files::ReadColumn& column : read.value().columns) {
        // A column of empty messages looks like numbers.
        const bool is_error = column.name == "error" && !column.of_words;
        columns.push_back(is_error ? column_of("error", std::vector<std::string>(column.numbers.size()))
                                   : column_of(std::move(column)));
    }
    return columns;
}

}  // namespace

std::size_t chunk_size_for(std::size_t points) {
    constexpr std::size_t chunks = 256, most = 100'000;
    return std::clamp<std::size_t>((points + chunks - 1) / chunks, 1, most);
}

SweepJournal::SweepJournal(std::string file, const std::string& mark, SweepResults& results)
    : file_(std::move(file)),
      path_(file_ + ".part"),
      mark_("# sweep " + mark + '\n'),
      results_(results),
      written_(results.chunks()) {}

text::Error SweepJournal::refused(const std::string& path, std::string_view why) const {
    return {.sentence = fmt::format("'{}' {}; remove it, or give another file", path, why),
            .option = "file",
            .culprit = file_};
}

std::optional<text::Error> SweepJournal::open() {
    if (const auto why = files::outside(file_, files::Access::write)) {
        return text::Error{.sentence = fmt::format("cannot write '{}': {}", file_, *why), .option = "file"};
    }
    std::error_code error;
    if (fs::exists(file_, error)) return take_result();
    const int descriptor =
        ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    journal_ = std::make_shared<files::Descriptor>(descriptor);
    struct stat about {};
    if (descriptor < 0 && errno != ELOOP) {
        return text::Error{.sentence = fmt::format("cannot write '{}': {}", path_, std::strerror(errno)),
                           .option = "file",
                           .culprit = file_};
    }
    if (descriptor < 0 || ::fstat(descriptor, &about) != 0 || !S_ISREG(about.st_mode))
        return refused(path_, "is not a regular file");
    // flock() would be inherited by a pool of processes, which may outlive this process and keep the lock.
    struct flock whole {};
    whole.l_type = F_WRLCK;
    whole.l_whence = SEEK_SET;
    if (::fcntl(descriptor, F_SETLK, &whole) != 0 && (errno == EACCES || errno == EAGAIN)) {
        return text::Error{
            .sentence = fmt::format("another process is at the same sweep and writes '{}': wait for it, or "
                                    "give another file",
                                    path_),
            .option = "file",
            .culprit = file_};
    }
    if (!fs::exists(file_, error)) return take_points();
    discard();  // another process has just finished it
    return take_result();
}

/// Reads complete blocks and truncates the rest.
std::optional<text::Error> SweepJournal::take_points() {
    std::string text;
    char buffer[1U << 16U];
    for (ssize_t count = 0; (count = ::read(journal_->number(), buffer, sizeof buffer)) > 0;)
        text.append(buffer, static_cast<std::size_t>(count));
    std::string_view rest = text;
    if (mark_.starts_with(rest) && rest.size() < mark_.size()) return append(mark_);
    if (!rest.starts_with(mark_)) {
        return refused(path_, "holds the points of another sweep: its grid or its function was another");
    }
    rest.remove_prefix(mark_.size());
    while (const auto columns = take_block(rest)) {
        std::vector<std::size_t> points;
        for (const double point : columns->front().numbers()->values())
            points.push_back(static_cast<std::size_t>(point));
        results_.take(points, std::span(*columns).subspan(1));
    }
    size_ = text.size() - rest.size();
    for (std::size_t chunk = 0; chunk < results_.chunks(); ++chunk) written_[chunk] = results_.is_complete(chunk);
    return rest.empty() ? std::nullopt : append("");
}

/// Appends after the last complete block; anything after it is truncated.
std::optional<text::Error> SweepJournal::append(std::string_view text) {
    const int file = journal_->number();
    bool good = ::ftruncate(file, static_cast<off_t>(size_)) == 0;
    for (std::string_view rest = text; good && !rest.empty();) {
        const ssize_t count = ::write(file, rest.data(), rest.size());
        good = count > 0 || errno == EINTR;
        if (count > 0) rest.remove_prefix(static_cast<std::size_t>(count));
    }
    if (good) size_ += text.size();
    return good ? std::nullopt : std::optional(text::error("cannot write '{}': {}", path_, std::strerror(errno)));
}

std::optional<text::Error> SweepJournal::write(bool incomplete) {
    for (std::size_t chunk = 0; chunk < results_.chunks(); ++chunk) {
        const bool complete = results_.is_complete(chunk);
        if (written_[chunk] || !(complete || incomplete)) continue;
        std::vector<std::size_t> points;
        for (std::size_t i = 0, point = chunk * results_.chunk_size();
             i < results_.chunk_size() && point < results_.size(); ++i, ++point) {
            if (results_.is_done(point)) points.push_back(point);
        }
        if (points.empty()) continue;
        std::vector<DataColumn> columns = results_.columns(points);
        columns.insert(columns.begin(), column_of("point", std::vector<double>(points.begin(), points.end())));
        if (auto wrong = append(block_of(columns))) return wrong;
        written_[chunk] = complete;
    }
    return std::nullopt;
}

std::optional<text::Error> SweepJournal::take_result() {
    const auto text = files::read_file(file_);
    if (!text || !text->starts_with(mark_)) return refused(file_, "is there, and is not the result of this sweep");
    std::string_view rest = std::string_view(*text).substr(mark_.size());
    result_ = take_block(rest);
    return result_ && rest.empty() ? std::nullopt
                                   : std::optional(refused(file_, "has been changed since it was written"));
}

std::optional<text::Error> SweepJournal::finish(const Data& result) {
    const auto written = files::write_file(file_, mark_ + block_of(result.columns));
    if (written) discard();
    return written ? std::nullopt : std::optional(written.error());
}

void SweepJournal::discard() const {
    std::error_code error;
    fs::remove(path_, error);
}

SweepResults::SweepResults(std::size_t points, std::size_t chunk_size)
    : chunk_size_(chunk_size), done_(points, 0), done_in_chunk_((points + chunk_size - 1) / chunk_size) {}

double* SweepResults::column(std::string_view name) {
    const std::lock_guard lock(changing_);
    auto found = columns_.find(name);
    if (found == columns_.end()) {
        if (columns_.size() >= most_columns) return nullptr;
        std::vector<double> numbers(done_.size(), std::numeric_limits<double>::quiet_NaN());
        found = columns_.emplace(std::string(name), std::move(numbers)).first;
    }
    return found->second.data();
}

namespace {
constexpr std::uint64_t nan_of_words =
    0xFFF8'0000'0000'0000U;  ///< bits of a nan that stands for a word; its index is added
}

double SweepResults::word(std::string_view text) {
    const std::lock_guard lock(changing_);
    auto found = places_.find(text);
    if (found == places_.end()) {
        words_.emplace_back(text);
        found = places_.emplace(words_.back(), words_.size()).first;
    }
    return std::bit_cast<double>(nan_of_words | found->second);
}

std::optional<std::vector<std::string>> SweepResults::words(const std::vector<double>& numbers) const {
    const auto place = [this](double x) {
        const std::uint64_t bits = std::bit_cast<std::uint64_t>(x), of_word = bits & ~nan_of_words;
        return (bits & nan_of_words) == nan_of_words && of_word <= words_.size() ? of_word : 0;
    };
    if (std::ranges::none_of(numbers, place)) return std::nullopt;
    std::vector<std::string> words;
    words.reserve(numbers.size());
    for (const double x : numbers) {
        const std::uint64_t at = place(x);
        words.push_back(at > 0 ? words_[at - 1] : std::isnan(x) ? "" : fmt::format("{}", x));
    }
    return words;
}

void SweepResults::take(const std::vector<std::size_t>& points, std::span<const DataColumn> columns) {
    const DataColumn& errors = columns.back();
    for (std::size_t row = 0; row < points.size(); ++row) {
        const std::size_t point = points[row];
        if (is_done(point)) continue;
        if (errors.numbers() == nullptr && !errors.words()[row].empty()) {
            fail(point, errors.words()[row]);
            continue;
        }
        for (const DataColumn& own : columns.first(columns.size() - 1)) {
            if (double* numbers = column(own.name)) {
                numbers[point] = own.numbers() != nullptr ? own.numbers()->begin()[row] : word(own.words()[row]);
            }
        }
        finish(point);
    }
}

void SweepResults::fail(std::size_t point, std::string message) {
    std::replace_if(
        message.begin(), message.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    {
        const std::lock_guard lock(changing_);
        failures_[point] = std::move(message);
    }
    finish(point);
}

std::size_t SweepResults::done() const {
    return static_cast<std::size_t>(std::ranges::count(done_, 1));
}

const double* SweepResults::find(std::string_view name) const {
    const auto found = columns_.find(name);
    return found == columns_.end() ? nullptr : found->second.data();
}

std::vector<std::size_t> SweepResults::done_points() const {
    std::vector<std::size_t> points;
    points.reserve(done_.size());
    for (std::size_t point = 0; point < done_.size(); ++point) {
        if (is_done(point)) points.push_back(point);
    }
    return points;
}

std::vector<DataColumn> SweepResults::columns(const std::vector<std::size_t>& points) const {
    const std::lock_guard lock(changing_);
    std::vector<DataColumn> columns;
    for (const auto& [name, numbers] : columns_) {
        std::vector<double> values;
        values.reserve(points.size());
        for (const std::size_t point : points) values.push_back(numbers[point]);
        auto words = this->words(values);
        columns.push_back(words ? column_of(name, std::move(*words)) : column_of(name, std::move(values)));
    }
    std::vector<std::string> errors;
    for (const std::size_t point : points) {
        const auto failed = failures_.find(point);
        errors.push_back(failed != failures_.end() ? failed->second : "");
    }
    columns.push_back(column_of("error", std::move(errors)));
    return columns;
}

}  // namespace dinal::sweep
