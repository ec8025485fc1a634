// What a picture says to those who do not see it: its title and a description, in words and within its SVG.
#pragma once

#include <span>
#include <string>

#include "plots/figure.hpp"

namespace dinal::plots {

/// The titles of the figures, or what is drawn over what: "θ, M/k over t".
std::string title_of(std::span<const Figure> figures);

/// The SVG of these figures with title, description and label for screen readers.
std::string with_words(std::string svg, std::span<const Figure> figures);

/// The element <svg> of such a file for a page: without its head, and with names that no other picture of the page
/// has.
std::string element_of(std::string svg);

}  // namespace dinal::plots
