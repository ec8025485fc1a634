// Texts assembled at compile time, for tables of constants.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string_view>

namespace dinal::text {

/// Holds at most `room` - 1 characters; a longer text does not compile.
template <std::size_t room>
class FixedText {
public:
    constexpr FixedText(std::initializer_list<std::string_view> parts) {
        std::size_t n = 0;
        for (const std::string_view part : parts) {
            for (const char c : part) text_[n++] = c;
        }
        text_[n] = '\0';
    }
    [[nodiscard]] constexpr const char* c_str() const { return text_; }

private:
    char text_[room] = {};
};

}  // namespace dinal::text
