#include "files/table.hpp"

#include <algorithm>

#include "text/suggest.hpp"

namespace dinal::files {
namespace {

/// "t, theta, M"; a long list is cut to fit in a sentence.
std::string list_of(std::span<const std::string> names) {
    constexpr std::size_t most = 12;
    std::string list;
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i) {
        list += (i == 0 ? "" : ", ") + names[i];
    }
    return names.size() > most ? list + ", ... (" + std::to_string(names.size()) + " in all)" : list;
}

}  // namespace

std::vector<NamedColumn> named_columns(const std::vector<std::string>& names,
                                       const Eigen::Ref<const Eigen::MatrixXd>& values) {
    std::vector<NamedColumn> columns;
    const auto count = std::min(static_cast<Eigen::Index>(names.size()), values.cols());
    for (Eigen::Index i = 0; i < count; ++i) {
        const std::span<const double> numbers(values.data() + i * values.outerStride(),
                                              static_cast<std::size_t>(values.rows()));
        columns.push_back({names[static_cast<std::size_t>(i)], numbers});
    }
    return columns;
}

std::optional<std::size_t> place_without_unit(std::span<const std::string> names, std::string_view name) {
    const auto fits = [name](const std::string& whole) {
        const std::string_view rest = std::string_view(whole).substr(std::min(name.size(), whole.size()));
        return whole.starts_with(name) &&
               ((rest.starts_with(" (") && rest.ends_with(')')) || (rest.starts_with(" [") && rest.ends_with(']')));
    };
    if (std::ranges::count_if(names, fits) != 1) return std::nullopt;
    return static_cast<std::size_t>(std::ranges::find_if(names, fits) - names.begin());
}

text::Expected<Eigen::Index> find_column(std::span<const std::string> names, std::string_view name) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) {
        if (const auto place = place_without_unit(names, name)) return static_cast<Eigen::Index>(*place);
        return text::Error{.sentence = "there is no column '" + std::string(name) + "' among " + list_of(names),
                           .culprit = std::string(name),
                           .cure = text::did_you_mean(name, names)};
    }
    return static_cast<Eigen::Index>(found - names.begin());
}

text::Expected<Eigen::Index> find_column(std::span<const std::string> names, std::int64_t number) {
    if (number < 1 || number > static_cast<std::int64_t>(names.size())) {
        return text::Error{"there is no column " + std::to_string(number) + ": they are numbered 1 to " +
                           std::to_string(names.size()) + " (" + list_of(names) + ")"};
    }
    return static_cast<Eigen::Index>(number - 1);
}

}  // namespace dinal::files
