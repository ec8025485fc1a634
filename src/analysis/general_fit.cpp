#include "analysis/general_fit.hpp"

#include <algorithm>
#include <cmath>

namespace dinal::analysis {
namespace {

double longest_correlation(const GeneralQuestion& question, const Eigen::VectorXd& residual) {
    const int columns =
        question.columns.empty() ? 0 : *std::max_element(question.columns.begin(), question.columns.end()) + 1;
    double longest = 1;
    for (int column = 0; column < columns; ++column) {
        std::vector<double> own;
        for (Eigen::Index i = 0; i < residual.size(); ++i) {
            if (question.columns[static_cast<std::size_t>(i)] == column) own.push_back(residual[i]);
        }
        longest = std::max(longest, correlation_length(own));
    }
    return longest;
}

std::optional<LeastSquares> fit(const GeneralQuestion& question, const Eigen::VectorXd& start, Eigen::Index count,
                                int steps) {
    const Prediction model = [&](const Eigen::VectorXd& p) { return question.model(p, count); };
    return least_squares(model, question.measured.head(count), start, question.scale, steps);
}

/// The beginning of the record first, so that no swing is taken for the next one.
std::optional<LeastSquares> fit_from(const GeneralQuestion& question, Eigen::VectorXd start) {
    constexpr int few = 12, many = 60;
    for (const Eigen::Index count : question.stages) {
        if (const auto some = fit(question, start, count, few)) start = some->parameters;
    }
    return fit(question, start, question.measured.size(), many);
}

}  // namespace

std::optional<GeneralFit> general_fit(const GeneralQuestion& question) {
    constexpr double like_noise = 1.5;  // correlation length
    std::optional<LeastSquares> best = fit_from(question, question.start);
    for (Eigen::Index i = 0; i < question.start.size(); ++i) {
        for (const double begin : question.other_starts[static_cast<std::size_t>(i)]) {
            if (best && longest_correlation(question, best->residual) < like_noise) break;
            Eigen::VectorXd other = question.start;
            other[i] = begin;
            auto found = fit_from(question, other);
            if (found && (!best || found->sum < best->sum)) best = std::move(found);
        }
    }
    if (!best) return {};
    const Eigen::Index n = best->parameters.size(), spare = std::max<Eigen::Index>(1, question.measured.size() - n);
    GeneralFit found{.value = best->parameters,
                     .error = Eigen::VectorXd::Zero(n),
                     .predicted = question.measured - best->residual,
                     .silent = std::vector<bool>(static_cast<std::size_t>(n), false)};
    found.noise = std::sqrt(best->sum / static_cast<double>(spare));
    found.widening = std::sqrt(longest_correlation(question, best->residual));
    const Prediction model = [&](const Eigen::VectorXd& p) { return question.model(p, question.measured.size()); };
    const auto J = derivative(model, best->parameters, question.scale, found.noise);
    const Covariance covariance = covariance_of(J.value_or(Eigen::MatrixXd::Zero(question.measured.size(), n)),
                                                question.scale.whole, found.noise);
    found.silent = covariance.silent;
    for (Eigen::Index i = 0; i < n; ++i) {
        if (found.silent[static_cast<std::size_t>(i)]) continue;
        const double least = 1e-15 * std::fabs(found.value[i]);  // some ulps
        found.error[i] = std::max(least, found.widening * found.noise * std::sqrt(covariance.matrix(i, i)));
    }
    return found;
}

}  // namespace dinal::analysis
