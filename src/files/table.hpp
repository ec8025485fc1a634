// Named columns of numbers, from or for a file.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "text/expected.hpp"

namespace dinal::files {

struct Table {
    std::vector<std::string> names;     ///< one for each column of `values`
    Eigen::MatrixXd values;             ///< column-major: a column is contiguous
    std::vector<std::string> comments;  ///< lines without comment signs
};

/// A view of a column to be written: its words, or otherwise its numbers.
struct NamedColumn {
    std::string_view name;
    std::span<const double> values = {};
    std::span<const std::string> words = {};
};

/// The treatment of nan (an empty field) and infinity.
enum class Gaps { refused, written };

/// All columns of a matrix in order (select from the result to write some).
std::vector<NamedColumn> named_columns(const std::vector<std::string>& names,
                                       const Eigen::Ref<const Eigen::MatrixXd>& values);

/// The index of the only name that is this one followed by a unit in brackets: "t (s)" or "t [s]" for "t".
std::optional<std::size_t> place_without_unit(std::span<const std::string> names, std::string_view name);

/// The index (from 0) of the column with that name, with or without its unit, or number (from 1).
/// Fails with the list of columns, and a suggestion if one has a similar name.
text::Expected<Eigen::Index> find_column(std::span<const std::string> names, std::string_view name);
text::Expected<Eigen::Index> find_column(std::span<const std::string> names, std::int64_t number);

}  // namespace dinal::files
