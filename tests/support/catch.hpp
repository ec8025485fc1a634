// Catch2 in the words of version 2 (Debian 12), also where there is version 3 (Debian 13).
#pragma once

#if __has_include(<catch2/catch.hpp>)
#include <catch2/catch.hpp>
#else
#include <catch2/catch_all.hpp>
#include <string>

using Catch::Approx;

// Version 3 means an element of a range by this name; texts come before templates.
namespace Catch::Matchers {
inline StringContainsMatcher Contains(const char* part) {
    return ContainsSubstring(part);
}
inline StringContainsMatcher Contains(const std::string& part) {
    return ContainsSubstring(part);
}
inline StringContainsMatcher Contains(std::string& part) {
    return ContainsSubstring(part);
}
inline StringContainsMatcher Contains(std::string&& part) {
    return ContainsSubstring(part);
}
}  // namespace Catch::Matchers

namespace Catch {
using Matchers::Contains;
}
#endif
