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
#include "api/sweep_options.hpp"
#include "files/csv.hpp"
#include "files/share.hpp"
#include "lua/options.hpp"
#include "text/expected.hpp"

namespace dinal::api {

// What the points of a sweep gave: named columns that several threads fill, each its own points.

// The points of a sweep: every combination of the values of its parameters, the last parameter changing fastest.

class SweepGrid {
public:
    /// Each column is a parameter with at least one value.
    explicit SweepGrid(std::vector<DataColumn> parameters);

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] const std::vector<DataColumn>& parameters() const { return parameters_; }
    /// Which value of the parameter this point has.
    [[nodiscard]] std::size_t place(std::size_t parameter, std::size_t point) const {
        return point / strides_[parameter] % parameters_[parameter].size();
    }
    /// "r = 0.5, g = 1"
    [[nodiscard]] std::string text(std::size_t point) const;
    /// Sets the table on the top of the stack to the parameters of this point.
    void set_fields(lua_State* L, std::size_t point) const;
    /// The parameters as columns with a row for each of these points.
    [[nodiscard]] std::vector<DataColumn> columns(const std::vector<std::size_t>& points) const;

private:
    std::vector<DataColumn> parameters_;
    std::vector<std::size_t> strides_;
    std::size_t size_ = 1;
};

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
    /// These numbers of a column as words, when a word is among them.
    [[nodiscard]] std::optional<std::vector<std::string>> words(const std::vector<double>& numbers) const;

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
    /// A snapshot of its names, their numbers, and the messages of those that failed among the points [first, last).
    struct Piece {
        std::vector<std::pair<std::string, const double*>> columns;
        std::map<std::size_t, std::string> failures;
    };
    [[nodiscard]] Piece piece(std::size_t first, std::size_t last);

    // What follows is for one thread, while no other changes anything.

    [[nodiscard]] const std::map<std::size_t, std::string>& failures() const { return failures_; }
    [[nodiscard]] std::size_t done() const;
    /// nullptr when there is none of this name.
    [[nodiscard]] const double* find(std::string_view name) const;
    /// All columns, of these points: the parameters, the results by their names, and `error`, empty where there is
    /// none.
    [[nodiscard]] Data data(const SweepGrid& grid, const std::vector<std::size_t>& points) const;
    /// The points that are done, in their order.
    [[nodiscard]] std::vector<std::size_t> done_points() const;

private:
    std::size_t chunk_size_;
    mutable std::mutex changing_;  // of the columns, the failures and the words, not of the numbers
    std::map<std::string, std::vector<double>, std::less<>> columns_;
    std::map<std::size_t, std::string> failures_;
    std::vector<std::string> words_;
    std::map<std::string, std::uint64_t, std::less<>> places_;  // of the words, from 1
    std::vector<unsigned char> done_;
    std::vector<std::atomic<std::size_t>> done_in_chunk_;
};

/// Takes the results out of the columns of a file; false when they are none of this sweep.
using TakeColumns = std::function<bool(const std::vector<files::ReadColumn>& columns, SweepResults& results)>;

struct SweepTask {
    const char* call;  ///< heads sentences
    const SweepGrid& grid;
    int function;  ///< its index on the stack
    std::optional<double> workers = {};
    double seed = 0;
    std::string file = {};              ///< none: it is not kept, and not shared with other processes
    double max_time = 0;                ///< seconds of a point; 0: any
    std::vector<double> settings = {};  ///< what else decides about the results
    /// In the state of a worker: replaces the carried function on the top by the one that is asked.
    std::function<void(lua_State* worker)> adapt = {};
    /// The results so far as data.
    std::function<Data(const SweepGrid& grid, const SweepResults& results)> told;
    /// Where the file has other rows than points: takes the results from its columns; false when they are none.
    TakeColumns taken = {};
};

/// An error of the call when the name of the file is none, or several processes would all do all of it.
void check_file_of_sweep(const lua::Options& options, const SweepOptions& asked);

/// All points. Raises when all of them fail; after Ctrl-C, when what is done is in dinal.partial, and the same task
/// goes on from there. With a file, and as one of several processes of a launcher, it does its share, and ends the
/// program unless it was the last.
std::shared_ptr<SweepResults> swept(lua_State* L, const SweepTask& task);

/// What the first line of the data says when points have failed: nobody looks into a column that should be empty.
std::string heading_of_map(const SweepGrid& grid, const SweepResults& results);

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
    /// `mark` is that of what is asked. The file has a row for each point, unless `taken` reads another form.
    SweepFiles(std::string file, const std::string& mark, const SweepGrid& grid, SweepResults& results,
               TakeColumns taken = {});

    /// Makes the folder, and takes what is done; so does the file itself when it is the result. Fails when something of
    /// another sweep is there, or nothing can be written.
    std::optional<text::Error> open();
    [[nodiscard]] bool is_finished() const { return finished_; }

    /// The points that are left in our share of the chunks.
    [[nodiscard]] std::vector<std::size_t> points(const files::Share& share) const;

    /// Writes the chunks that were completed since it was last asked. Also while others work.
    std::optional<text::Error> write_complete();
    /// Writes what there is of the others.
    std::optional<text::Error> write_incomplete();

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
    std::optional<text::Error> take(const std::string& file, bool is_result);
    void remove_folder(const std::string& folder);

    std::string file_, folder_, mark_;
    const SweepGrid& grid_;
    SweepResults& results_;
    TakeColumns taken_;
    std::vector<bool> written_;  // chunks
    int opened_ = 0;
    bool finished_ = false;
};

}  // namespace dinal::api
