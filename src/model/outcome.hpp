// The outcomes of a run, in one list with their sentences, so that neither can be forgotten.
#pragma once

#include <string>
#include <string_view>

namespace dinal::model {

#define DINAL_OUTCOMES(X)                                                                                 \
    X(reached_end, "reached the end")                                                                     \
    X(at_rest, "at rest")                                                                                 \
    X(stuck_at_end, "stuck at the end")                                                                   \
    X(stopped, "stopped at an event")                                                                     \
    X(interrupted, "interrupted")                                                                         \
    X(state_not_finite, "the state became infinite: unstable system, feedback or step")                   \
    X(excitation_not_finite, "M failed or became infinite")                                               \
    X(not_a_function, "M depends on more than its arguments: evaluated again, it returned another value") \
    X(unresolved, "the motion is not resolved at this time: try a larger tolerance, or rk4")              \
    X(chattering, "switched endlessly at one time")

enum class Outcome {
#define DINAL_OUTCOME(id, sentence) id,
    DINAL_OUTCOMES(DINAL_OUTCOME)
#undef DINAL_OUTCOME
};

/// Returns whether the run reached the end of its window.
constexpr bool is_whole(Outcome outcome) {
    return outcome == Outcome::reached_end || outcome == Outcome::at_rest || outcome == Outcome::stuck_at_end;
}

constexpr std::string_view sentence(Outcome outcome) {
    switch (outcome) {
#define DINAL_OUTCOME(id, text) \
    case Outcome::id:           \
        return text;
        DINAL_OUTCOMES(DINAL_OUTCOME)
#undef DINAL_OUTCOME
    }
    return "";
}

/// A user's function that returned two values for the same arguments: it has a memory or uses random numbers.
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
