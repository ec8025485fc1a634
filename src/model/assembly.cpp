#include "model/assembly.hpp"

#include <fmt/format.h>

namespace dinal::model {

std::string Assembly::angle_in_words(const Joint& joint) const {
    std::string sum;
    for (const auto& [body, by] : joint.of) {
        sum += by < 0 ? (sum.empty() ? "-" : " - ") : (sum.empty() ? "" : " + ");
        if (std::fabs(by) != 1) sum += fmt::format("{:.6g} ", std::fabs(by));
        sum += bodies[body].name;
    }
    return sum;
}

}  // namespace dinal::model
