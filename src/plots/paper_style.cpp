#include "plots/paper_style.hpp"

#include <fmt/format.h>

#include <array>

namespace dinal::plots {
namespace {

// Okabe and Ito's colours, which the colour-blind tell apart, without the yellow, which paper swallows.
constexpr std::array<std::string_view, 7> palette{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                  "#000000", "#E69F00", "#56B4E9"};
// Another length of this list than of that one: the pair repeats after 42 curves only.
constexpr std::array<std::string_view, 6> dash_types{"1", "(11,4)", "(2,3)", "(11,3,2,3)", "(6,3)", "(11,3,2,3,2,3)"};

std::string_view dash_type(Dashes dashes, std::size_t curve) {
    switch (dashes) {
        case Dashes::solid:
            return dash_types[0];
        case Dashes::dashed:
            return dash_types[1];
        case Dashes::dotted:
            return dash_types[2];
        case Dashes::dash_dotted:
            return dash_types[3];
        case Dashes::by_place:
            break;
    }
    return dash_types[curve % dash_types.size()];
}

}  // namespace

std::string colour_of(const Figure& figure, std::size_t curve) {
    const int own = figure.curves[curve].colour;
    return std::string(palette[(own > 0 ? static_cast<std::size_t>(own - 1) : curve) % palette.size()]);
}

std::string tint_of(const Figure& figure, std::size_t curve, double strength) {
    const auto full = static_cast<unsigned>(std::stoul(colour_of(figure, curve).substr(1), nullptr, 16));
    unsigned tint = 0;
    for (const unsigned shift : {16U, 8U, 0U}) {
        const double paper = 255, own = (full >> shift) & 255U;
        tint |= static_cast<unsigned>(paper + strength * (own - paper)) << shift;
    }
    return fmt::format("#{:06X}", tint);
}

std::string line_style(const Figure& figure, std::size_t curve) {
    return fmt::format("lt 1 lw {} dt {} lc rgb '{}'", line_width, dash_type(figure.curves[curve].dashes, curve),
                       colour_of(figure, curve));
}

std::string point_style(const Figure& figure, std::size_t curve) {
    constexpr std::array<int, 5> shapes{6, 2, 8, 4, 1};  // circle, x, triangle, square, +
    constexpr std::size_t crowd = 500;                   // in which shapes would hide each other
    if (figure.curves[curve].size() > crowd) return fmt::format("pt 7 ps 0.12 lc rgb '{}'", colour_of(figure, curve));
    return fmt::format("pt {} ps 0.45 lw 0.6 lc rgb '{}'", shapes[curve % shapes.size()], colour_of(figure, curve));
}

std::string fill_style(const Figure& figure, std::size_t curve) {
    constexpr double density = 0.25;
    return fmt::format("fc rgb '{}' fs transparent solid {} noborder", colour_of(figure, curve), density);
}

std::string dot_style(const Figure& figure, std::size_t curve) {
    return fmt::format("pt 7 ps 0.35 lc rgb '{}'", colour_of(figure, curve));
}

std::string mark_style(MarkKind kind) {
    constexpr std::array<int, 4> shapes = {6, 7, 13, 12};  // circles, and diamonds for events
    return fmt::format("pt {} ps 0.7 lw 0.8 lc rgb '{}'", shapes[static_cast<std::size_t>(kind)], ink_colour);
}

}  // namespace dinal::plots
