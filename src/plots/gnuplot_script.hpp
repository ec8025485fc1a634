// Figures as gnuplot commands in a style of our own, with the data that these commands read.
#pragma once

#include <span>
#include <string>

#include "plots/figure.hpp"

namespace dinal::plots {

enum class Terminal { svg, png, pdf };

/// Centimetres. Zero: as wide as a column of a paper (two panels: as its text), and as high as that needs.
struct PaperSize {
    double width = 0;
    double height = 0;
};

/// What gnuplot must get on its standard input to write the picture to its standard output. Data are binary. A user's
/// words are in single quotes, where gnuplot knows neither commands nor escapes, their apostrophes in double ones.
std::string gnuplot_input(std::span<const Figure> given, Terminal terminal, PaperSize size);

/// The same as a file for people: data in readable blocks, and a head that says how to draw it.
std::string gnuplot_file(std::span<const Figure> given, PaperSize size);

}  // namespace dinal::plots
