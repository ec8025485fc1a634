// What a picture says to those who do not see it: its title and a description, in words and within its SVG.
#pragma once

#include <span>
#include <string>

#include "plots/figure.hpp"

namespace dinal::plots {

/// The titles of the figures, or what is drawn over what: "θ, M/k over t".
std::string title_of(std::span<const Figure> figures);

/// The SVG of these figures that gnuplot wrote, with title, description and label for screen readers.
std::string with_words(std::string svg, std::span<const Figure> figures);

/// The element <svg> for a page, out of such a file: without its head, and without the titles of gnuplot's curves,
/// which a browser would show under the mouse and read aloud.
std::string element_of(std::string svg);

}  // namespace dinal::plots
