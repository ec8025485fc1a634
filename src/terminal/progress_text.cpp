#include "terminal/progress_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "text/characters.hpp"

namespace dinal::terminal {
namespace {

constexpr std::size_t longest_bar = 30;  // columns within its ends
constexpr std::size_t shortest_bar = 6;

/// A text and its columns on the screen.
struct Piece {
    std::string text;
    std::size_t width = 0;
};

Piece ascii_piece(std::string text) {
    const std::size_t width = text.size();
    return {std::move(text), width};
}

/// The label in at most so many columns.
Piece label_piece(const std::string& label, std::size_t columns, Letters letters) {
    const std::string clean = text::displayable(label);
    const std::string shown = letters == Letters::utf8 ? clean : text::in_ascii(clean);
    if (text::columns(shown) <= columns) {
        return {shown, text::columns(shown)};
    }
    const std::string_view dots = letters == Letters::utf8 ? "…" : ".";
    const std::string cut = columns > 0 ? std::string(text::cut_to_columns(shown, columns - 1)).append(dots) : "";
    return {cut, text::columns(cut)};
}

/// With its ends `columns` wide.
Piece bar_piece(double fraction, std::size_t columns, Letters letters) {
    constexpr std::array<const char*, 8> parts{"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
    const std::size_t inner = columns - 2;
    const double filled = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(inner);
    const auto whole = static_cast<std::size_t>(filled);
    std::string text = letters == Letters::utf8 ? "▕" : "[";
    for (std::size_t i = 0; i < whole; ++i) {
        text += letters == Letters::utf8 ? "█" : "#";
    }
    std::size_t rest = inner - whole;
    if (letters == Letters::utf8 && rest > 0) {
        const std::string_view part = parts.at(static_cast<std::size_t>((filled - std::floor(filled)) * 8));
        text += part;
        rest -= part.empty() ? 0 : 1;
    }
    text.append(rest, letters == Letters::utf8 ? ' ' : '.').append(letters == Letters::utf8 ? "▏" : "]");
    return {text, columns};
}

/// Pieces with a blank between them; empty ones take no room.
Piece joined(const std::vector<Piece>& pieces) {
    Piece result;
    for (const Piece& piece : pieces) {
        if (piece.width > 0) {
            result.text += (result.width > 0 ? " " : "") + piece.text;
            result.width += (result.width > 0 ? 1 : 0) + piece.width;
        }
    }
    return result;
}

Piece listed(const std::vector<std::string>& facts) {
    std::vector<std::string_view> there(facts.begin(), facts.end());
    there.erase(std::remove(there.begin(), there.end(), ""), there.end());
    return ascii_piece(fmt::format("{}", fmt::join(there, ", ")));
}

}  // namespace

std::string progress_text(const ProgressFacts& facts, std::size_t columns, Letters letters) {
    const bool known = facts.fraction >= 0;
    const Piece label = label_piece(facts.label, columns / 3, letters);
    // Rounded down: 100% would be a lie before the end.
    const Piece percent = ascii_piece(known ? fmt::format("{:3.0f}%", std::floor(100 * facts.fraction)) : "");
    const std::string left = known ? duration_text(facts.seconds_left) + " left" : "";
    const std::array<std::vector<std::string>, 4> choices{
        {{facts.done, facts.rate, left}, {facts.rate, left}, {left}, {}}};
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const Piece tail = listed(choices.at(i));
        const std::size_t taken = joined({label, percent, tail}).width + (known ? 1 : 0);
        const std::size_t room = columns > taken ? columns - taken : 0;
        const std::size_t least = (i == 0 ? 2 : 1) * shortest_bar + 2;
        if (known && room >= least) {
            return joined({label, percent, bar_piece(facts.fraction, std::min(room, longest_bar + 2), letters), tail})
                .text;
        }
        const bool without_bar = taken <= columns && (!known || i >= 2);
        if (without_bar) {
            return joined({label, percent, tail}).text;
        }
    }
    return percent.width <= columns ? percent.text : "";
}

std::string duration_text(double seconds) {
    constexpr double longest = 360'000;  // 100 hours
    if (!(seconds < longest)) {
        return fmt::format("{:.0f} days", seconds < 1e9 ? seconds / 86'400 : 1e6);
    }
    const auto whole = static_cast<int>(std::ceil(seconds));
    if (whole < 60) {
        return fmt::format("{} s", whole);
    }
    return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                        : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace dinal::terminal
