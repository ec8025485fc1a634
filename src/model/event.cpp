#include "model/event.hpp"

#include <fmt/format.h>

#include <string_view>

namespace dinal::model {

std::string sentence(const Contradiction& found) {
    std::string first = fmt::format("{:.6g}", found.first), again = fmt::format("{:.6g}", found.again);
    if (first == again) {  // alike with six digits: show all digits
        first = fmt::format("{}", found.first);
        again = fmt::format("{}", found.again);
    }
    return fmt::format("{} depends on more than its arguments: at {} = {:.6g} it returned {} and, evaluated again, {}",
                       found.who, found.argument, found.at, first, again);
}

std::string sentence_with_cure(const Contradiction& found) {
    constexpr std::string_view memory =
        "; put memory into states, excitation.sampled, excitation.relay or excitation.delayed, and random numbers "
        "into a table";
    constexpr std::string_view state = "; put memory into a state of its own, and random numbers into a table";
    constexpr std::string_view other = "; it must not keep a memory, and random numbers must come from a table";
    return sentence(found) + std::string(found.who == "M" ? memory : found.who.starts_with("states.") ? state : other);
}

}  // namespace dinal::model
