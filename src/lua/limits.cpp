#include "lua/limits.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "lua/memory_limit.hpp"
#include "lua/time_limit.hpp"

namespace dinal::lua {
namespace {

/// 256M, as it is typed.
std::string size_text(std::size_t bytes) {
    constexpr std::array<std::pair<std::size_t, char>, 3> units{{{30, 'G'}, {20, 'M'}, {10, 'K'}}};
    for (const auto& [shift, letter] : units) {
        if (const std::size_t unit = std::size_t{1} << shift; bytes >= unit && bytes % unit == 0) {
            return fmt::format("{}{}", bytes / unit, letter);
        }
    }
    return fmt::format("{} bytes", bytes);
}

}  // namespace

void set_limits(lua_State* L, const ScriptLimits& limits) {
    if (limits.memory > 0) {
        set_memory_limit(L, limits.memory);
    }
    if (limits.seconds > 0) {
        set_time_limit(limits.seconds);
    }
}

std::string limit_sentence(Stop reason, const std::string& place) {
    const std::string what = reason == Stop::time
                                 ? fmt::format("ran longer than the {:.6g} s that --max-time allows", time_limit())
                                 : "needed more than the " + size_text(memory_limit()) + " that --max-memory allows";
    return fmt::format("stopped{}{}: it {}", place.empty() ? "" : " at ", place, what);
}

std::string reached_limit() {
    const Stop reason = stop_requested();
    return reason == Stop::time || reason == Stop::memory ? limit_sentence(reason, stopped_at()) : "";
}

}  // namespace dinal::lua
