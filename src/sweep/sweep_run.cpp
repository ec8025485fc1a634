#include "sweep/sweep_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "api/drive_options.hpp"
#include "files/confinement.hpp"
#include "files/file.hpp"
#include "lua/foreign.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/standard_globals.hpp"
#include "lua/worker_state.hpp"
#include "source/carry.hpp"
#include "source/fingerprint.hpp"
#include "terminal/progress.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::sweep {

using namespace api;

namespace {

// ---- The threads of a sweep, each with a Lua state of its own into which the user's function was carried.

/// What the workers share.
struct SweepWork {
    const PointGrid& grid;
    SweepResults& results;
    std::vector<std::size_t> points;  ///< to be done
    long long seed = 0;               ///< of math.random, with the number of the point
    const char* call = "sweep";       ///< heads sentences
    double max_time = 0;              ///< seconds of a point; 0: any
    /// In the state of a worker: replaces the carried function on the top by the one that is asked.
    const std::function<void(lua_State* worker)>& adapt;
    /// Asked 50 times a second on the thread that waits, and at the end: false ends it all.
    std::function<bool()> look = {};
    std::function<void()> after_point = {};  ///< where one thread does all
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

class SweepWorkers {
public:
    /// Carries the function at `index` to a new state for each worker. Raises when that is not possible. A function of
    /// another language stays where it is, and the thread of the call does all points.
    SweepWorkers(lua_State* L, int index, SweepWork& work) : work_(work) {
        if (const lua::Foreign* other = lua::foreign(L, index)) {
            if (work.max_time > 0) {
                lua::fail(
                    L, work.call,
                    {.sentence = fmt::format("max_time needs a Lua function, and this one is of {}", other->language),
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
            if (carrying.error) lua::fail(L, work.call, *carrying.error);
            if (!carried) lua::raise(L, std::string(work.call) + ": not enough memory for another worker");
        }
    }

    /// Does all points, or what can be done until a stop is requested. Raises when memory is lacking.
    void run(lua_State* L) {
        using std::chrono::milliseconds;
        constexpr milliseconds look_again{20};
        if (function_ != 0) return run_here(L);
        terminal::Progress progress =
            terminal::Progress::of_steps(work_.call, static_cast<double>(work_.points.size()));
        std::vector<std::thread> threads;
        threads.reserve(states_.size());
        start(threads);
        if (threads.empty())
            lua::raise(L, std::string(work_.call) + ": the operating system refuses to start a thread");
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

private:
    void run_here(lua_State* L) {
        terminal::Progress progress =
            terminal::Progress::of_steps(work_.call, static_cast<double>(work_.points.size()));
        lua::WorkerWatch watch;
        work_.after_point = [&] {
            progress.advance(static_cast<double>(work_.finished.load(std::memory_order_relaxed)));
        };
        lua_pushcfunction(L, lua::guarded<work_on_points>);
        lua_pushvalue(L, function_);
        if (work_.adapt) work_.adapt(L);
        lua_pushlightuserdata(L, &work_);
        lua_pushlightuserdata(L, &watch);
        lua_call(L, 3, 0);
    }

    void start(std::vector<std::thread>& threads) {
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
    /// Gives up what has taken too long.
    void watch(std::vector<std::thread>& threads) {
        const double now = now_in_seconds();
        for (std::size_t i = 0; i < threads.size(); ++i) {
            lua::WorkerWatch& own = watches_[i];
            const std::uint64_t task = own.task;
            if (now - own.since <= work_.max_time) continue;
            own.given_up = task;  // no other one, should it have ended meanwhile
            lua::nudge(threads[i].native_handle());
        }
    }

    SweepWork& work_;
    std::vector<lua::OwnedState> states_;
    std::deque<lua::WorkerWatch> watches_;  // of the threads
    std::mutex ending_;
    std::condition_variable ended_;
    std::size_t running_ = 0;
    std::string trouble_;
    int function_ = 0;  // on the stack, of another language; 0: it is in the states
};

// ---- what Ctrl-C has broken off, for the same call to go on

const char unfinished_key = 0;  // in the registry

struct Unfinished {
    std::uint64_t asked = 0;
    std::shared_ptr<SweepResults> results = {};
};

std::shared_ptr<SweepResults> take_unfinished(lua_State* L, std::uint64_t asked) {
    std::shared_ptr<SweepResults> results;
    lua_rawgetp(L, LUA_REGISTRYINDEX, &unfinished_key);
    if (const auto* unfinished = lua::test<Unfinished>(L, -1); unfinished != nullptr && unfinished->asked == asked) {
        results = unfinished->results;
    }
    lua_pop(L, 1);
    return results;
}

void keep_unfinished(lua_State* L, std::uint64_t asked, const std::shared_ptr<SweepResults>& results) {
    results == nullptr ? lua_pushnil(L) : static_cast<void>(lua::push(L, Unfinished{asked, results}));
    lua_rawsetp(L, LUA_REGISTRYINDEX, &unfinished_key);
}

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
    print.add_value(task.function);
    return print.number();
}

struct Failures {
    std::size_t count = 0;
    std::string place, message;  ///< of the first one: "r = 0.5, g = 1"
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

std::size_t worker_count(const std::optional<double>& asked, std::size_t points) {
    const std::size_t cores = lua::in_worker() ? 1 : std::max(1U, std::thread::hardware_concurrency());
    return std::clamp<std::size_t>(asked ? static_cast<std::size_t>(*asked) : cores, 1,
                                   std::max<std::size_t>(points, 1));
}

const lua::Class unfinished_class = {"unfinished sweep", {"", "", ""}, std::span<const lua::Member>()};

class SweepRun {
public:
    SweepRun(lua_State* L, const SweepTask& task) : L_(L), task_(task), print_(fingerprint_of(L, task)) {}

    Data run() {
        task_.file.empty() ? take_memory() : open_files();
        if (files_ && files_->result()) {
            if (share_.rank > 0) leave();
            return told(*files_->result());
        }
        work();
        if (lua::interrupt_requested()) stop();
        if (trouble_) fail();
        return files_ ? finished_in_files() : finished();
    }

private:
    void take_memory() {
        results_ = take_unfinished(L_, print_);
        if (results_ == nullptr) results_ = std::make_shared<SweepResults>(task_.grid.size(), task_.grid.size());
        for (std::size_t point = 0; point < task_.grid.size(); ++point) {
            if (!results_->is_done(point)) points_.push_back(point);
        }
    }

    void open_files() {
        lua::refuse_in_worker(L_, "a sweep with a file");
        if (const lua::Foreign* other = lua::foreign(L_, task_.function)) {
            lua::fail(L_, task_.call,
                      {.sentence = fmt::format(
                           "file needs a Lua function, because a change in one of {} cannot be detected; save the "
                           "result instead",
                           other->language),
                       .option = "file"});
        }
        const auto share = lua::value_or_raise(L_, task_.call, files::share_of_launcher());
        share_ = share.value_or(files::Share{});
        launched_ = share.has_value();
        results_ = std::make_shared<SweepResults>(task_.grid.size(), chunk_size_for(task_.grid.size()));
        files_.emplace(task_.file, fmt::format("{:016x}", print_), task_.grid, *results_, task_.looks);
        if (const auto wrong = files_->open()) lua::fail(L_, task_.call, *wrong);
        if (!files_->result()) points_ = files_->points(share_);
    }

    void work() {
        SweepWork work{.grid = task_.grid,
                       .results = *results_,
                       .points = std::move(points_),
                       .seed = static_cast<long long>(task_.seed),
                       .call = task_.call,
                       .max_time = task_.max_time,
                       .adapt = task_.adapt};
        if (files_) {
            work.look = [this] {
                trouble_ = files_->write_chunks(false);
                return !trouble_;
            };
        }
        // The processes of a launcher have a core each.
        const auto cores = launched_ && !task_.workers ? std::optional(1.0) : task_.workers;
        work.workers = worker_count(cores, work.points.size());
        SweepWorkers workers(L_, task_.function, work);
        workers.run(L_);
    }

    /// With what the first line says when points have failed: nobody looks into a column that should be empty.
    [[nodiscard]] Data told(std::vector<DataColumn> columns) const {
        Data data = task_.form;
        data.columns = std::move(columns);
        if (const Failures failed = failures_in(data, task_.grid); failed.count > 0) {
            data.heading = text::wrapped(fmt::format("data: {} points, {} of them failed; the first one, {}: {}",
                                                     task_.grid.size(), failed.count, failed.place, failed.message));
        }
        return data;
    }

    /// What is done.
    [[nodiscard]] Data told() const {
        const std::vector<std::size_t> points = results_->done_points();
        if (task_.told) return told(task_.told(*results_, points));
        std::vector<DataColumn> columns = task_.grid.columns(points);
        for (DataColumn& column : results_->columns(points)) columns.push_back(std::move(column));
        return told(std::move(columns));
    }

    [[noreturn]] void stop() {
        if (files_ && lua::stop_requested() != lua::Stop::memory) {
            const lua::InSpiteOfStop writes;
            static_cast<void>(files_->write_chunks(true));
        }
        if (!files_) keep_unfinished(L_, print_, results_);
        push_data(L_, told());
        set_partial(L_);
        lua::raise_interrupted(L_);
    }

    [[noreturn]] void fail() {
        push_data(L_, told());
        set_partial(L_);
        trouble_->sentence += fmt::format(
            "; finished points are kept in '{}' and dinal.partial, and the same call continues", files_->folder());
        lua::fail(L_, task_.call, *trouble_);
    }

    /// A mistake in the function makes all points fail; that is one error, and no map.
    void raise_if_all_failed(const Data& data) const {
        const Failures failed = failures_in(data, task_.grid);
        if (failed.count < task_.grid.size()) return;
        const std::string sentence =
            failed.count == 1 ? fmt::format("{}: the point {} failed: {}", task_.call, failed.place, failed.message)
                              : fmt::format("{}: all {} points failed; the first one, {}: {}", task_.call, failed.count,
                                            failed.place, failed.message);
        lua::raise(L_, {.sentence = sentence, .call = task_.call});
    }

    Data finished() {
        keep_unfinished(L_, 0, nullptr);
        Data data = told();
        raise_if_all_failed(data);
        return data;
    }

    Data finished_in_files() {
        const bool last = lua::value_or_raise(L_, task_.call, files_->take_all());
        if (!last && share_.size > 1) leave();
        Data data = told();
        if (results_->failures().size() == results_->size()) {
            files_->discard();
            raise_if_all_failed(data);
        }
        if (const auto wrong = last ? files_->finish(data) : std::nullopt) lua::fail(L_, task_.call, *wrong);
        return data;
    }

    /// What comes after the sweep is for the process that has all of it.
    [[noreturn]] void leave() const {
        const std::string text =
            files_->result()
                ? fmt::format("dinal: '{}' is there; process 0 of {} continues the script\n", task_.file, share_.size)
                : fmt::format(
                      "dinal: share {} of {} is done, {} of all {} points; the process that does the last share "
                      "continues the script\n",
                      share_.rank, share_.size, results_->done(), results_->size());
        static_cast<void>(std::fputs(text.c_str(), stderr));
        // By os.exit, which Python replaces by one that raises SystemExit.
        if (lua_getglobal(L_, LUA_OSLIBNAME) == LUA_TTABLE && lua_getfield(L_, -1, "exit") == LUA_TFUNCTION) {
            lua_call(L_, 0, 0);
        }
        std::exit(0);  // NOLINT(concurrency-mt-unsafe): the workers have ended
    }

    lua_State* L_;
    const SweepTask& task_;
    std::uint64_t print_;
    std::shared_ptr<SweepResults> results_;
    std::vector<std::size_t> points_;
    std::optional<SweepFiles> files_;
    files::Share share_;
    bool launched_ = false;
    std::optional<text::Error> trouble_;
};

}  // namespace

void check_file_of_sweep(const lua::Options& options, const SweepOptions& asked) {
    if (options.has("file")) {
        if (text::ending_of(asked.file) == ".csv") return;
        options.fail("file", fmt::format("the name '{}' must end in .csv", asked.file));
    }
    if (lua::in_worker()) return;
    const auto share = options.value_or_fail(files::share_of_launcher());
    if (!share || share->size == 1) return;
    options.fail("file", fmt::format("this is process {} of {}, which share their work in a file: give one, file = "
                                     "\"map.csv\"",
                                     share->rank, share->size));
}

Data swept(lua_State* L, const SweepTask& task) {
    return SweepRun(L, task).run();
}

void register_unfinished_sweep(lua_State* L) {
    lua::add_class<Unfinished>(L, unfinished_class);
}

namespace {

namespace fs = std::filesystem;

constexpr const char* point_column = "point of the grid";

/// The line above a table that says which of its results, from `first` to the one before `error`, are words: a damaged
/// number is not taken for one.
template <class Columns, class IsWords>
std::string note_of(const Columns& columns, std::size_t first, IsWords is_words) {
    std::vector<std::string> names;
    for (std::size_t i = first; i + 1 < columns.size(); ++i) {
        if (std::invoke(is_words, columns[i])) names.push_back(columns[i].name);
    }
    return names.empty() ? "" : fmt::format("words in {}", fmt::join(names, ", "));
}

/// Writes a table whose results begin with the column `first`.
text::Expected<files::Written> write_table(const std::string& file, std::span<const DataColumn> columns,
                                           std::size_t first, const std::string& mark = "") {
    std::vector<files::NamedColumn> named;
    for (const DataColumn& column : columns) named.push_back(column.named());
    const std::string note = note_of(columns, first, [](const DataColumn& c) { return c.numbers() == nullptr; });
    const std::string comment(text::trimmed(mark + " " + note));
    const std::span<const std::string> comments(&comment, comment.empty() ? 0 : 1);
    return files::write_csv(file, named, comments, files::Gaps::written);
}

/// Whether what was read is as it was written, with this note about words.
bool is_sound(const std::vector<files::ReadColumn>& columns, std::size_t first, std::string_view note) {
    return columns.size() > first && columns.back().name == "error" &&
           text::trimmed(note) == note_of(columns, first, &files::ReadColumn::of_words);
}

/// The messages in the last column; an empty column of words is one of nan.
std::vector<std::string> messages_of(const files::ReadColumn& column) {
    return column.of_words ? column.words : std::vector<std::string>(column.numbers.size());
}

constexpr std::string_view was_changed = "has been changed since it was written";

/// What we write ends with its last line. Files come under their names when they are whole; but a power failure, or a
/// copy to another machine that was broken off, can leave a part of one.
bool is_cut_off(const std::string& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return false;
    const auto text = files::read_file(file);
    return text && !text->ends_with('\n');
}

/// Nothing is made, renamed, read or removed through a link, which may lead anywhere.
bool is_wrong_kind(const std::string& path, fs::file_type wanted) {
    std::error_code error;
    const fs::file_type found = fs::symlink_status(path, error).type();
    return found != wanted && found != fs::file_type::not_found;
}

}  // namespace

std::size_t chunk_size_for(std::size_t points) {
    constexpr std::size_t chunks = 256, most = 100'000;
    return std::clamp<std::size_t>((points + chunks - 1) / chunks, 1, most);
}

SweepFiles::SweepFiles(std::string file, const std::string& mark, const PointGrid& grid, SweepResults& results,
                       std::size_t looks)
    : file_(std::move(file)),
      folder_(file_ + ".parts"),
      mark_("sweep " + mark),
      grid_(grid),
      results_(results),
      looks_(looks),
      written_(results.chunks()) {}

std::string SweepFiles::chunk_file(std::size_t chunk) const {
    return fmt::format("{}/{:06}.csv", folder_, chunk);
}

bool SweepFiles::has_chunks() const {
    std::error_code error;
    const fs::directory_iterator all(folder_, error);
    return std::any_of(begin(all), end(all),
                       [](const fs::directory_entry& one) { return one.path().extension() == ".csv"; });
}

text::Error SweepFiles::refused(const std::string& path, std::string_view why) const {
    return {.sentence = fmt::format("'{}' {}; remove it, or give another file", path, why),
            .option = "file",
            .culprit = file_};
}

std::optional<text::Error> SweepFiles::check_mark() {
    const std::string path = folder_ + "/mark";
    if (is_wrong_kind(path, fs::file_type::regular)) return refused(path, "is not a regular file");
    if (const auto mark = files::read_file(path)) {
        if (*mark == mark_ + "\n") return std::nullopt;
        if (has_chunks())
            return text::Error{
                .sentence = fmt::format("'{}' holds the chunks of another sweep: its grid or its function was "
                                        "another; remove it, or give another file",
                                        folder_),
                .option = "file",
                .culprit = file_};
    }
    const auto written = files::write_file(path, mark_ + "\n");
    return written ? std::nullopt : std::optional(written.error());
}

std::optional<text::Error> SweepFiles::open() {
    if (const auto why = files::outside(file_, files::Access::write)) {
        return text::Error{.sentence = fmt::format("cannot write '{}': {}", file_, *why), .option = "file"};
    }
    for (const std::string& folder : {folder_, folder_ + ".merging"}) {
        if (is_wrong_kind(folder, fs::file_type::directory)) return refused(folder, "is not a folder");
    }
    std::error_code error;
    if (fs::exists(file_, error)) return take_result();
    // Somebody was killed between taking the folder and writing the file.
    if (!fs::exists(folder_, error) && fs::exists(folder_ + ".merging", error)) {
        fs::rename(folder_ + ".merging", folder_, error);
    }
    fs::create_directory(folder_, error);
    if (error) {
        return text::Error{.sentence = fmt::format("cannot make the folder '{}': {}", folder_, error.message()),
                           .option = "file",
                           .culprit = file_};
    }
    // Somebody may have finished it since we looked: then the folder is ours and empty.
    if (fs::exists(file_, error)) {
        fs::remove(folder_, error);
        return take_result();
    }
    if (auto wrong = check_mark()) {
        // Somebody may have taken the folder away under us, as all of it was done: then there is his result.
        constexpr int often_enough = 10;
        return !fs::exists(folder_, error) && ++opened_ < often_enough ? open() : wrong;
    }
    return take_chunks();
}

std::optional<text::Error> SweepFiles::take_result() {
    auto read = files::read_columns(file_);
    if (!read || read->comments.empty() || !read->comments.front().starts_with(mark_)) {
        return refused(file_, "is there, and is not the result of this sweep");
    }
    const std::string note = read->comments.front().substr(mark_.size());
    std::vector<files::ReadColumn> columns = std::move(read).value().columns;
    const std::size_t first = grid_.parameters().size();
    if (is_cut_off(file_) || !is_sound(columns, first, note)) return refused(file_, was_changed);
    const std::vector<std::string> errors = messages_of(columns.back());
    std::vector<std::size_t> points;
    std::size_t point = 0, look = 0;
    for (const std::string& error : errors) {
        points.push_back(point);
        if (++look < looks_ && error.empty()) continue;
        ++point, look = 0;
    }
    if (point != results_.size() || look != 0) return refused(file_, was_changed);
    result_ = grid_.columns(points);
    columns.pop_back();
    for (std::size_t i = first; i < columns.size(); ++i) result_->push_back(column_of(std::move(columns[i])));
    result_->push_back(column_of("error", errors));
    remove_folder(folder_ + ".merging");  // a process was killed before the last of its work
    return {};
}

std::optional<text::Error> SweepFiles::take_chunks() {
    for (std::size_t chunk = 0; chunk < results_.chunks(); ++chunk) {
        std::error_code error;
        if (results_.is_complete(chunk)) continue;
        if (is_wrong_kind(chunk_file(chunk), fs::file_type::regular))
            return refused(chunk_file(chunk), "is not a regular file");
        if (!fs::exists(chunk_file(chunk), error)) continue;
        if (is_cut_off(chunk_file(chunk))) continue;  // done anew
        if (auto wrong = take(chunk_file(chunk))) return wrong;
        written_[chunk] = results_.is_complete(chunk);
    }
    return std::nullopt;
}

std::optional<text::Error> SweepFiles::take(const std::string& file) {
    const auto read = files::read_columns(file);
    std::error_code error;
    if (!read && !fs::exists(folder_, error)) return std::nullopt;  // another process has found all, and took it away
    if (!read) return read.error();
    const std::vector<files::ReadColumn>& columns = read->columns;
    constexpr std::size_t first = 1;
    if (!is_sound(columns, first, read->comments.empty() ? "" : read->comments.front()) || columns[0].of_words) {
        return refused(file, was_changed);
    }
    std::vector<std::string> errors = messages_of(columns.back());
    for (std::size_t row = 0; row < errors.size(); ++row) {
        const double place = columns[0].numbers[row];
        if (!(place >= 0 && place < static_cast<double>(results_.size()))) return refused(file, was_changed);
        const auto point = static_cast<std::size_t>(place);
        if (results_.is_done(point)) continue;
        if (!errors[row].empty()) {
            results_.fail(point, std::move(errors[row]));
            continue;
        }
        for (std::size_t i = first; i + 1 < columns.size(); ++i) {
            if (double* numbers = results_.column(columns[i].name)) {
                const files::ReadColumn& column = columns[i];
                numbers[point] = column.of_words ? results_.word(column.words[row]) : column.numbers[row];
            }
        }
        results_.finish(point);
    }
    return std::nullopt;
}

std::vector<std::size_t> SweepFiles::points(const files::Share& share) const {
    std::vector<std::size_t> points;
    for (std::size_t point = 0; point < results_.size(); ++point) {
        const auto chunk = static_cast<long long>(point / results_.chunk_size());
        if (chunk % share.size == share.rank && !results_.is_done(point)) points.push_back(point);
    }
    return points;
}

std::optional<text::Error> SweepFiles::write(std::size_t chunk) {
    const std::size_t first = chunk * results_.chunk_size();
    const std::size_t last = std::min(first + results_.chunk_size(), results_.size());
    std::vector<std::size_t> points;
    for (std::size_t point = first; point < last; ++point) {
        if (results_.is_done(point)) points.push_back(point);
    }
    if (points.empty()) return std::nullopt;
    std::vector<DataColumn> columns = results_.columns(points);
    columns.insert(columns.begin(), column_of(point_column, std::vector<double>(points.begin(), points.end())));
    const auto written = write_table(chunk_file(chunk), columns, 1);
    if (written) return std::nullopt;
    // Somebody with the same share, who was not killed after all, may have done it, and all of it be finished.
    std::error_code error;
    const bool taken =
        !fs::exists(folder_, error) && (fs::exists(file_, error) || fs::exists(folder_ + ".merging", error));
    return taken ? std::nullopt : std::optional(written.error());
}

std::optional<text::Error> SweepFiles::write_chunks(bool incomplete) {
    for (std::size_t chunk = 0; chunk < results_.chunks(); ++chunk) {
        const bool complete = results_.is_complete(chunk);
        if (written_[chunk] || !(complete || incomplete)) continue;
        if (auto wrong = write(chunk)) return wrong;
        written_[chunk] = complete;
    }
    return std::nullopt;
}

text::Expected<bool> SweepFiles::take_all() {
    if (auto wrong = take_chunks()) return *wrong;
    if (results_.done() < results_.size()) return false;
    std::error_code error;
    fs::rename(folder_, folder_ + ".merging", error);
    return !error;
}

std::optional<text::Error> SweepFiles::finish(const Data& result) {
    const auto written = write_table(file_, result.columns, grid_.parameters().size(), mark_);
    std::error_code error;
    if (!written) {
        fs::rename(folder_ + ".merging", folder_, error);
        return written.error();
    }
    remove_folder(folder_ + ".merging");
    return std::nullopt;
}

void SweepFiles::discard() {
    remove_folder(folder_);
    remove_folder(folder_ + ".merging");
}

/// With what we have written into it, and nothing else; what a killed process was writing is ours, too.
void SweepFiles::remove_folder(const std::string& folder) {
    if (is_wrong_kind(folder, fs::file_type::directory)) return;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
        if (entry.path().filename().string().starts_with(".dinal-")) fs::remove(entry.path(), error);
    }
    for (std::size_t chunk = 0; chunk < results_.chunks(); ++chunk) {
        fs::remove(fmt::format("{}/{:06}.csv", folder, chunk), error);
    }
    fs::remove(folder + "/mark", error);
    fs::remove(folder, error);
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
constexpr std::uint64_t nan_of_words = 0xFFF8'0000'0000'0000U;  ///< and the place of the word
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
    if (std::none_of(numbers.begin(), numbers.end(), place)) return std::nullopt;
    std::vector<std::string> words;
    words.reserve(numbers.size());
    for (const double x : numbers) {
        const std::uint64_t at = place(x);
        words.push_back(at > 0 ? words_[at - 1] : std::isnan(x) ? "" : fmt::format("{}", x));
    }
    return words;
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
    return static_cast<std::size_t>(std::count(done_.begin(), done_.end(), 1));
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
