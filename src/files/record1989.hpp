// The record of 1989 (unit 13 of the program): NPUNT, the number of rows, followed by six numbers for each row.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "files/csv.hpp"
#include "files/file.hpp"
#include "model/oscillator.hpp"
#include "motion/run.hpp"
#include "text/expected.hpp"

namespace dinal::files {

/// t, theta, velocity_over_omega0, M_over_k, friction_over_k, damping_over_k.
const std::vector<std::string>& record1989_names();

/// Writes a computed run: time unchanged, the other five as angles (velocity / omega0, torques / k).
/// Fails if the run lacks one of the columns t, theta, velocity, M, friction, damping.
text::Expected<Written> write_record1989(const std::string& path, const motion::Run& run,
                                         const model::Oscillator& system);

/// Writes six columns unchanged, as from read_record1989.
text::Expected<Written> write_record1989(const std::string& path, const Eigen::Ref<const Eigen::MatrixXd>& six_columns);

/// Reads the output of a Fortran program: 1.5D+00, repetitions as 2*0.0, commas, rows that continue on the next line.
/// Fails if NPUNT is not the number of rows or a row has not six numbers. Errors name the file and the line.
text::Expected<Table> read_record1989(const std::string& path);

/// The same for text in memory; errors use `name` as the file.
text::Expected<Table> parse_record1989(std::string_view text, const std::string& name);

}  // namespace dinal::files
