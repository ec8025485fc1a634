#include "plots/text_block.hpp"

#include <algorithm>
#include <array>

#include "text/characters.hpp"

namespace dinal::plots {
namespace {

// The terminal's own colours: it knows its background. The first curve is plain; none of the others needs a good eye
// for red and green, since letters tell the curves apart, too.
constexpr std::array<std::string_view, 6> escapes{"\x1b[39m", "\x1b[36m", "\x1b[33m",
                                                  "\x1b[35m", "\x1b[32m", "\x1b[31m"};
constexpr std::string_view reset = "\x1b[0m";

std::size_t place(std::uint8_t colour) {
    return colour == 0 ? 0 : (colour - 1U) % escapes.size();
}

}  // namespace

void TextLine::add(std::string_view text, std::uint8_t colour) {
    if (text.empty()) {
        return;
    }
    if (colours_ && place(colour) != place(colour_)) {
        text_ += place(colour) == 0 ? reset : escapes[place(colour)];
    }
    colour_ = colour;
    text_ += text;
    width_ += text::columns(text);
}

void TextLine::append(const TextLine& line) {
    text_ += line.text_;
    if (colours_ && place(line.colour_) != 0) {
        text_ += reset;
    }
    width_ += line.width();
}

void TextLine::pad(std::size_t width) {
    if (width > width_) {
        add(std::string(width - width_, ' '));
    }
}

std::string TextLine::text() const {
    constexpr std::string_view empty_braille = "\xE2\xA0\x80";
    std::string_view text = text_;
    for (;;) {
        if (text.ends_with(' ')) {
            text.remove_suffix(1);
        } else if (text.ends_with(empty_braille)) {
            text.remove_suffix(empty_braille.size());
        } else {
            break;
        }
    }
    return std::string(text) + (colours_ && place(colour_) != 0 ? std::string(reset) : "");
}

TextBlock beside(const std::vector<TextBlock>& blocks, bool colours) {
    std::size_t height = 0;
    for (const TextBlock& block : blocks) {
        height = std::max(height, block.size());
    }
    TextBlock all;
    for (std::size_t row = 0; row < height; ++row) {
        TextLine line(colours);
        std::size_t start = 0;
        for (const TextBlock& block : blocks) {
            std::size_t width = 0;
            for (const TextLine& each : block) {
                width = std::max(width, each.width());
            }
            line.pad(start);
            if (row < block.size()) {
                line.append(block[row]);
            }
            start += width + 2;
        }
        all.push_back(std::move(line));
    }
    return all;
}

std::string text_of(const TextBlock& block) {
    std::string text;
    for (const TextLine& line : block) {
        text += line.text() + '\n';
    }
    return text;
}

}  // namespace dinal::plots
