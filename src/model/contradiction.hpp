// A user's function that returned two values for the same arguments.
#pragma once

#include <string>

namespace dinal::model {

/// M must depend on its arguments only; this function has a memory or uses random numbers.
struct Contradiction {
    std::string who;       ///< the function's name for the user: "M"
    const char* argument;  ///< the name of the argument `at`: "t"
    double at = 0;
    double first = 0, again = 0;  ///< the value returned first, and later for the same argument
};

/// "M depends on more than its arguments: at t = 3.25 it returned 0.5 and, evaluated again, 0.7"
std::string sentence(const Contradiction& found);
/// sentence(found), followed by the remedy.
std::string sentence_with_cure(const Contradiction& found);

}  // namespace dinal::model
