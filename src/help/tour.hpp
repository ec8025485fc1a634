// The two-minute tour that help() offers.
#pragma once

#include <cstddef>
#include <string>

namespace dinal::help {

std::size_t tour_pages();

/// Page 1, 2, ... Lines to be typed begin with four blanks and "> ".
std::string tour_page(std::size_t page);

}  // namespace dinal::help
