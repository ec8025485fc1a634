#include "model/terms/term.hpp"

#include <fmt/format.h>

namespace dinal::model::terms {

std::optional<text::Error> not_increasing(const char* option, std::span<const double> times) {
    for (std::size_t i = 1; i < times.size(); ++i) {
        if (!(times[i] > times[i - 1])) {
            return text::Error{
                .sentence = fmt::format("{0}[{1}] = {2} is not after {0}[{3}] = {4}; times must increase", option,
                                        i + 1, times[i], i, times[i - 1]),
                .option = option};
        }
    }
    return std::nullopt;
}

}  // namespace dinal::model::terms
