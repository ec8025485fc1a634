#include "analysis/turning_points.hpp"

#include <algorithm>
#include <cmath>

namespace dinal::analysis {

double noise_of(std::span<const double> theta) {
    if (theta.size() < 6) return 0;
    std::vector<double> differences;
    for (std::size_t i = 2; i + 2 < theta.size(); ++i) {
        differences.push_back(
            std::fabs(theta[i - 2] - 4 * theta[i - 1] + 6 * theta[i] - 4 * theta[i + 1] + theta[i + 2]));
    }
    const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
    std::nth_element(differences.begin(), middle, differences.end());
    return *middle / (0.6745 * std::sqrt(70.0));  // median of |x|, and 1 + 16 + 36 + 16 + 1, the sum of squared weights
}

bool is_noisy(std::span<const double> values) {
    std::vector<double> half;
    for (std::size_t i = 0; i < values.size(); i += 2) half.push_back(values[i]);
    const auto [low, high] = std::ranges::minmax_element(values);
    return noise_of(values) > std::max(1e-6 * (*high - *low), 0.5 * noise_of(half));
}

namespace {

std::size_t standing_at(std::span<const double> theta, double limit) {
    constexpr std::size_t least = 4;
    std::size_t all = 0;
    for (std::size_t i = 0; i < theta.size();) {
        std::size_t end = i;
        while (end < theta.size() && theta[end] == limit) ++end;
        if (end - i >= least && end < theta.size()) all += end - i;
        i = std::max(end, i + 1);
    }
    return all;
}

}  // namespace

CutOff cut_off(std::span<const double> theta) {
    const auto [low, high] = std::ranges::minmax_element(theta);
    return {*low, *high, standing_at(theta, *low), standing_at(theta, *high)};
}

std::vector<std::size_t> turning_points(std::span<const double> theta, double least) {
    std::vector<std::size_t> points;
    std::size_t high = 0, low = 0;
    int way = 0;
    for (std::size_t i = 1; i < theta.size(); ++i) {
        if (theta[i] > theta[high]) high = i;
        if (theta[i] < theta[low]) low = i;
        if (way >= 0 && theta[high] - theta[i] >= least) {
            if (way > 0) points.push_back(high);
            way = -1;
            low = i;
        } else if (way <= 0 && theta[i] - theta[low] >= least) {
            if (way < 0) points.push_back(low);
            way = 1;
            high = i;
        }
        if (way > 0) low = i;
        if (way < 0) high = i;
    }
    return points;
}

Tangent first_tangent(std::span<const double> t, std::span<const double> theta, std::size_t count) {
    count = std::clamp<std::size_t>(count, 2, theta.size());
    double t_mean = 0, mean = 0, above = 0, below = 0;
    for (std::size_t i = 0; i < count; ++i) t_mean += t[i], mean += theta[i];
    t_mean /= static_cast<double>(count);
    mean /= static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
        above += (t[i] - t_mean) * (theta[i] - mean);
        below += (t[i] - t_mean) * (t[i] - t_mean);
    }
    const double slope = below > 0 ? above / below : 0;
    return {mean - slope * (t_mean - t[0]), slope};
}

}  // namespace dinal::analysis
