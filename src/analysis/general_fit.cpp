#include "analysis/general_fit.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/noise_memory.hpp"

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

/// Returns whether the residual of a column is within half a step of its instrument: it follows the steps then.
bool is_within_a_step(const GeneralQuestion& question, const Eigen::VectorXd& residual) {
    const auto parts = by_column(question, residual);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        double squares = 0;
        for (const double x : parts[i]) squares += x * x;
        constexpr double part = 0.5;
        if (squares < part * part * question.steps[i] * question.steps[i] * static_cast<double>(parts[i].size())) {
            return true;
        }
    }
    return false;
}

/// The covariance, in units of noise squared, if some columns follow the steps of their instruments.
Eigen::MatrixXd stepped(const GeneralQuestion& question, const Eigen::VectorXd& path, const Eigen::MatrixXd& J,
                        double noise, Eigen::MatrixXd covariance) {
    const Eigen::MatrixXd plain = covariance;
    for (std::size_t column = 0; column < question.steps.size(); ++column) {
        std::vector<Eigen::Index> rows;
        for (std::size_t i = 0; i < question.columns.size(); ++i) {
            if (question.columns[i] == static_cast<int>(column)) rows.push_back(static_cast<Eigen::Index>(i));
        }
        Eigen::MatrixXd with = plain;
        add_steps(J(rows, Eigen::indexing::all), path(rows), question.steps[column], noise, with);
        covariance += with - plain;
    }
    return covariance;
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

/// Widens the errors by the memory and unevenness of the noise, and those of fitted zeros at the first time by a steady
/// drift. Returns what the model may lack adds to the covariance.
[[nodiscard]] Eigen::MatrixXd widen(const GeneralQuestion& question, const Eigen::VectorXd& residual,
                                    const Eigen::MatrixXd& J, Covariance& covariance, GeneralFit& found) {
    const NoiseMemory memory(residual, question.columns, J);
    const Eigen::VectorXd& whole = question.scale.whole;
    const double variance = found.noise * found.noise;
    const Eigen::MatrixXd remembered = remembered_covariance(memory, J, whole, found.noise);
    const Eigen::VectorXd by_place = widened_by_uneven_noise(memory, residual, J, whole, found.noise);
    found.widening = std::max(1.0, widened_by_memory(memory, J, whole, found.noise).maxCoeff());
    found.noise_is_uneven = by_place.mean() > much_wider;
    covariance.matrix = variance * (by_place.asDiagonal() * remembered * by_place.asDiagonal());
    const std::vector<Structure> lacking = question.structures(found.value, found.noise, memory.none());
    found.misfit = misfit_of(residual, {memory.none(), found.noise_is_uneven}, question.columns, J, lacking);
    for (std::size_t i = 0; i < question.zeros.size(); ++i) {
        if (!question.zeros[i] || covariance.silent[i]) continue;
        const auto place = static_cast<Eigen::Index>(i);
        const Eigen::VectorXd ramp = drift(question.times, question.columns, *question.zeros[i], true).columns.col(0);
        const Nuisance steady = nuisance(ramp, whole[place], residual, memory, J, whole, found.noise);
        found.value[place] += steady.shift[place];
        covariance.matrix(place, place) +=
            variance * by_place[place] * by_place[place] * (steady.covariance(place, place) - remembered(place, place));
        if (found.misfit) found.misfit->shift[place] -= steady.shift[place];
    }
    Eigen::MatrixXd more = unseen_covariance(lacking, residual, memory, J, whole, found.noise);
    if (found.misfit) more += found.misfit->added_covariance();
    return more;
}

}  // namespace

std::optional<GeneralFit> general_fit(const GeneralQuestion& question) {
    constexpr double like_noise = 1.5;  // a shorter correlation length counts as white noise
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
                     .predicted = question.measured - best->residual,
                     .error = Eigen::VectorXd::Zero(n),
                     .if_right = Eigen::VectorXd::Zero(n),
                     .silent = {},
                     .open = {}};
    found.noise = std::sqrt(best->sum / static_cast<double>(spare));
    const Prediction model = [&](const Eigen::VectorXd& p) { return question.model(p, question.measured.size()); };
    const Eigen::MatrixXd J = derivative(model, best->parameters, question.scale, found.noise)
                                  .value_or(Eigen::MatrixXd::Zero(question.measured.size(), n));
    Covariance covariance = covariance_of(J, question.scale.whole, found.noise);
    const double variance = found.noise * found.noise;
    covariance.matrix *= variance;
    Eigen::MatrixXd of_model = Eigen::MatrixXd::Zero(n, n);
    if (found.noise > question.least_noise && is_within_a_step(question, best->residual)) {
        found.widening = std::sqrt(longest_correlation(question, best->residual));
        double spread = found.widening * found.noise;
        for (const double step : question.steps) spread = std::max(spread, found.widening * step / std::sqrt(12.0));
        covariance.matrix =
            spread * spread * stepped(question, found.predicted, J, found.noise, covariance.matrix / variance);
        const NoiseMemory memory(best->residual, question.columns, J);
        of_model = unseen_covariance(question.structures(found.value, found.noise, memory.none()), best->residual,
                                     memory, J, question.scale.whole, found.noise);
    } else if (found.noise > question.least_noise && n > 0) {
        of_model = widen(question, best->residual, J, covariance, found);
    }
    found.silent = covariance.silent;
    found.open = covariance.open;
    for (Eigen::Index i = 0; i < n; ++i) {
        const double least = 1e-15 * std::fabs(found.value[i]);  // a few ulps
        found.if_right[i] = std::max(least, std::sqrt(covariance.matrix(i, i)));
        found.error[i] = std::max(least, std::sqrt(covariance.matrix(i, i) + of_model(i, i)));
    }
    return found;
}

}  // namespace dinal::analysis
