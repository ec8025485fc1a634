// A sweep from the call to its results: resumption, workers, Ctrl-C.
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
#include "lua/bind.hpp"
#include "lua/options.hpp"
#include "text/expected.hpp"
#include "text/option.hpp"

namespace dinal::sweep {

struct SweepOptions {
    std::optional<double> workers = {};
    double seed = 0;
    std::string file = {};
    std::optional<double> max_time = {};
    std::vector<double> points = {};
};
inline constexpr text::Range workers_range{"be a whole number from 1 to 1000",
                                           [](double x) { return text::is_whole(x, 1, 1000); }};
inline constexpr text::Range seed_range{"be a whole number from 0 to 1e15",
                                        [](double x) { return text::is_whole(x, 0, 1e15); }};
inline constexpr text::Option over_option[] = {
    {.name = "over",
     .otherwise = text::needed,
     .meaning =
         "the parameters and their values, { NAME = values, ... }, or { { \"r\", values }, { \"g\", values } } in an "
         "order of your own",
     .wanted = "names and their values, such as { r = vector.linspace(0.1, 2, 20) }"},
};
inline constexpr text::Option run_options[] = {
    {.name = "run",
     .otherwise = text::needed,
     .meaning =
         "a function of a point, a table such as { r = 0.5, g = 1 }, that returns a table of named numbers and strings",
     .wanted = "a function of a point that returns named numbers"},
    text::option<&SweepOptions::workers>("workers", "number of threads; the result does not depend on it",
                                         {.otherwise = "one per core", .range = workers_range}),
    text::option<&SweepOptions::seed>(
        "seed", "seed of math.random: each point has its own random numbers, the same in every run of the sweep",
        {.range = seed_range}),
    text::option<&SweepOptions::file>(
        "file",
        "a .csv file for the result; finished points are kept in FILE.part meanwhile, so the same call continues after "
        "a crash"),
    text::option<&SweepOptions::max_time>(
        "max_time",
        "time limit of a point; a longer one fails with a message, and the others go on; a single call of Lua's own "
        "libraries (a pattern search, os.execute) ends first",
        {.unit = "s", .range = text::positive}),
    text::option<&SweepOptions::points>("points", "{ first, last }: only these rows of the result"),
};
inline constexpr auto sweep_options = text::joined(over_option, run_options);
inline constexpr text::Call sweep_call{
    "sweep", "sweep{ over = { r = vector.linspace(0.1, 2, 20) }, run = function(p) return { A = p.r^2 } end }",
    sweep_options};

int minimise(lua_State* L);

inline constexpr text::Option minimise_options[] = {
    {.name = "over",
     .otherwise = text::needed,
     .meaning = "one or two parameters and the limits of each: { Re = { 0.1, 2 } }",
     .wanted = "names and their limits, such as { Re = { 0.1, 2 } }"},
    {.name = "run",
     .otherwise = text::needed,
     .meaning = "a function of a point, a table such as { Re = 0.5 }, that returns a number",
     .wanted = "a function of a point that returns a number"},
};
inline constexpr text::Call minimise_call{
    "minimise", "minimise{ over = { Re = { 0.1, 2 } }, run = function(p) return (p.Re - 1)^2 end }", minimise_options};

inline constexpr lua::Doc minimise_doc{
    "minimise{ OPTIONS } -> table",
    "Returns the point at which a function is least, its value, and the number of calls: best.NAME, best.value, "
    "best.calls. A coarse grid (17 values of one parameter, 9 x 9 of two) finds the valley, then the golden section or "
    "Nelder and Mead's method refines it to about 1e-8 of the range. A narrower valley may be missed. To "
    "maximise, return the negative.",
    "sys = nondimensional{ zeta = 0.1 }\n"
    "best = minimise{ over = { r = { 0.2, 2 } }, run = function(p)\n"
    "    return -sys:steady{ M = excitation.harmonic{ frequency = p.r } }.amplitude\n"
    "end }\n"
    "print(string.format(\"%.6f %.6f\", best.r, math.sqrt(1 - 2*0.1^2)))  --> 0.989949 0.989949",
    {&minimise_call}};

inline constexpr lua::Doc sweep_doc{
    "sweep{ OPTIONS } -> data",
    "Calls a function at every combination of parameter values (numbers or strings), on all cores. The result "
    "has a row for each point, the parameters in the order of their names, the last one changing fastest, and a "
    "column for each parameter and each name that the function returns; true and false count as 1 and 0, and "
    "missing numbers are nan. If the function fails, the column `error` has the message.\nEach thread has a copy "
    "of the function with all that it uses: local variables, globals, tables, vectors, systems, excitations. So "
    "it cannot change anything outside. Runs, coroutines and open files cannot be copied. Ctrl-C keeps the "
    "finished points in dinal.partial; with file the same call continues.",
    "map = sweep{ over = { r = { 0.4, 1.5 }, g = vector.linspace(0.2, 0.6, 3) }, run = function(p)\n"
    "    s = nondimensional{ friction_ratio = p.g }:steady{ M = excitation.harmonic{ frequency = p.r } }\n"
    "    return { A = s.amplitude, stops = s.stops }\n"
    "end }\n"
    "print(map:select(\"g\", \"r\", \"A\", \"stops\"))\n"
    "--> data: 6 rows of g, r, A, stops\n"
    "-->   i    g    r         A  stops\n"
    "-->   1  0.2  0.4   1.13218      2\n"
    "-->   2  0.2  1.5  0.765942      0\n"
    "-->   3  0.4  0.4   1.11113      2\n"
    "-->   4  0.4  1.5  0.653197      0\n"
    "-->   5  0.6  0.4   1.02745      2\n"
    "-->   6  0.6  1.5       0.4      0",
    {&sweep_call}};

using api::Data, api::DataColumn, api::PointGrid;

// The results of a sweep: named columns that several threads fill, each for its own points.

class SweepResults {
public:
    /// Completion is tracked in chunks of this size.
    explicit SweepResults(std::size_t points, std::size_t chunk_size);

    /// The numbers of a column, nan until set; created on first use, nullptr if there are too many. Its address stays
    /// valid.
    double* column(std::string_view name);
    static constexpr std::size_t most_columns = 20'000;

    /// Adds results for these points by name; the last column has the messages.
    void take(const std::vector<std::size_t>& points, std::span<const DataColumn> columns);

    /// Encodes a word as a special nan for a column.
    double word(std::string_view text);

    /// Marks a point as complete, with numbers or a message. Call once for each point.
    void finish(std::size_t point) {
        done_[point] = 1;
        done_in_chunk_[point / chunk_size_].fetch_add(1, std::memory_order_release);
    }
    void fail(std::size_t point, std::string message);

    std::size_t size() const { return done_.size(); }
    bool is_done(std::size_t point) const { return done_[point] != 0; }
    std::size_t chunk_size() const { return chunk_size_; }
    std::size_t chunks() const { return done_in_chunk_.size(); }
    /// May be called while others work: once true, the results of the chunk are final.
    bool is_complete(std::size_t chunk) const {
        const std::size_t first = chunk * chunk_size_;
        return done_in_chunk_[chunk].load(std::memory_order_acquire) == std::min(chunk_size_, size() - first);
    }
    /// The results of these finished points by name, followed by the column `error`, which is empty for points without
    /// an error. May be called while others work.
    std::vector<DataColumn> columns(const std::vector<std::size_t>& points) const;

    // The following are for a single thread, while no other changes anything.

    const std::map<std::size_t, std::string>& failures() const { return failures_; }
    std::size_t done() const;
    /// The column of this name, or nullptr.
    const double* find(std::string_view name) const;
    /// The finished points in order.
    std::vector<std::size_t> done_points() const;

private:
    /// The words encoded in these numbers of a column; none if there are no words.
    std::optional<std::vector<std::string>> words(const std::vector<double>& numbers) const;

    std::size_t chunk_size_;
    mutable std::mutex changing_;  // guards the columns, failures and words, but not the numbers
    std::map<std::string, std::vector<double>, std::less<>> columns_;
    std::map<std::size_t, std::string> failures_;
    std::vector<std::string> words_;
    std::map<std::string, std::uint64_t, std::less<>> places_;  // indices of words, from 1
    std::vector<unsigned char> done_;
    std::vector<std::atomic<std::size_t>> done_in_chunk_;
};

struct SweepTask {
    const char* call;  ///< beginning of error sentences
    const PointGrid& grid;
    int function;  ///< its stack index
    std::optional<double> workers = {};
    double seed = 0;
    std::string file = {};                                           ///< empty: not stored
    double max_time = 0;                                             ///< time limit of a point, seconds; 0: none
    std::string mark = {};                                           ///< identifies a function of another language
    std::optional<std::pair<std::size_t, std::size_t>> points = {};  ///< half-open range to compute; none: all
    std::vector<double> settings = {};                               ///< other inputs that determine the results
    /// Runs in a worker's state: replaces the copied function on the top by the function to be called.
    std::function<void(lua_State* worker)> adapt = {};
    /// The properties of the resulting data besides columns.
    Data form = {};
    /// Makes the columns of these points, if they differ from parameters and results.
    std::function<std::vector<DataColumn>(const SweepResults& results, const std::vector<std::size_t>& points)>
        make_columns = {};
};

/// Raises an error if the file name is invalid.
void check_file_of_sweep(const lua::Options& options, const SweepOptions& asked);

/// Computes all points. Raises an error if all fail, and after Ctrl-C: then dinal.partial has the finished points, and
/// the same task continues from there, with a file also in another process.
Data swept(lua_State* L, const SweepTask& task);

/// Pushes a sweep whose points the caller computes, with left(), take(first, data), keep() and finish().
void push_parted(lua_State* L, std::vector<DataColumn> parameters,
                 const std::function<SweepTask(const PointGrid&)>& task);
/// sweep{ ... }
int run_sweep(lua_State* L);
/// Calls push_parted() with the options of sweep and the mark of a function of another language.
int sweep_in_parts(lua_State* L);

extern const lua::Class sweep_functions;
void register_parted_sweep(lua_State* L);

/// The number of points in a chunk, the most that are lost if the process is killed.
std::size_t chunk_size_for(std::size_t points);

/// The finished points of a sweep in FILE.part, to which this process alone appends completed chunks; finally it
/// becomes the file. Truncated chunks are dropped. A mark of grid and function distinguishes sweeps.
class SweepJournal {
public:
    /// `mark` identifies the task.
    SweepJournal(std::string file, const std::string& mark, SweepResults& results);

    /// Loads finished points, or the complete file. Fails if it belongs to another sweep, is in use by another process,
    /// or cannot be written.
    std::optional<text::Error> open();
    const std::optional<std::vector<DataColumn>>& result() const { return result_; }

    /// Appends chunks completed since the last call, also while others work. `incomplete`: also appends partial ones.
    std::optional<text::Error> write(bool incomplete);
    /// Writes the result file and removes the journal.
    std::optional<text::Error> finish(const Data& result);
    /// Removes a journal without useful points.
    void discard() const;

    const std::string& path() const { return path_; }

private:
    text::Error refused(const std::string& path, std::string_view why) const;
    std::optional<text::Error> take_points();
    std::optional<text::Error> take_result();
    std::optional<text::Error> append(std::string_view text);

    std::string file_, path_, mark_;
    SweepResults& results_;
    std::vector<bool> written_;  // by chunk
    std::shared_ptr<files::Descriptor> journal_ = {};
    std::size_t size_ = 0;  // length of its complete part
    std::optional<std::vector<DataColumn>> result_;
};

}  // namespace dinal::sweep
