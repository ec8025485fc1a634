#include "model/friction.hpp"

#include <fmt/format.h>

#include <cmath>

#include "model/laws/stribeck.hpp"

namespace dinal::model {

std::optional<text::Error> wrong_torques(std::string_view of, double Rd, double Re) {
    const auto error = [&](std::string_view name, std::string sentence) {
        return text::Error{.sentence = std::move(sentence), .option = fmt::format("{}{}", of, name)};
    };
    for (const auto& [name, torque] : {std::pair{"Rd", Rd}, std::pair{"Re", Re}}) {
        if (!std::isfinite(torque)) {
            return error(name, fmt::format("{}{} = {} must be a finite number", of, name, torque));
        }
        if (torque < 0) return error(name, fmt::format("{}{} = {:.6g} must not be negative", of, name, torque));
    }
    if (Re >= Rd) return {};
    return error("Re", fmt::format("{0}Re = {1} must be at least {0}Rd = {2}: breakaway takes no less than "
                                   "kinetic friction",
                                   of, Re, Rd));
}

double Friction::kinetic() const {
    const auto* stribeck = as<laws::Stribeck>();
    return stribeck != nullptr ? normal_ * stribeck->kinetic : greatest_sliding();
}

}  // namespace dinal::model
