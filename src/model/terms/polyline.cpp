#include "model/terms/polyline.hpp"

#include <fmt/format.h>

namespace dinal::model::terms {

std::optional<text::Error> Polyline::complaint() const {
    if (!samples || samples->t.empty()) {
        return text::Error{"there are no points; give at least one time and one value"};
    }
    if (samples->t.size() != samples->M.size()) {
        return text::Error{fmt::format("t has {} values and M has {}; they must be equally long", samples->t.size(),
                                       samples->M.size())};
    }
    const auto wrong = text::complaint(samples_options, *samples);
    return wrong ? wrong : not_increasing("t", samples->t);
}

}  // namespace dinal::model::terms
