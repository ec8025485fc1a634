// What a user's function said that its arguments do not explain: one value, and later another for the same arguments.
#pragma once

#include <string>

namespace dinal::model {

/// M must be a function of what it is given. This one remembers something, or rolls dice.
struct Contradiction {
    std::string who;       ///< as users call it: "M"
    const char* argument;  ///< what `at` is: "t"
    double at = 0;
    double first = 0, again = 0;  ///< what it gave, and what it gave when it was asked again
};

/// "M depends on more than its arguments: at t = 3.25 it gave 0.5 and, asked again, 0.7"
std::string sentence(const Contradiction& found);
/// The same, and what to do about it.
std::string sentence_with_cure(const Contradiction& found);

}  // namespace dinal::model
