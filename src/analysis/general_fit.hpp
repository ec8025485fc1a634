// Any parameters of anything that can be run, fitted to any measured columns: from a guess, by least squares.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/least_squares.hpp"
#include "analysis/misfit.hpp"

namespace dinal::analysis {

struct GeneralQuestion {
    /// The first so many of the predicted numbers for these parameters; none where nothing can be predicted.
    std::function<std::optional<Eigen::VectorXd>(const Eigen::VectorXd& parameters, Eigen::Index count)> model;
    Eigen::VectorXd measured;          ///< in order of time, in units of what its column varies by
    std::vector<int> columns;          ///< of each number
    std::vector<Eigen::Index> stages;  ///< beginnings of the record that are fitted first
    Eigen::VectorXd start;
    FitScale scale;
    double least_noise = 0;  ///< a residual that is less is rounding
    /// The terms that the model may lack at these parameters.
    std::function<std::vector<Structure>(const Eigen::VectorXd& parameters, double noise, bool is_white)> structures;
    std::vector<std::vector<double>> other_starts;  ///< of each parameter: where a search may begin, too
};

struct GeneralFit {
    Eigen::VectorXd value, error, predicted;  ///< error: also of what is silent, where it bounds little
    std::vector<bool> silent, open;           ///< open: next to nothing bounds it
    double noise = 0;                         ///< standard deviation of the residual
    double widening = 1;                      ///< of the errors, because the residual is alike from sample to sample
    std::optional<Misfit> misfit = {};

    [[nodiscard]] bool is_wrong() const { return misfit && misfit->is_sure; }
};

/// None when nothing can be predicted from the start.
std::optional<GeneralFit> general_fit(const GeneralQuestion& question);

}  // namespace dinal::analysis
