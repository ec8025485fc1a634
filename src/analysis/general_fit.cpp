#include "analysis/general_fit.hpp"

#include <algorithm>
#include <cmath>

namespace dinal::analysis {
namespace {

/// The residual of each measured column.
std::vector<std::vector<double>> by_column(const GeneralQuestion& question, const Eigen::VectorXd& residual) {
    std::vector<std::vector<double>> parts;
    for (Eigen::Index i = 0; i < residual.size(); ++i) {
        const auto column = static_cast<std::size_t>(question.columns[static_cast<std::size_t>(i)]);
        if (parts.size() <= column) parts.resize(column + 1);
        parts[column].push_back(residual[i]);
    }
    return parts;
}

double longest_correlation(const GeneralQuestion& question, const Eigen::VectorXd& residual) {
    double longest = 1;
    for (const auto& part : by_column(question, residual)) longest = std::max(longest, correlation_length(part));
    return longest;
}

bool is_all_white(const GeneralQuestion& question, const Eigen::VectorXd& residual) {
    const auto parts = by_column(question, residual);
    return std::all_of(parts.begin(), parts.end(), [](const std::vector<double>& part) { return is_white(part); });
}

std::optional<LeastSquares> fit(const GeneralQuestion& question, const Eigen::VectorXd& start, Eigen::Index count,
                                int steps) {
    const Prediction model = [&](const Eigen::VectorXd& p) { return question.model(p, count); };
    return least_squares(model, question.measured.head(count), start, question.scale, steps);
}

/// Fits the beginning of the record first, so that no swing is mistaken for its neighbour.
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
                     .silent = {},
                     .open = {}};
    found.noise = std::sqrt(best->sum / static_cast<double>(spare));
    found.widening = std::sqrt(longest_correlation(question, best->residual));
    const Prediction model = [&](const Eigen::VectorXd& p) { return question.model(p, question.measured.size()); };
    const Eigen::MatrixXd J = derivative(model, best->parameters, question.scale, found.noise)
                                  .value_or(Eigen::MatrixXd::Zero(question.measured.size(), n));
    Covariance covariance = covariance_of(J, question.scale.whole, found.noise);
    const double spread = found.widening * found.noise;
    covariance.matrix *= spread * spread;
    if (found.noise > question.least_noise) {
        const bool white = is_all_white(question, best->residual);
        if (!white) {
            const Eigen::VectorXd wider = widened_by_memory(J, question.scale.whole, best->residual, question.columns,
                                                            found.noise, found.widening);
            covariance.matrix = wider.asDiagonal() * covariance.matrix * wider.asDiagonal();
        }
        found.misfit = misfit_of(best->residual, white, question.columns, J,
                                 question.structures(best->parameters, found.noise, white));
        if (found.misfit) covariance.matrix += found.misfit->added_covariance();
    }
    found.silent = covariance.silent;
    found.open = covariance.open;
    for (Eigen::Index i = 0; i < n; ++i) {
        const double least = 1e-15 * std::fabs(found.value[i]);  // a few ulps
        found.error[i] = std::max(least, std::sqrt(covariance.matrix(i, i)));
    }
    return found;
}

}  // namespace dinal::analysis
