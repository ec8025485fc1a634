// The motion between the rows of a run, for plots and spectra: rows may be too far apart to show its swings.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/excitation.hpp"
#include "motion/run.hpp"
#include "motion/simulate.hpp"

namespace dinal::motion {

class BetweenRows {
public:
    /// Keeps references to both. M is the excitation if t, theta and velocity determine it, otherwise null.
    BetweenRows(const Run& run, const model::Excitation* M);

    /// Returns whether the run kept its motion; otherwise only its rows are available.
    bool any() const { return !columns_.empty(); }
    /// The columns that can be evaluated at any time.
    const std::vector<Eigen::Index>& columns() const { return columns_; }
    /// Appends the values of these columns; nan where the motion cannot be evaluated.
    void append_values(double t, std::vector<double>& values) const;

    /// The run between two times with rows at its events, and so close that straight lines between them look like the
    /// motion. Other columns are interpolated. Returns the run unchanged if the monitor stops it.
    Run drawn(double from, double to, const Monitor& monitor) const;

private:
    bool agrees_with_rows() const;
    double interpolated(Eigen::Index column, double t) const;

    const Run& run_;
    const model::Excitation* M_;
    std::vector<Eigen::Index> columns_;
    std::vector<const ColumnKind*> kinds_;  // kind of each of columns_; nullptr: a state
};

}  // namespace dinal::motion
