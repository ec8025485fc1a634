// Lines of text with known widths and colours: what a text picture is put together from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dinal::plots {

/// A colour is 0 for none, 1, 2, ... for the palette of curves.
class TextLine {
public:
    explicit TextLine(bool colours) : colours_(colours) {}
    void add(std::string_view text, std::uint8_t colour = 0);
    void append(const TextLine& line);
    /// Blanks up to this width; nothing when it is wider already.
    void pad(std::size_t width);
    [[nodiscard]] std::size_t width() const { return width_; }
    [[nodiscard]] std::string text() const;

private:
    bool colours_;
    std::uint8_t colour_ = 0;
    std::size_t width_ = 0;
    std::string text_;
};

using TextBlock = std::vector<TextLine>;

/// Blocks beside each other, two columns between them.
TextBlock beside(const std::vector<TextBlock>& blocks, bool colours);

/// All lines, each ended by a newline and without blanks at its end.
std::string text_of(const TextBlock& block);

}  // namespace dinal::plots
