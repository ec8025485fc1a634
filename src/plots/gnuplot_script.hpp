// Figures as gnuplot commands in a style of our own, with the data that these commands read.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

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

// Columns of numbers on their way into a gnuplot script: binary behind the command that reads them, or as named blocks
// of text before all commands.

enum class DataForm { binary, text };

class GnuplotData {
public:
    explicit GnuplotData(DataForm form) : form_(form) {}

    /// Takes columns of one length, NaN for gaps, and returns what follows the word `plot`: "$data1 using 1:2".
    std::string add(const std::vector<std::vector<double>>& columns);

    /// To be put before all commands; "" for binary data.
    [[nodiscard]] const std::string& blocks() const { return blocks_; }
    /// To be put behind the line with the command that reads them; empties the store.
    std::string take_binary();

private:
    DataForm form_;
    int count_ = 0;
    std::string blocks_;
    std::string binary_;
};

/// 'text' as gnuplot reads it back: an expression with each apostrophe between double quotes, and control characters
/// made blanks, for a line end would end the command.
std::string quoted_words(std::string_view text);

}  // namespace dinal::plots
