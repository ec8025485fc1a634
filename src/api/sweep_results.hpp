// What the points of a sweep gave: named columns that several threads fill, each its own points.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "api/sweep_grid.hpp"

namespace dinal::api {

class SweepResults {
public:
    explicit SweepResults(std::size_t points) : done_(points, 0) {}

    /// The numbers of a column, nan until they are set; made when it is first asked for, nullptr when there are too
    /// many. It stays where it is.
    double* column(std::string_view name);
    static constexpr std::size_t most_columns = 1000;

    /// The point has all its numbers, or a message instead. Each point is told once, by one thread.
    void finish(std::size_t point) { done_[point] = 1; }
    void fail(std::size_t point, std::string message);

    [[nodiscard]] std::size_t size() const { return done_.size(); }
    [[nodiscard]] bool is_done(std::size_t point) const { return done_[point] != 0; }

    // What follows is for one thread, while no other changes anything.

    [[nodiscard]] const std::map<std::size_t, std::string>& failures() const { return failures_; }
    [[nodiscard]] std::size_t done() const;
    /// All columns, of these points: the parameters, the results by their names, and `error`, empty where there is
    /// none.
    [[nodiscard]] Data data(const SweepGrid& grid, const std::vector<std::size_t>& points) const;
    /// The points that are done, in their order.
    [[nodiscard]] std::vector<std::size_t> done_points() const;

private:
    std::mutex changing_;  // of the columns and the failures, not of the numbers
    std::map<std::string, std::vector<double>, std::less<>> columns_;
    std::map<std::size_t, std::string> failures_;
    std::vector<unsigned char> done_;
};

}  // namespace dinal::api
