// The legend of a figure in text: what each letter, sign and shade stands for.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "plots/canvas.hpp"
#include "plots/figure.hpp"

namespace dinal::plots {

struct TextEntry {
    std::string text;
    std::uint8_t ink;  ///< of its curve; 0 for what is none
};
std::vector<TextEntry> text_legend(const Figure& figure, Charset charset);

/// Words as such a text can show them.
std::string shown_in(Charset charset, std::string_view words);

}  // namespace dinal::plots
