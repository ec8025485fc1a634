#include "api/sweep_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "api/classes.hpp"
#include "api/sweep_workers.hpp"
#include "files/file.hpp"
#include "lua/foreign.hpp"
#include "lua/interrupt.hpp"
#include "lua/standard_globals.hpp"
#include "lua/worker_state.hpp"
#include "source/fingerprint.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::api {
namespace {

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

void set_partial_sweep(lua_State* L, const SweepTask& task, const SweepResults& results) {
    lua::push_dinal_table(L);
    push_data(L, task.told(task.grid, results));
    lua_setfield(L, -2, "partial");
    lua_pop(L, 1);
}

void add_column(source::Fingerprint& print, const DataColumn& column) {
    print.add(column.name);
    print.add(static_cast<double>(column.size()));
    if (const lua::Vector* numbers = column.numbers()) {
        for (const double x : numbers->values()) print.add(x);
    } else {
        for (const std::string& word : *std::get<Words>(column.values)) print.add(word);
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
    const SweepGrid& grid = task.grid;
    for (const DataColumn& parameter : grid.parameters()) add_column(print, parameter);
    print.add(task.seed);
    print.add_value(task.function);
    return print.number();
}

/// A mistake in the function makes all points fail; that is one error, and no map.
void raise_if_all_failed(lua_State* L, const SweepTask& task, const SweepResults& results) {
    const SweepGrid& grid = task.grid;
    if (results.failures().size() < results.size()) return;
    const auto& [point, message] = *results.failures().begin();
    lua::raise(L, {.sentence = grid.size() == 1
                                   ? fmt::format("{}: the point {} failed: {}", task.call, grid.text(point), message)
                                   : fmt::format("{}: all {} points failed; the first one, {}: {}", task.call,
                                                 grid.size(), grid.text(point), message),
                   .call = task.call});
}

std::size_t worker_count(const std::optional<double>& asked, std::size_t points) {
    const std::size_t cores = lua::in_worker() ? 1 : std::max(1U, std::thread::hardware_concurrency());
    return std::clamp<std::size_t>(asked ? static_cast<std::size_t>(*asked) : cores, 1,
                                   std::max<std::size_t>(points, 1));
}

const lua::Class unfinished_class = {"unfinished sweep", {"", "", ""}, std::span<const lua::Member>()};

/// Ctrl-C must not stop what is written because of it.
class WritesOn {
public:
    WritesOn() {
        files::set_stop_question([]() noexcept { return false; });
    }
    ~WritesOn() { files::set_stop_question(lua::interrupt_requested); }
    WritesOn(const WritesOn&) = delete;
    WritesOn& operator=(const WritesOn&) = delete;
};

class SweepRun {
public:
    SweepRun(lua_State* L, const SweepTask& task) : L_(L), task_(task), print_(fingerprint_of(L, task)) {}

    std::shared_ptr<SweepResults> run() {
        task_.file.empty() ? take_memory() : open_files();
        if (files_ && files_->is_finished()) {
            if (share_.rank > 0) leave();
            return results_;
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
            lua::raise(L_,
                       {.sentence = fmt::format(
                            "{}: file needs a Lua function, because a change in one of {} cannot be detected; save the "
                            "result instead",
                            task_.call, other->language),
                        .call = task_.call,
                        .option = "file"});
        }
        const auto share = lua::value_or_raise(L_, task_.call, files::share_of_launcher());
        share_ = share.value_or(files::Share{});
        launched_ = share.has_value();
        results_ = std::make_shared<SweepResults>(task_.grid.size(), chunk_size_for(task_.grid.size()));
        files_.emplace(task_.file, fmt::format("{:016x}", print_), task_.grid, *results_, task_.taken);
        if (const auto wrong = files_->open()) lua::raise(L_, text::in_call(task_.call, *wrong));
        if (!files_->is_finished()) points_ = files_->points(share_);
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
                trouble_ = files_->write_complete();
                return !trouble_;
            };
        }
        // The processes of a launcher have a core each.
        const auto cores = launched_ && !task_.workers ? std::optional(1.0) : task_.workers;
        work.workers = worker_count(cores, work.points.size());
        SweepWorkers workers(L_, task_.function, work);
        workers.run(L_);
    }

    [[noreturn]] void stop() {
        if (files_ && lua::stop_requested() != lua::Stop::memory) {
            const WritesOn writes;
            static_cast<void>(files_->write_incomplete());
        }
        if (!files_) keep_unfinished(L_, print_, results_);
        set_partial_sweep(L_, task_, *results_);
        lua::raise_interrupted(L_);
    }

    [[noreturn]] void fail() {
        set_partial_sweep(L_, task_, *results_);
        trouble_->sentence += fmt::format(
            "; finished points are kept in '{}' and dinal.partial, and the same call continues", files_->folder());
        lua::raise(L_, text::in_call(task_.call, *trouble_));
    }

    std::shared_ptr<SweepResults> finished() {
        keep_unfinished(L_, 0, nullptr);
        raise_if_all_failed(L_, task_, *results_);
        return results_;
    }

    std::shared_ptr<SweepResults> finished_in_files() {
        const bool last = lua::value_or_raise(L_, task_.call, files_->take_all());
        if (!last && share_.size > 1) leave();
        if (results_->failures().size() == results_->size()) {
            files_->discard();
            raise_if_all_failed(L_, task_, *results_);
        }
        if (const auto wrong = last ? files_->finish(task_.told(task_.grid, *results_)) : std::nullopt) {
            lua::raise(L_, text::in_call(task_.call, *wrong));
        }
        return results_;
    }

    /// What comes after the sweep is for the process that has all of it.
    [[noreturn]] void leave() const {
        const std::string text =
            files_->is_finished()
                ? fmt::format("dinal: '{}' is there; process 0 of {} continues the script\n", task_.file, share_.size)
                : fmt::format(
                      "dinal: share {} of {} is done, {} of all {} points; the process that does the last share "
                      "continues the script\n",
                      share_.rank, share_.size, results_->done(), results_->size());
        static_cast<void>(std::fputs(text.c_str(), stderr));
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

/// What the first line of the map says when points have failed: nobody looks into a column that should be empty.
std::string heading_of_map(const SweepGrid& grid, const SweepResults& results) {
    if (results.failures().empty()) return "";
    const auto& [point, message] = *results.failures().begin();
    return text::wrapped(fmt::format("data: {} points, {} of them failed; the first one, {}: {}", grid.size(),
                                     results.failures().size(), grid.text(point), message));
}

void check_file_of_sweep(const lua::Options& options, const SweepOptions& asked) {
    if (options.has("file")) {
        if (text::ending_of(asked.file) == ".csv") return;
        options.fail("file", fmt::format("the name '{}' must end in .csv", asked.file));
    }
    if (lua::in_worker()) return;
    const auto share = options.value_or_fail(files::share_of_launcher());
    if (!share || share->size == 1) return;
    options.fail(
        {.sentence = fmt::format("this is process {} of {}, which share their work in a file: give one, file = "
                                 "\"map.csv\"",
                                 share->rank, share->size),
         .option = "file"});
}

std::shared_ptr<SweepResults> swept(lua_State* L, const SweepTask& task) {
    return SweepRun(L, task).run();
}

void register_unfinished_sweep(lua_State* L) {
    lua::add_class<Unfinished>(L, unfinished_class);
}

}  // namespace dinal::api
