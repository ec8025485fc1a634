// The title and description of a picture within its SVG, for screen readers.
#pragma once

#include <span>
#include <string>

#include "plots/figure.hpp"

namespace dinal::plots {

/// The titles of the figures, or the quantities drawn: "θ, M/k over t".
std::string title_of(std::span<const Figure> figures);

/// The SVG of these figures with title, description and label for screen readers.
std::string with_words(std::string svg, std::span<const Figure> figures);

/// The <svg> element of an SVG file, to be put into a page: without the file's head, and with unique identifiers.
std::string element_of(std::string svg);

}  // namespace dinal::plots
