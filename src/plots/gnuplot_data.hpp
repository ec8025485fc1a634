// Columns of numbers on their way into a gnuplot script: binary behind the command that reads them, or as named blocks
// of text before all commands.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dinal::plots {

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
