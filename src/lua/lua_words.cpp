#include "lua/lua_words.hpp"

#include <algorithm>
#include <cctype>
#include <string>

namespace dinal {
namespace {

bool is_digit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}
bool is_name_char(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Walks through Lua text from word to word, skipping strings and comments.
class Words {
public:
    explicit Words(std::string_view text) : text_(text) {}

    /// The next word, or an empty one at the end.
    std::string_view next() {
        while (at_ < text_.size()) {
            if (is_digit(text_[at_])) {
                word();  // 0xend is a number
            } else if (is_name_char(text_[at_])) {
                return word();
            } else {
                skip();
            }
        }
        return {};
    }
    [[nodiscard]] int line() const { return line_; }
    /// Where the last word ended.
    [[nodiscard]] std::size_t end() const { return at_; }

private:
    std::string_view word() {
        const std::size_t start = at_;
        while (at_ < text_.size() && is_name_char(text_[at_])) {
            ++at_;
        }
        return text_.substr(start, at_ - start);
    }
    void skip() {
        const char c = text_[at_];
        if (text_.substr(at_, 2) == "--") {
            at_ += 2;
            if (long_bracket_level() < 0) {
                advance_to(text_.find('\n', at_));
            }
        }
        if (long_bracket_level() >= 0) {
            skip_long_bracket();
        } else if (c == '"' || c == '\'') {
            skip_string(c);
        } else {
            step();
        }
    }
    void step() {
        if (at_ < text_.size()) {
            line_ += text_[at_++] == '\n' ? 1 : 0;
        }
    }
    void advance_to(std::size_t target) {
        target = std::min(target, text_.size());
        while (at_ < target) {
            step();
        }
    }
    void skip_string(char quote) {
        step();
        while (at_ < text_.size() && text_[at_] != quote) {
            if (text_[at_] == '\\') {
                step();
            }
            step();
        }
        step();
    }
    /// The number of = in the long bracket that opens here; -1 when none does.
    [[nodiscard]] int long_bracket_level() const {
        if (at_ >= text_.size() || text_[at_] != '[') {
            return -1;
        }
        const std::size_t second = std::min(text_.find_first_not_of('=', at_ + 1), text_.size());
        return second < text_.size() && text_[second] == '[' ? static_cast<int>(second - at_ - 1) : -1;
    }
    void skip_long_bracket() {
        const std::string close = "]" + std::string(static_cast<std::size_t>(long_bracket_level()), '=') + "]";
        advance_to(text_.find(close, at_ + 1));
        at_ = std::min(at_ + close.size(), text_.size());
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
};

}  // namespace

std::vector<std::string_view> functions_between(std::string_view text, int first_line, int last_line) {
    struct Block {
        std::size_t start;
        bool wanted;
    };
    std::vector<Block> open;
    std::vector<std::string_view> found;
    Words words(text);
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        if (word == "function" || word == "do" || word == "if" || word == "repeat") {
            open.push_back({words.end() - word.size(), word == "function" && words.line() == first_line});
        } else if ((word == "end" || word == "until") && !open.empty()) {
            if (open.back().wanted && words.line() == last_line) {
                found.push_back(text.substr(open.back().start, words.end() - open.back().start));
            }
            open.pop_back();
        }
    }
    return found;
}

}  // namespace dinal
