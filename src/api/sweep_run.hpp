// A sweep from the call to its results: what was broken off before, the workers, Ctrl-C.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/sweep_options.hpp"
#include "api/sweep_results.hpp"
#include "files/csv.hpp"
#include "files/share.hpp"
#include "lua/options.hpp"
#include "text/expected.hpp"

namespace dinal::api {

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
