// A sweep in files: chunks that have their final names only when they are whole, in a folder beside the file of the
// result, and the result itself, put together in order by whoever finds all chunks there.
//
// No lock, no server: what is done is a file, so a sweep that was killed, or runs on several machines, goes on from
// what it finds. A mark of grid and function keeps the chunks of different sweeps apart.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/sweep_results.hpp"
#include "files/csv.hpp"
#include "files/share.hpp"
#include "text/expected.hpp"

namespace dinal::api {

/// How many points a chunk has: what is lost at most when the process is killed, and a file each.
std::size_t chunk_size_for(std::size_t points);

/// Takes the results out of the columns of a file; false when they are none of this sweep.
using TakeColumns = std::function<bool(const std::vector<files::ReadColumn>& columns, SweepResults& results)>;

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
