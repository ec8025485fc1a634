#include "api/sweep_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "files/confinement.hpp"
#include "files/file.hpp"
#include "text/words.hpp"

namespace dinal::api {
namespace {

namespace fs = std::filesystem;

constexpr const char* point_column = "point of the grid";

/// Where a read column has something to say at this row; an empty column of words is one of nan.
std::string word_at(const files::ReadColumn& column, std::size_t row) {
    return column.of_words ? column.words[row] : "";
}

/// The line above a table that says which of its results are words, so that a damaged number is not taken for one.
std::string note_of_words(const std::vector<std::string>& names) {
    return names.empty() ? "" : fmt::format("words in {}", fmt::join(names, ", "));
}

text::Expected<files::Written> write_columns(const std::string& file, std::span<const files::NamedColumn> columns,
                                             const std::string& comment) {
    const std::span<const std::string> comments(&comment, comment.empty() ? 0 : 1);
    return files::write_csv(file, columns, comments, files::Gaps::written);
}

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

SweepFiles::SweepFiles(std::string file, const std::string& mark, const SweepGrid& grid, SweepResults& results,
                       TakeColumns taken)
    : file_(std::move(file)),
      folder_(file_ + ".parts"),
      mark_("sweep " + mark),
      grid_(grid),
      results_(results),
      taken_(std::move(taken)),
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
    auto wrong = take(file_, true);
    finished_ = !wrong;
    if (finished_) remove_folder(folder_ + ".merging");  // somebody was killed before the last of his work
    return wrong;
}

std::optional<text::Error> SweepFiles::take_chunks() {
    for (std::size_t chunk = 0; chunk < results_.chunks(); ++chunk) {
        std::error_code error;
        if (results_.is_complete(chunk)) continue;
        if (is_wrong_kind(chunk_file(chunk), fs::file_type::regular))
            return refused(chunk_file(chunk), "is not a regular file");
        if (!fs::exists(chunk_file(chunk), error)) continue;
        if (is_cut_off(chunk_file(chunk))) continue;  // done anew
        if (auto wrong = take(chunk_file(chunk), false)) return wrong;
        written_[chunk] = results_.is_complete(chunk);
    }
    return std::nullopt;
}

std::optional<text::Error> SweepFiles::take(const std::string& file, bool is_result) {
    const auto another = [&](std::string_view what) { return refused(file, what); };
    const auto read = files::read_columns(file);
    const bool has_mark = read && !read->comments.empty() && read->comments.front().starts_with(mark_);
    if (is_result && !has_mark) return another("is there, and is not the result of this sweep");
    if (is_result && is_cut_off(file)) return another("has been changed since it was written");
    std::error_code error;
    if (!read && !fs::exists(folder_, error)) return std::nullopt;  // another process has found all, and took it away
    if (!read) return read.error();
    const std::vector<files::ReadColumn>& columns = read->columns;
    if (is_result && taken_) {
        return taken_(columns, results_) ? std::nullopt
                                         : std::optional(another("has been changed since it was written"));
    }
    const std::size_t first = is_result ? grid_.parameters().size() : 1;
    const std::size_t rows = columns.empty() ? 0 : std::max(columns[0].numbers.size(), columns[0].words.size());
    std::vector<std::string> words;
    for (std::size_t i = first; i + 1 < columns.size(); ++i) {
        if (columns[i].of_words) words.push_back(columns[i].name);
    }
    const std::string note = read->comments.empty() ? "" : read->comments.front().substr(is_result ? mark_.size() : 0);
    const bool broken = columns.size() <= first || columns.back().name != "error" ||
                        (is_result ? rows != results_.size() : columns[0].of_words) ||
                        text::trimmed(note) != note_of_words(words);
    if (broken) return another("has been changed since it was written");
    for (std::size_t row = 0; row < rows; ++row) {
        const double place = is_result ? static_cast<double>(row) : columns[0].numbers[row];
        if (!(place >= 0 && place < static_cast<double>(results_.size())))
            return another("has been changed since it was written");
        const auto point = static_cast<std::size_t>(place);
        if (results_.is_done(point)) continue;
        if (std::string message = word_at(columns.back(), row); !message.empty()) {
            results_.fail(point, std::move(message));
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
    const SweepResults::Piece piece = results_.piece(first, last);
    std::vector<std::size_t> points;
    std::vector<double> places;
    std::vector<std::string> errors;
    for (std::size_t point = first; point < last; ++point) {
        if (!results_.is_done(point)) continue;
        points.push_back(point);
        places.push_back(static_cast<double>(point));
        const auto failed = piece.failures.find(point);
        errors.push_back(failed == piece.failures.end() ? "" : failed->second);
    }
    if (points.empty()) return std::nullopt;
    std::vector<std::vector<double>> numbers;
    std::vector<std::vector<std::string>> words;
    std::vector<std::string> names;
    numbers.reserve(piece.columns.size());
    words.reserve(piece.columns.size());
    std::vector<files::NamedColumn> columns{{.name = point_column, .values = places}};
    for (const auto& [name, all] : piece.columns) {
        std::vector<double>& own = numbers.emplace_back(points.size());
        std::transform(points.begin(), points.end(), own.begin(),
                       [values = all](std::size_t point) { return values[point]; });
        if (auto own_words = results_.words(own)) {
            names.push_back(name);
            columns.push_back({.name = name, .words = words.emplace_back(std::move(*own_words))});
        } else {
            columns.push_back({.name = name, .values = own});
        }
    }
    columns.push_back({.name = "error", .words = errors});
    const auto written = write_columns(chunk_file(chunk), columns, note_of_words(names));
    if (written) return std::nullopt;
    // Somebody with the same share, who was not killed after all, may have done it, and all of it be finished.
    std::error_code error;
    const bool taken =
        !fs::exists(folder_, error) && (fs::exists(file_, error) || fs::exists(folder_ + ".merging", error));
    return taken ? std::nullopt : std::optional(written.error());
}

std::optional<text::Error> SweepFiles::write_complete() {
    for (std::size_t chunk = 0; chunk < results_.chunks(); ++chunk) {
        if (written_[chunk] || !results_.is_complete(chunk)) continue;
        if (auto wrong = write(chunk)) return wrong;
        written_[chunk] = true;
    }
    return std::nullopt;
}

std::optional<text::Error> SweepFiles::write_incomplete() {
    for (std::size_t chunk = 0; chunk < results_.chunks(); ++chunk) {
        if (written_[chunk]) continue;
        if (auto wrong = write(chunk)) return wrong;
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
    std::vector<files::NamedColumn> columns;
    std::vector<std::string> names;
    for (const DataColumn& column : result.columns) {
        files::NamedColumn& written = columns.emplace_back(files::NamedColumn{.name = column.name});
        if (const lua::Vector* numbers = column.numbers()) {
            written.values = numbers->values();
        } else {
            written.words = *std::get<Words>(column.values);
            if (columns.size() > grid_.parameters().size() && column.name != "error") names.push_back(column.name);
        }
    }
    const auto written = write_columns(file_, columns, mark_ + (names.empty() ? "" : " " + note_of_words(names)));
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

}  // namespace dinal::api
