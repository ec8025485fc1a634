#include "api/sweep_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
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

namespace {
constexpr std::uint64_t nan_of_words = 0xFFF8'0000'0000'0000U;  ///< and the place of the word
}

double SweepResults::word(std::string_view text) {
    const std::lock_guard lock(changing_);
    auto found = places_.find(text);
    if (found == places_.end()) {
        words_.emplace_back(text);
        found = places_.emplace(words_.back(), words_.size()).first;
    }
    return std::bit_cast<double>(nan_of_words | found->second);
}

std::optional<std::vector<std::string>> SweepResults::words(const std::vector<double>& numbers) const {
    const std::lock_guard lock(changing_);
    const auto place = [this](double x) {
        const std::uint64_t bits = std::bit_cast<std::uint64_t>(x), of_word = bits & ~nan_of_words;
        return (bits & nan_of_words) == nan_of_words && of_word <= words_.size() ? of_word : 0;
    };
    if (std::none_of(numbers.begin(), numbers.end(), place)) return std::nullopt;
    std::vector<std::string> words;
    words.reserve(numbers.size());
    for (const double x : numbers) {
        const std::uint64_t at = place(x);
        words.push_back(at > 0 ? words_[at - 1] : std::isnan(x) ? "" : fmt::format("{}", x));
    }
    return words;
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
        auto words = this->words(values);
        data.columns.push_back(words ? column_of(name, std::move(*words)) : column_of(name, std::move(values)));
    }
    std::vector<std::string> errors(points.size());
    for (std::size_t row = 0; row < points.size() && !failures_.empty(); ++row) {
        if (const auto failed = failures_.find(points[row]); failed != failures_.end()) errors[row] = failed->second;
    }
    data.columns.push_back(column_of("error", std::move(errors)));
    return data;
}

SweepGrid::SweepGrid(std::vector<DataColumn> parameters)
    : parameters_(std::move(parameters)), strides_(parameters_.size()) {
    for (std::size_t i = parameters_.size(); i-- > 0;) {
        strides_[i] = size_;
        size_ *= parameters_[i].size();
    }
}

std::string SweepGrid::text(std::size_t point) const {
    std::string text;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        text += (i == 0 ? "" : ", ") + parameters_[i].name + " = " + parameters_[i].text(place(i, point));
    }
    return text;
}

void SweepGrid::set_fields(lua_State* L, std::size_t point) const {
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        const DataColumn& parameter = parameters_[i];
        lua::push_text(L, parameter.name);
        if (const lua::Vector* numbers = parameter.numbers()) {
            lua_pushnumber(L, numbers->begin()[place(i, point)]);
        } else {
            lua::push_text(L, (*std::get<Words>(parameter.values))[place(i, point)]);
        }
        lua_rawset(L, -3);
    }
}

std::vector<DataColumn> SweepGrid::columns(const std::vector<std::size_t>& points) const {
    std::vector<DataColumn> columns;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        const DataColumn& parameter = parameters_[i];
        if (const lua::Vector* numbers = parameter.numbers()) {
            std::vector<double> values(points.size());
            std::transform(points.begin(), points.end(), values.begin(),
                           [&](std::size_t point) { return numbers->begin()[place(i, point)]; });
            columns.push_back(column_of(parameter.name, std::move(values)));
        } else {
            const std::vector<std::string>& words = *std::get<Words>(parameter.values);
            std::vector<std::string> values(points.size());
            std::transform(points.begin(), points.end(), values.begin(),
                           [&](std::size_t point) { return words[place(i, point)]; });
            columns.push_back(column_of(parameter.name, std::move(values)));
        }
    }
    return columns;
}

}  // namespace dinal::api
