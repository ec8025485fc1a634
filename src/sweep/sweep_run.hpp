// A sweep from the call to its results: what was broken off before, the workers, Ctrl-C.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/data.hpp"
#include "files/csv.hpp"
#include "lua/options.hpp"
#include "sweep/sweep_options.hpp"
#include "text/expected.hpp"

namespace dinal::sweep {

using api::Data, api::DataColumn, api::PointGrid;

// What the points of a sweep gave: named columns that several threads fill, each its own points.

class SweepResults {
public:
    /// Told chunk by chunk: so many points each.
    explicit SweepResults(std::size_t points, std::size_t chunk_size);

    /// The numbers of a column, nan until they are set; made when it is first asked for, nullptr when there are too
    /// many. It stays where it is.
    double* column(std::string_view name);
    static constexpr std::size_t most_columns = 20'000;

    /// Adds results of these points, by name; the last column has the messages.
    void take(const std::vector<std::size_t>& points, std::span<const DataColumn> columns);

    /// A word as a number that can stand in a column: a nan of its own.
    double word(std::string_view text);

    /// The point has all its numbers, or a message instead. Each point is told once, by one thread.
    void finish(std::size_t point) {
        done_[point] = 1;
        done_in_chunk_[point / chunk_size_].fetch_add(1, std::memory_order_release);
    }
    void fail(std::size_t point, std::string message);

    [[nodiscard]] std::size_t size() const { return done_.size(); }
    [[nodiscard]] bool is_done(std::size_t point) const { return done_[point] != 0; }
    [[nodiscard]] std::size_t chunk_size() const { return chunk_size_; }
    [[nodiscard]] std::size_t chunks() const { return done_in_chunk_.size(); }
    /// Also while others work: once it is true, what the chunk gave does not change any more.
    [[nodiscard]] bool is_complete(std::size_t chunk) const {
        const std::size_t first = chunk * chunk_size_;
        return done_in_chunk_[chunk].load(std::memory_order_acquire) == std::min(chunk_size_, size() - first);
    }
    /// All results of these points by their names, then `error`, empty where there is none. Also while others work, of
    /// points that are done.
    [[nodiscard]] std::vector<DataColumn> columns(const std::vector<std::size_t>& points) const;

    // What follows is for one thread, while no other changes anything.

    [[nodiscard]] const std::map<std::size_t, std::string>& failures() const { return failures_; }
    [[nodiscard]] std::size_t done() const;
    /// nullptr when there is none of this name.
    [[nodiscard]] const double* find(std::string_view name) const;
    /// The points that are done, in their order.
    [[nodiscard]] std::vector<std::size_t> done_points() const;

private:
    /// These numbers of a column as words, when a word is among them.
    [[nodiscard]] std::optional<std::vector<std::string>> words(const std::vector<double>& numbers) const;

    std::size_t chunk_size_;
    mutable std::mutex changing_;  // of the columns, the failures and the words, not of the numbers
    std::map<std::string, std::vector<double>, std::less<>> columns_;
    std::map<std::size_t, std::string> failures_;
    std::vector<std::string> words_;
    std::map<std::string, std::uint64_t, std::less<>> places_;  // of the words, from 1
    std::vector<unsigned char> done_;
    std::vector<std::atomic<std::size_t>> done_in_chunk_;
};

struct SweepTask {
    const char* call;  ///< heads sentences
    const PointGrid& grid;
    int function;  ///< its index on the stack
    std::optional<double> workers = {};
    double seed = 0;
    std::string file = {};  ///< none: it is not kept
    double max_time = 0;    ///< seconds of a point; 0: any
    std::string mark = {};  ///< stands for the function where it is written in another language
    std::optional<std::pair<std::size_t, std::size_t>> points = {};  ///< these alone, to the one before the second
    std::vector<double> settings = {};                               ///< what else decides about the results
    /// In the state of a worker: replaces the carried function on the top by the one that is asked.
    std::function<void(lua_State* worker)> adapt = {};
    /// What the data are besides their columns.
    Data form = {};
    /// The columns of these points, if they are others than the parameters and the results.
    std::function<std::vector<DataColumn>(const SweepResults& results, const std::vector<std::size_t>& points)> told =
        {};
};

/// An error of the call when the name of the file is none.
void check_file_of_sweep(const lua::Options& options, const SweepOptions& asked);

/// All points. Raises when all of them fail; after Ctrl-C, when what is done is in dinal.partial, and the same task
/// goes on from there, with a file also in another process.
Data swept(lua_State* L, const SweepTask& task);

/// Pushes a sweep whose points the caller computes: left(), take(first, data), keep() and finish().
void push_parted(lua_State* L, std::vector<DataColumn> parameters,
                 const std::function<SweepTask(const PointGrid&)>& task);
/// sweep{ ... }
int run_sweep(lua_State* L);
/// Does that for the options of sweep, and the mark of a function of another language.
int sweep_in_parts(lua_State* L);

/// sweep, bifurcation and minimise; in bind_sweep.cpp.
void register_sweep(lua_State* L);
extern const lua::Class sweep_functions;
void register_unfinished_sweep(lua_State* L);

/// The number of points of a chunk: at most so many are lost when the process is killed.
std::size_t chunk_size_for(std::size_t points);

/// The finished points of a sweep in FILE.part, to whose end chunks are added as they are completed, by this process
/// alone; in the end they become the file. What a death has cut off is not taken. A mark of grid and function keeps
/// different sweeps apart.
class SweepJournal {
public:
    /// `mark` is that of what is asked.
    SweepJournal(std::string file, const std::string& mark, SweepResults& results);

    /// Takes what is done, or the result if the file is there. Fails when something of another sweep is there, another
    /// process is at it, or nothing can be written.
    std::optional<text::Error> open();
    [[nodiscard]] const std::optional<std::vector<DataColumn>>& result() const { return result_; }

    /// Adds the chunks that were completed since it was last asked, also while others work; or what there is of all.
    std::optional<text::Error> write(bool incomplete);
    /// The file of the result; the journal goes.
    std::optional<text::Error> finish(const Data& result);
    /// Nothing of it is worth keeping.
    void discard() const;

    [[nodiscard]] const std::string& path() const { return path_; }

private:
    [[nodiscard]] text::Error refused(const std::string& path, std::string_view why) const;
    std::optional<text::Error> take_points();
    std::optional<text::Error> take_result();
    std::optional<text::Error> append(std::string_view text);

    std::string file_, path_, mark_;
    SweepResults& results_;
    std::vector<bool> written_;  // chunks
    std::shared_ptr<files::Descriptor> journal_ = {};
    std::size_t size_ = 0;  // of what is whole in it
    std::optional<std::vector<DataColumn>> result_;
};

}  // namespace dinal::sweep
