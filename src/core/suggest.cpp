#include "core/suggest.hpp"

#include <algorithm>
#include <cstddef>

namespace dinal {
namespace {

constexpr std::size_t longest_word = 64;  // nobody mistypes more than that; it bounds the work for odd input
constexpr std::size_t shortest_beginning = 3;
constexpr int far = 1000;

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(), [](char c) { return lower(c); });
    return result;
}

/// Insertions, deletions, substitutions and swaps of neighbours that turn a into b (optimal string alignment).
int edits(std::string_view a, std::string_view b) {
    std::vector<int> before_last(b.size() + 1);
    std::vector<int> last(b.size() + 1);
    std::vector<int> current(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) {
        last[j] = static_cast<int>(j);
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        current[0] = static_cast<int>(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int substituted = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            current[j] = std::min({last[j] + 1, current[j - 1] + 1, substituted});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                current[j] = std::min(current[j], before_last[j - 2] + 1);
            }
        }
        std::swap(before_last, last);
        std::swap(last, current);
    }
    return last[b.size()];
}

/// How many slips the word is from the name (0: another case only); `far` when it is no misspelling of it.
int slips(std::string_view word, std::string_view name) {
    if (word.empty() || name.empty() || word == name || std::max(word.size(), name.size()) > longest_word) {
        return far;
    }
    const std::string small_word = lower(word);
    const std::string small_name = lower(name);
    if (small_word == small_name) {
        return 0;  // better than any slip: RD is Rd, not Re
    }
    const int count = std::min(edits(word, name), edits(small_word, small_name) + 1);
    const int allowed = word.size() <= 4 ? 1 : 2;
    // A word of which no letter is left is another word: x is not a misspelt t.
    if (count <= allowed && count < static_cast<int>(std::max(word.size(), name.size()))) {
        return count;
    }
    const bool beginning = word.size() >= shortest_beginning && small_name.starts_with(small_word);
    return beginning ? allowed + 1 : far;
}

}  // namespace

std::vector<std::string> suggestions(std::string_view word, std::span<const std::string_view> known) {
    std::vector<std::string> best;
    int fewest = far;
    for (const std::string_view name : known) {
        const int count = slips(word, name);
        if (count < fewest) {
            fewest = count;
            best.clear();
        }
        if (count == fewest && count < far && std::find(best.begin(), best.end(), name) == best.end()) {
            best.emplace_back(name);
        }
    }
    if (best.size() > 2) {
        best.clear();
    }
    return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> known) {
    const std::vector<std::string> best = suggestions(word, known);
    if (best.empty()) {
        return {};
    }
    std::string text = "; did you mean '" + best.front() + "'";
    if (best.size() > 1) {
        text += " or '" + best.back() + "'";
    }
    return text + "?";
}

}  // namespace dinal
