// Fits any parameters of any model to any measured columns by least squares, from a guess.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/least_squares.hpp"
#include "analysis/misfit.hpp"

namespace dinal::analysis {

struct GeneralQuestion {
    /// The first `count` predicted numbers for these parameters; empty if the model has no prediction.
    std::function<std::optional<Eigen::VectorXd>(const Eigen::VectorXd& parameters, Eigen::Index count)> model;
    Eigen::VectorXd measured;          ///< in order of time, scaled by the variation of their column
    std::vector<int> columns;          ///< column of each number
    std::vector<double> times;         ///< time of each number
    std::vector<double> steps;         ///< resolution of the instrument of each column; 0: none visible
    std::vector<Eigen::Index> stages;  ///< lengths of the initial parts of the record that are fitted first
    Eigen::VectorXd start;
    std::vector<std::optional<int>> zeros;  ///< for each parameter the column whose zero it is
    FitScale scale;
    double least_noise = 0;  ///< smaller residuals count as rounding
    /// The terms that the model may lack at these parameters; see misfit.hpp.
    std::function<std::vector<Structure>(const Eigen::VectorXd& parameters, double noise, bool is_white)> structures;
    std::vector<std::vector<double>> other_starts;  ///< further starting values for each parameter
};

struct GeneralFit {
    Eigen::VectorXd value, predicted;
    /// Finite even for silent parameters. `error` includes how far a wrong model moves the value if the data show that
    /// or cannot exclude it, `if_right` does not.
    Eigen::VectorXd error, if_right;
    std::vector<bool> silent, open;  ///< silent: not determined by the data; open: practically without bounds
    double noise = 0;                ///< standard deviation of the residual
    double widening = 1;             ///< factor of the errors due to correlated residuals
    bool noise_is_uneven = false;    ///< whether errors are wider because noise is stronger where it matters
    std::optional<Misfit> misfit = {};

    bool is_wrong() const { return misfit && misfit->is_sure; }
};

/// Empty if the model has no prediction at the start.
std::optional<GeneralFit> general_fit(const GeneralQuestion& question);

}  // namespace dinal::analysis
