// The order in which the bodies of a machine are drawn.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace dinal::plots {

/// The bodies 0 to count - 1 in an order in which linked ones are neighbours. It begins with a body that is never
/// second in a link, such as the motor of a drive, because Lua tables do not store the order of names.
std::vector<std::size_t> neighbours(std::size_t count, std::span<const std::pair<std::size_t, std::size_t>> links);

}  // namespace dinal::plots
