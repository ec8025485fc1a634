#include "text/display_text.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace dinal::text {
namespace {

struct Character {
    char32_t code = 0;
    std::size_t bytes = 0;  // 0: no UTF-8 here
};

unsigned byte(char c) {
    return static_cast<unsigned char>(c);
}

/// The character that begins the text, which is not empty.
Character decode(std::string_view text) {
    const unsigned first = byte(text[0]);
    if (first < 0x80U) {
        return {first, 1};
    }
    const std::size_t bytes = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
    if (first < 0xC2U || first > 0xF4U || text.size() < bytes) {
        return {};
    }
    char32_t code = first & (0x7FU >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(text[i]) & 0xC0U) != 0x80U) {
            return {};
        }
        code = (code << 6U) | (byte(text[i]) & 0x3FU);
    }
    const bool overlong = (bytes == 3 && code < 0x800U) || (bytes == 4 && code < 0x10000U);
    const bool outside = code > 0x10FFFFU || (code >= 0xD800U && code < 0xE000U);
    return overlong || outside ? Character{} : Character{code, bytes};
}

/// C0, DEL, C1, and the characters that turn the direction of writing or end a line.
bool is_control(char32_t code) {
    return code < 0x20U || (code >= 0x7FU && code < 0xA0U) || (code >= 0x200BU && code <= 0x200FU) ||
           (code >= 0x2028U && code <= 0x202EU) || (code >= 0x2066U && code <= 0x2069U) || code == 0xFEFFU ||
           (code & 0xFFFEU) == 0xFFFEU;
}

struct Block {
    char32_t first, last;
};

template <std::size_t n>
bool is_in(char32_t code, const std::array<Block, n>& blocks) {
    return std::any_of(blocks.begin(), blocks.end(),
                       [code](Block block) { return code >= block.first && code <= block.last; });
}

// NOTE: not wcwidth(), which knows nothing but ASCII in the locale "C". The blocks are those of labels in practice.
constexpr std::array<Block, 4> combining{{{0x300, 0x36F}, {0x1AB0, 0x1AFF}, {0x20D0, 0x20FF}, {0xFE00, 0xFE2F}}};
constexpr std::array<Block, 7> wide{{{0x1100, 0x115F},
                                     {0x2E80, 0xA4CF},
                                     {0xAC00, 0xD7A3},
                                     {0xF900, 0xFAFF},
                                     {0xFF00, 0xFF60},
                                     {0x1F300, 0x1F64F},
                                     {0x20000, 0x3FFFD}}};

std::size_t width_of(char32_t code) {
    return is_in(code, combining) ? 0 : is_in(code, wide) ? 2 : 1;
}

constexpr std::array<std::pair<char32_t, std::string_view>, 34> spelled{
    {{U'α', "alpha"}, {U'β', "beta"},  {U'γ', "gamma"}, {U'δ', "delta"},  {U'ε', "epsilon"}, {U'ζ', "zeta"},
     {U'η', "eta"},   {U'θ', "theta"}, {U'κ', "kappa"}, {U'λ', "lambda"}, {U'μ', "mu"},      {U'ν', "nu"},
     {U'π', "pi"},    {U'ρ', "rho"},   {U'σ', "sigma"}, {U'τ', "tau"},    {U'φ', "phi"},     {U'χ', "chi"},
     {U'ψ', "psi"},   {U'ω', "omega"}, {U'Δ', "Delta"}, {U'Θ', "Theta"},  {U'Σ', "Sigma"},   {U'Φ', "Phi"},
     {U'Ψ', "Psi"},   {U'Ω', "Omega"}, {U'₀', "0"},     {U'₁', "1"},      {U'²', "^2"},      {U'°', " deg"},
     {U'·', "."},     {U'−', "-"},     {U'…', "..."},   {U'′', "'"}}};

}  // namespace

std::string displayable(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const Character character = decode(text);
        if (character.bytes == 0) {
            result += "\xEF\xBF\xBD";
        } else if (is_control(character.code)) {
            result += ' ';
        } else {
            result += text.substr(0, character.bytes);
        }
        text.remove_prefix(std::max<std::size_t>(character.bytes, 1));
    }
    return result;
}

std::size_t display_width(std::string_view text) {
    std::size_t width = 0;
    while (!text.empty()) {
        const Character character = decode(text);
        width += width_of(character.code);
        text.remove_prefix(std::max<std::size_t>(character.bytes, 1));
    }
    return width;
}

std::string_view cut_to_width(std::string_view text, std::size_t width) {
    std::size_t used = 0;
    std::size_t end = 0;
    while (end < text.size()) {
        const Character character = decode(text.substr(end));
        used += width_of(character.code);
        if (used > width) {
            break;
        }
        end += std::max<std::size_t>(character.bytes, 1);
    }
    return text.substr(0, end);
}

std::string in_ascii(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const Character character = decode(text);
        if (character.code != 0 && character.code < 0x80U) {
            result += static_cast<char>(character.code);
        } else if (width_of(character.code) > 0) {
            const auto* found = std::find_if(spelled.begin(), spelled.end(),
                                             [character](const auto& pair) { return pair.first == character.code; });
            result += found != spelled.end() ? found->second : "?";
        }
        text.remove_prefix(std::max<std::size_t>(character.bytes, 1));
    }
    return result;
}

}  // namespace dinal::text
