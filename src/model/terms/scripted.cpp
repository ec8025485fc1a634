#include "model/terms/scripted.hpp"

#include <fmt/format.h>

namespace dinal::model::terms {

std::optional<text::Error> Scripted::complaint() const {
    if (!function) {
        return text::Error{"there is no function"};
    }
    if (auto wrong = text::complaint(scripted_options, *this)) return wrong;
    if (auto wrong = not_increasing("breaks", breaks)) return wrong;
    if (auto wrong = text::complaint({.name = "period", .range = text::not_negative}, text::OptionValue(period))) {
        return wrong;
    }
    if (period > 0 && !breaks.empty() && breaks.back() - breaks.front() > period) {
        return text::Error{
            .sentence = fmt::format("breaks from {} to {} span more than the period {}; give those of one period",
                                    breaks.front(), breaks.back(), period),
            .option = "breaks"};
    }
    return std::nullopt;
}

void Scripted::drop_repeated_corner() {
    constexpr double rounding = 1e-12;
    if (period > 0 && breaks.size() > 1 && breaks.back() - breaks.front() > period * (1 - rounding)) {
        breaks.pop_back();
    }
}

}  // namespace dinal::model::terms
