// What the points of a sweep gave: named columns that several threads fill, each its own points.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/data.hpp"

namespace dinal::api {

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

}  // namespace dinal::api
