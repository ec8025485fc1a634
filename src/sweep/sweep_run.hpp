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
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/data.hpp"
#include "files/csv.hpp"
#include "files/share.hpp"
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
    std::string file = {};              ///< none: it is not kept, and not shared with other processes
    double max_time = 0;                ///< seconds of a point; 0: any
    std::vector<double> settings = {};  ///< what else decides about the results
    /// In the state of a worker: replaces the carried function on the top by the one that is asked.
    std::function<void(lua_State* worker)> adapt = {};
    /// What the data are besides their columns.
    Data form = {};
    std::size_t looks = 1;  ///< rows of a point that has not failed
    /// The columns of these points, if they are others than the parameters and the results.
    std::function<std::vector<DataColumn>(const SweepResults& results, const std::vector<std::size_t>& points)> told =
        {};
};

/// An error of the call when the name of the file is none, or several processes would all do all of it.
void check_file_of_sweep(const lua::Options& options, const SweepOptions& asked);

/// All points. Raises when all of them fail; after Ctrl-C, when what is done is in dinal.partial, and the same task
/// goes on from there. With a file, and as one of several processes of a launcher, it does its share, and ends the
/// program unless it was the last.
Data swept(lua_State* L, const SweepTask& task);

/// sweep, bifurcation and minimise; in bind_sweep.cpp.
void register_sweep(lua_State* L);
extern const lua::Class sweep_functions;
void register_unfinished_sweep(lua_State* L);

// A sweep in files: chunks that have their final names only when they are whole, in a folder beside the file of the
// result, and the result itself, put together in order by whoever finds all chunks there.
//
// No lock, no server: what is done is a file, so a sweep that was killed, or runs on several machines, goes on from
// what it finds. A mark of grid and function keeps the chunks of different sweeps apart.

/// How many points a chunk has: what is lost at most when the process is killed, and a file each.
std::size_t chunk_size_for(std::size_t points);

class SweepFiles {
public:
    /// `mark` is that of what is asked. The file has so many rows for each point.
    SweepFiles(std::string file, const std::string& mark, const PointGrid& grid, SweepResults& results,
               std::size_t looks);

    /// Makes the folder, and takes what is done, or the result if the file is there. Fails when something of
    /// another sweep is there, or nothing can be written.
    std::optional<text::Error> open();
    [[nodiscard]] const std::optional<std::vector<DataColumn>>& result() const { return result_; }

    /// The points that are left in our share of the chunks.
    [[nodiscard]] std::vector<std::size_t> points(const files::Share& share) const;

    /// Writes the chunks that were completed since it was last asked, also while others work; or what there is of all.
    std::optional<text::Error> write_chunks(bool incomplete);

    /// Takes what others have done meanwhile; all is done. Of several that ask at once only one is told so.
    text::Expected<bool> take_all();
    /// The file of the result; the chunks go.
    std::optional<text::Error> finish(const Data& result);

    /// Nothing of it is worth keeping.
    void discard();

    [[nodiscard]] const std::string& folder() const { return folder_; }

private:
    [[nodiscard]] std::string chunk_file(std::size_t chunk) const;
    [[nodiscard]] bool has_chunks() const;
    [[nodiscard]] text::Error refused(const std::string& path, std::string_view why) const;
    std::optional<text::Error> check_mark();
    std::optional<text::Error> write(std::size_t chunk);
    std::optional<text::Error> take_chunks();
    std::optional<text::Error> take_result();
    std::optional<text::Error> take(const std::string& file);
    void remove_folder(const std::string& folder);

    std::string file_, folder_, mark_;
    const PointGrid& grid_;
    SweepResults& results_;
    std::size_t looks_;
    std::vector<bool> written_;  // chunks
    int opened_ = 0;
    std::optional<std::vector<DataColumn>> result_;
};

}  // namespace dinal::sweep
