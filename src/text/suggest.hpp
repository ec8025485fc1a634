// Did-you-mean: the known names that a misspelt word probably stands for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dinal::text {

/// A view of known names: any list of texts, which must outlive it.
struct KnownNames {
    template <class List>
    KnownNames(const List& list)  // NOLINT(google-explicit-constructor): accepts any list
        : names(std::begin(list), std::end(list)) {}
    std::vector<std::string_view> names;
};

/// Returns at most two matches for an unknown word, none if no name or too many names are close. Close means one slip
/// (a letter wrong, missing, extra, or two swapped) in words of up to five letters, and two in longer words or among
/// the same letters. A different case counts as one slip, or none if nothing else differs. A beginning (three letters
/// or more) of a longer name is close, too. Common synonyms (mass, w0, sine) rank before slips.
enum class Likeness { of_letters, of_meaning };
std::vector<std::string> suggestions(std::string_view word, const KnownNames& known,
                                     Likeness likeness = Likeness::of_meaning);

/// "; did you mean 'theta'?" or "; did you mean 'Rd' or 'Re'?"; "" for none or more than two.
std::string did_you_mean_one_of(const std::vector<std::string>& names);

/// The same for the suggestions.
std::string did_you_mean(std::string_view word, const KnownNames& known, Likeness likeness = Likeness::of_meaning);

}  // namespace dinal::text
