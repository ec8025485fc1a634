#include "model/laws/tabulated.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dinal::model::laws {

std::optional<text::Error> Tabulated::complaint() const {
    if (auto wrong = text::complaint(tabulated_options, *this)) return wrong;
    const auto error = [](const char* option, std::string sentence) {
        return text::Error{.sentence = std::move(sentence), .option = option};
    };
    if (speed.empty() || speed.front() != 0) {
        return error("speed", "speed must begin with 0: friction at standstill is the first torque");
    }
    if (speed.size() != torque.size()) {
        return error("torque", fmt::format("torque has {} numbers and speed {}: there must be one for each",
                                           torque.size(), speed.size()));
    }
    for (std::size_t i = 0; i < torque.size(); ++i) {
        if (torque[i] >= 0) continue;
        return error("torque", fmt::format("torque[{}] = {:.6g} must not be negative", i + 1, torque[i]));
    }
    for (std::size_t i = 1; i < speed.size(); ++i) {
        if (speed[i] > speed[i - 1]) continue;
        return error("speed", fmt::format("speed[{}] = {:.6g} is not greater than speed[{}] = {:.6g}: speeds must "
                                          "increase",
                                          i + 1, speed[i], i, speed[i - 1]));
    }
    if (holding(Motion::forward) >= torque.front()) return std::nullopt;
    return error("Re", fmt::format("Re = {} must be at least torque[1] = {}, the friction at speed 0",
                                   holding(Motion::forward), torque.front()));
}

std::size_t Tabulated::ranges() const {
    for (std::size_t i = 0; i < speed.size(); ++i) {
        if (!std::isfinite(range(i).slope)) return 0;
    }
    return speed.size();
}

std::string Tabulated::lua_text() const {
    return text::lua_text(tabulated_call.name, tabulated_options, *this, text::Defaults::left_out);
}

}  // namespace dinal::model::laws
