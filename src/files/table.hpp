// Named columns of numbers, as they come from a file and go to one.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "text/expected.hpp"

namespace dinal::files {

struct Table {
    std::vector<std::string> names;     ///< one for each column of `values`
    Eigen::MatrixXd values;             ///< column-major: a column is contiguous
    std::vector<std::string> comments;  ///< lines, without the sign that makes them comments
};

/// A column to be written: its words, or else its numbers. It refers to them.
struct NamedColumn {
    std::string_view name;
    std::span<const double> values = {};
    std::span<const std::string> words = {};
};

/// Whether a nan (an empty field) and an infinity may be written.
enum class Gaps { refused, written };

/// All columns of a matrix in their order (to write some of them, pick from the result).
std::vector<NamedColumn> named_columns(const std::vector<std::string>& names,
                                       const Eigen::Ref<const Eigen::MatrixXd>& values);

/// The index (from 0) of the column with that name, or with that number (from 1, as users count).
/// Fails with the list of the columns there are, and a suggestion when one is spelt like it.
text::Expected<Eigen::Index> find_column(std::span<const std::string> names, std::string_view name);
text::Expected<Eigen::Index> find_column(std::span<const std::string> names, std::int64_t number);

}  // namespace dinal::files
