// Did-you-mean: the known names that a misspelt word probably stands for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dinal::text {

/// The names that a word may mean: of any list of texts, which must outlive it.
struct KnownNames {
    template <class List>
    KnownNames(const List& list)  // NOLINT(google-explicit-constructor): any list will do
        : names(std::begin(list), std::end(list)) {}
    std::vector<std::string_view> names;
};

/// The best matches for a word that is not among the known ones: two at most, none when nothing is close or too much
/// is. Close is one slip (a letter wrong, missing, too many, two swapped) in words of up to five letters, two in longer
/// ones and between words of the same letters; different case counts as one slip, and as none when nothing else
/// differs. The beginning of a longer name (three letters or more) is close, too. What others call the same thing
/// (mass, w0, sine) is better than any slip.
enum class Likeness { of_letters, of_meaning };
std::vector<std::string> suggestions(std::string_view word, const KnownNames& known,
                                     Likeness likeness = Likeness::of_meaning);

/// The same as the end of a sentence: "", "; did you mean 'theta'?" or "; did you mean 'Rd' or 'Re'?".
std::string did_you_mean(std::string_view word, const KnownNames& known, Likeness likeness = Likeness::of_meaning);

}  // namespace dinal::text
