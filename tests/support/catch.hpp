// The names of Catch2 version 2 (Debian 12), also for version 3 (Debian 13).
#pragma once

#if __has_include(<catch2/catch.hpp>)
#include <catch2/catch.hpp>
#else
#include <catch2/catch_all.hpp>
#include <string>

using Catch::Approx;

// In version 3 this name matches an element of a range; overloads for text take precedence over templates.
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
