#include "model/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "text/characters.hpp"

namespace dinal::model {

namespace {

constexpr std::string_view head_of_units = "-- units: ";

std::string divided(const std::string& above, const std::string& below) {
    return below.empty() ? above : (above.empty() ? "1" : above) + "/" + below;
}

std::string time_word(const Units& units) {
    return units.t.empty() ? "time" : units.t;
}

/// The names and units, in the order of the rows.
template <class Of>
auto named_units(Of& units) {
    return std::array{std::pair{std::string_view("theta"), &units.theta}, std::pair{std::string_view("t"), &units.t},
                      std::pair{std::string_view("M"), &units.M}};
}

}  // namespace

std::optional<text::Error> Units::complaint() const {
    if (usual()) return std::nullopt;  // the common case; systems are made by the million
    constexpr std::size_t longest = 24;
    for (const auto& [name, word] : named_units(*this)) {
        const bool plain = text::displayable(*word) == *word && word->find_first_of("\",\\") == std::string::npos;
        if (plain && text::columns(*word) <= longest) continue;
        return text::Error{.sentence = fmt::format("the unit of {} must be a short word such as \"m\" or \"N m\", "
                                                   "without quotes and commas, got {}",
                                                   name, text::quoted(*word, longest)),
                           .option = "units"};
    }
    return std::nullopt;
}

std::string Units::speed() const {
    return divided(theta, time_word(*this));
}

std::string Units::frequency() const {
    return "1/" + time_word(*this);
}

std::string Units::inertia() const {
    return M.empty() ? "" : divided(M + " " + time_word(*this) + "^2", theta);
}

std::string Units::damping() const {
    return M.empty() ? "" : divided(M + " " + time_word(*this), theta);
}

std::string Units::stiffness() const {
    return M.empty() ? "" : divided(M, theta);
}

std::string Units::energy() const {
    return M.empty() || theta.empty() || theta == "rad" ? M : M + " " + theta;  // rad is dimensionless
}

std::string Units::of(Quantity quantity) const {
    switch (quantity) {
        case Quantity::time:
            return t;
        case Quantity::angle:
            return theta;
        case Quantity::speed:
            return speed();
        case Quantity::torque:
            return M;
        case Quantity::other:
            break;
    }
    return "";
}

std::string Units::in_words() const {
    if (usual()) return "";
    std::string text;
    for (const auto& [name, word] : named_units(*this)) {
        if (!word->empty()) text += fmt::format("{}{} in {}", text.empty() ? "" : ", ", name, *word);
    }
    return text;
}

std::string Units::lua_text() const {
    std::string text;
    for (const auto& [name, word] : named_units(*this)) {
        const bool left_out = name == "theta" ? *word == "rad" : word->empty();
        if (!left_out) text += fmt::format("{}{} = \"{}\"", text.empty() ? " " : ", ", name, *word);
    }
    return "{" + text + " }";
}

std::string Units::in_file() const {
    return std::string(head_of_units) + in_words();
}

Units Units::from_file(std::span<const std::string> lines) {
    for (const std::string_view line : lines) {
        if (!line.starts_with(head_of_units)) continue;
        Units units;
        units.theta.clear();
        for (std::string_view rest = line.substr(head_of_units.size()); !rest.empty();) {
            const std::string_view part = rest.substr(0, rest.find(", "));
            rest.remove_prefix(std::min(rest.size(), part.size() + 2));
            for (const auto& [name, word] : named_units(units)) {
                const std::string begin = std::string(name) + " in ";
                if (part.starts_with(begin)) *word = part.substr(begin.size());
            }
        }
        return units.complaint() ? Units{} : units;
    }
    return {};
}

std::string with_unit(std::string number, std::string_view unit) {
    if (!unit.empty()) number.append(" ").append(unit);
    return number;
}

std::string name_with_unit(std::string name, std::string_view unit) {
    if (!unit.empty()) name.append(", ").append(unit);
    return name;
}

}  // namespace dinal::model
