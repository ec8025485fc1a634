#include "api/sweep_results.hpp"

#include <algorithm>
#include <limits>

namespace dinal::api {

SweepResults::SweepResults(std::size_t points, std::size_t chunk_size)
    : chunk_size_(chunk_size), done_(points, 0), done_in_chunk_((points + chunk_size - 1) / chunk_size) {}

SweepResults::Piece SweepResults::piece(std::size_t first, std::size_t last) {
    const std::lock_guard lock(changing_);
    Piece piece{.columns = {}, .failures = {failures_.lower_bound(first), failures_.lower_bound(last)}};
    for (const auto& [name, numbers] : columns_) piece.columns.emplace_back(name, numbers.data());
    return piece;
}

double* SweepResults::column(std::string_view name) {
    const std::lock_guard lock(changing_);
    auto found = columns_.find(name);
    if (found == columns_.end()) {
        if (columns_.size() >= most_columns) return nullptr;
        std::vector<double> numbers(done_.size(), std::numeric_limits<double>::quiet_NaN());
        found = columns_.emplace(std::string(name), std::move(numbers)).first;
    }
    return found->second.data();
}

void SweepResults::fail(std::size_t point, std::string message) {
    std::replace_if(
        message.begin(), message.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    {
        const std::lock_guard lock(changing_);
        failures_[point] = std::move(message);
    }
    finish(point);
}

std::size_t SweepResults::done() const {
    return static_cast<std::size_t>(std::count(done_.begin(), done_.end(), 1));
}

const double* SweepResults::find(std::string_view name) const {
    const auto found = columns_.find(name);
    return found == columns_.end() ? nullptr : found->second.data();
}

std::vector<std::size_t> SweepResults::done_points() const {
    std::vector<std::size_t> points;
    points.reserve(done_.size());
    for (std::size_t point = 0; point < done_.size(); ++point) {
        if (is_done(point)) points.push_back(point);
    }
    return points;
}

Data SweepResults::data(const SweepGrid& grid, const std::vector<std::size_t>& points) const {
    Data data{.columns = grid.columns(points)};
    for (const auto& [name, numbers] : columns_) {
        std::vector<double> values(points.size());
        std::transform(points.begin(), points.end(), values.begin(),
                       [&all = numbers](std::size_t point) { return all[point]; });
        data.columns.push_back(column_of(name, std::move(values)));
    }
    std::vector<std::string> errors(points.size());
    for (std::size_t row = 0; row < points.size() && !failures_.empty(); ++row) {
        if (const auto failed = failures_.find(points[row]); failed != failures_.end()) errors[row] = failed->second;
    }
    data.columns.push_back(column_of("error", std::move(errors)));
    return data;
}

}  // namespace dinal::api
