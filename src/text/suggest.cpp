#include "text/suggest.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "text/words.hpp"

namespace dinal::text {
namespace {

constexpr std::size_t longest_word = 64;  // letters; bounds the work for odd input
constexpr std::size_t shortest_beginning = 3;
constexpr int most_slips = 2;
constexpr int far = 1000;

// Names that other books and programs use. A synonym counts only if its target is among the known names.
constexpr std::array<std::pair<std::string_view, std::string_view>, 69> synonyms = {{
    {"sin", "harmonic"},
    {"sine", "harmonic"},
    {"cos", "harmonic"},
    {"cosine", "harmonic"},
    {"sinus", "harmonic"},
    {"impulse", "pulse"},
    {"rectangle", "pulse"},
    {"sweep", "chirp"},
    {"table", "samples"},
    {"data", "samples"},
    {"file", "samples"},
    {"func", "scripted"},
    {"euler", "rk4"},
    {"rungekutta", "rk4"},
    {"runge_kutta", "rk4"},
    {"run", "simulate"},
    {"solve", "simulate"},
    {"integrate", "simulate"},
    {"w0", "omega0"},
    {"wn", "omega0"},
    {"omega_n", "omega0"},
    {"period", "T0"},
    {"xi", "zeta"},
    {"damping_ratio", "zeta"},
    {"m", "I"},
    {"j", "I"},
    {"mass", "I"},
    {"inertia", "I"},
    {"stiffness", "k"},
    {"damping", "C"},
    {"friction", "Rd"},
    {"torque", "M"},
    {"force", "M"},
    {"f", "M"},
    {"excitation", "M"},
    {"x0", "theta0"},
    {"v0", "velocity0"},
    {"step", "dt"},
    {"h", "dt"},
    {"step", "h"},
    {"dt", "h"},
    {"duration", "t_end"},
    {"tmax", "t_end"},
    {"t_max", "t_end"},
    {"method", "integrator"},
    {"solver", "integrator"},
    {"x", "theta"},
    {"angle", "theta"},
    {"position", "theta"},
    {"displacement", "theta"},
    {"v", "velocity"},
    {"speed", "velocity"},
    {"time", "t"},
    {"f", "frequency"},
    {"w", "omega"},
    {"phi", "phase"},
    {"maximum", "max"},
    {"minimum", "min"},
    {"average", "mean"},
    {"write", "save"},
    {"export", "save"},
    {"to_csv", "save"},
    {"describe", "explain"},
    {"draw", "plot"},
    {"level", "amplitude"},
    {"levels", "amplitude"},
    {"width", "sigma"},
    {"width", "duration"},
    {"error", "std_error"},
}};

bool is_synonym(std::string_view small_word, std::string_view name) {
    return contains(synonyms, std::pair(small_word, name));
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

bool same_letters(std::string_view a, std::string_view b) {
    return std::ranges::is_permutation(a, b);
}

/// Returns the allowed number of slips. A word of two letters must at least begin as the name does: w0 is not T0.
int allowed_slips(std::string_view small_word, std::string_view small_name) {
    if (small_word.size() <= 2) {
        return small_word.front() == small_name.front() ? 1 : 0;
    }
    return small_word.size() > 5 || (small_word.size() == 5 && same_letters(small_word, small_name)) ? 2 : 1;
}

/// Returns the number of slips between word and name (0: only case differs); `far` if it is no misspelling.
int slips(std::string_view word, std::string_view name) {
    if (word.empty() || name.empty() || word == name || std::max(word.size(), name.size()) > longest_word) {
        return far;
    }
    const std::string small_word = lower(word);
    const std::string small_name = lower(name);
    if (small_word == small_name) {
        return 0;  // a match except for case is better than any slip: RD is Rd, not Re
    }
    const int count = std::min(edits(word, name), edits(small_word, small_name) + 1);
    const int allowed = allowed_slips(small_word, small_name);
    // At least one letter must remain: x is not a misspelt t.
    if (count <= allowed && count < static_cast<int>(std::max(word.size(), name.size()))) {
        return count;
    }
    const bool beginning = word.size() >= shortest_beginning && small_name.starts_with(small_word);
    return beginning ? most_slips + 1 : far;
}

/// Returns the distance from the word, or its synonym, to the name; `far` if unrelated.
int distance(std::string_view word, std::string_view name, Likeness likeness) {
    const int count = slips(word, name);
    const bool other_word = count > 0 && likeness == Likeness::of_meaning && is_synonym(lower(word), name);
    return other_word ? 1 : 2 * count;  // ranks between different case and one slip
}

}  // namespace

std::vector<std::string> suggestions(std::string_view word, const KnownNames& known, Likeness likeness) {
    std::vector<std::string> best;
    if (word.size() > longest_word) {
        return best;
    }
    int fewest = far;
    for (const std::string_view name : known.names) {
        const int count = distance(word, name, likeness);
        if (count < fewest) {
            fewest = count;
            best.clear();
        }
        if (count == fewest && count < far && !contains(best, name)) {
            best.emplace_back(name);
        }
    }
    if (best.size() > 2) best.clear();
    return best;
}

std::string did_you_mean_one_of(const std::vector<std::string>& names) {
    if (names.empty() || names.size() > 2) return "";
    const std::string other = names.size() == 2 ? " or '" + names.back() + "'" : "";
    return "; did you mean '" + names.front() + "'" + other + "?";
}

std::string did_you_mean(std::string_view word, const KnownNames& known, Likeness likeness) {
    return did_you_mean_one_of(suggestions(word, known, likeness));
}

}  // namespace dinal::text
