// The record of 1989 (unit 13 of the program): NPUNT, the number of rows, then six numbers for each row.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "files/file.hpp"
#include "files/table.hpp"
#include "model/oscillator.hpp"
#include "motion/trajectory.hpp"
#include "text/expected.hpp"

namespace dinal::files {

/// t, theta, velocity_over_omega0, M_over_k, friction_over_k, damping_over_k.
const std::vector<std::string>& record1989_names();

/// A computed run: time as it is, the other five as angles (velocity / omega0, torques / k).
/// Fails when the trajectory lacks one of the columns t, theta, velocity, M, friction, damping.
text::Expected<Written> write_record1989(const std::string& path, const motion::Trajectory& trajectory,
                                         const model::Oscillator& system);

/// Six columns as they are, such as read_record1989 gave them.
text::Expected<Written> write_record1989(const std::string& path, const Eigen::Ref<const Eigen::MatrixXd>& six_columns);

/// Reads what a Fortran program can have written: 1.5D+00, repeats as 2*0.0, commas, rows that go on in the next line.
/// Fails when NPUNT is not the number of rows or a row has not six numbers. Errors name the file and the line.
text::Expected<Table> read_record1989(const std::string& path);

/// The same of a text in memory; `name` stands for the file in errors.
text::Expected<Table> parse_record1989(std::string_view text, const std::string& name);

}  // namespace dinal::files
