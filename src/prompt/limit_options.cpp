#include "prompt/limit_options.hpp"

#include <fmt/core.h>

#include <charconv>

namespace dinal::prompt {
namespace {

constexpr std::string_view time_option = "--max-time";
constexpr std::string_view memory_option = "--max-memory";
constexpr double longest = 1e9;                         // seconds: 30 years
constexpr std::size_t largest = std::size_t{1} << 40U;  // a terabyte
constexpr lua::ScriptLimits safe{.memory = std::size_t{256} << 20U, .seconds = 10};

/// "10", "0.5"; 0 when it is no positive number.
double seconds_of(std::string_view text) {
    double seconds = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), seconds);
    const bool good = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
    return good && seconds > 0 && seconds <= longest ? seconds : 0;
}

/// "256M", "1G", "500K", "1000000"; 0 when it is no size.
std::size_t size_of(std::string_view text) {
    std::size_t size = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), size);
    const std::string_view letter = text.substr(static_cast<std::size_t>(parsed.ptr - text.data()));
    const std::size_t unit = letter.empty() ? 0 : std::string_view("KMG").find(letter) + 1;  // 0 when there is no such
    const bool good = parsed.ec == std::errc() && letter.size() <= 1 && (letter.empty() || unit > 0);
    return good && size <= largest >> (10 * unit) ? size << (10 * unit) : 0;
}

}  // namespace

std::string_view limit_option(std::string_view word) {
    const std::string_view name = word.substr(0, word.find('='));
    return name == time_option || name == memory_option ? name : std::string_view();
}

std::optional<text::Error> set_limit(lua::ScriptLimits& limits, std::string_view option, std::string_view value) {
    const bool time = option == time_option;
    limits.seconds = time ? seconds_of(value) : limits.seconds;
    limits.memory = time ? limits.memory : size_of(value);
    if (time ? limits.seconds > 0 : limits.memory > 0) {
        return std::nullopt;
    }
    return text::Error{fmt::format("option {} needs {} after it, for example {}{}", option,
                                   time ? "a time in seconds" : "a size", time ? "--max-time 10" : "--max-memory 256M",
                                   value.empty() ? "" : fmt::format("; '{}' is none", value))};
}

void complete_safe_limits(lua::ScriptLimits& limits) {
    limits.memory = limits.memory > 0 ? limits.memory : safe.memory;
    limits.seconds = limits.seconds > 0 ? limits.seconds : safe.seconds;
}

}  // namespace dinal::prompt
