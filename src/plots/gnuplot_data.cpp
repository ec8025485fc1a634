#include "plots/gnuplot_data.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "text/characters.hpp"

namespace dinal::plots {

std::string GnuplotData::add(const std::vector<std::vector<double>>& columns) {
    std::string use;
    std::string format;
    for (std::size_t column = 0; column < columns.size(); ++column) {
        use += fmt::format("{}{}", column == 0 ? "" : ":", column + 1);
        format += "%double";
    }
    const std::size_t rows = columns.front().size();
    if (form_ == DataForm::binary) {
        for (std::size_t row = 0; row < rows; ++row) {
            for (const std::vector<double>& column : columns) {
                binary_.append(reinterpret_cast<const char*>(&column[row]), sizeof(double));  // as it lies in memory
            }
        }
        return fmt::format("'-' binary record=({}) format='{}' using {}", rows, format, use);
    }
    const std::string name = fmt::format("$data{}", ++count_);
    blocks_ += name + " << end\n";
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < columns.size(); ++column) {
            const double value = columns[column][row];
            blocks_ +=
                fmt::format("{}{}", column == 0 ? "" : " ", std::isnan(value) ? "NaN" : fmt::format("{}", value));
        }
        blocks_ += '\n';
    }
    blocks_ += "end\n";
    return fmt::format("{} using {}", name, use);
}

std::string GnuplotData::take_binary() {
    return std::exchange(binary_, {});
}

std::string quoted_words(std::string_view text) {
    std::string result = "'";
    for (const char c : text::displayable(text)) {
        // NOTE: gnuplot 5.4 loses count of apostrophes that follow each other, also of doubled ones. Between double
        // quotes nothing but an apostrophe is ever put, for in them a backquote starts a shell.
        result += c == '\'' ? std::string("'.\"'\".'") : std::string{c};
    }
    return result + "'";
}

}  // namespace dinal::plots
