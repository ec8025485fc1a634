// Figures as files: SVG, PDF and PNG, drawn with cairo.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "plots/figure.hpp"
#include "plots/paper_layout.hpp"
#include "text/expected.hpp"

namespace dinal::plots {

enum class PictureKind { svg, png, pdf };

/// The bytes of the file. An SVG has a title and a description for screen readers. go_on() is called every few thousand
/// points; false ends drawing with an error.
text::Expected<std::string> paint(
    std::span<const Figure> given, PictureKind kind, PaperSize size,
    const std::function<bool()>& go_on = [] { return true; });

}  // namespace dinal::plots
