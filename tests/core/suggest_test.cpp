#include "text/suggest.hpp"

#include <string>
#include <string_view>
#include <vector>

#include "support/catch.hpp"

namespace dinal::suggest_test {

using dinal::text::did_you_mean;
using dinal::text::suggestions;
using Names = std::vector<std::string>;

using List = std::vector<std::string_view>;

TEST_CASE("a word is matched to the most similar names, by its letters or by its meaning", "[suggest]") {
    const List of_system{"I", "k", "C", "Rd", "Re"}, columns{"t", "theta", "velocity", "M", "friction", "damping"},
        options{"amplitude", "frequency", "omega", "phase", "at", "width", "step"},
        terms{"harmonic", "pulse", "samples", "chirp"}, fields{"T0", "omega0", "I", "M"},
        globals{"os", "rawget", "T0", "dofile"};
    struct Case {
        std::string word;
        List among;
        Names found;
    };
    const Case cases[] = {
        // one slip: missing, too many, wrong, swapped
        {"teta", columns, {"theta"}},
        {"thetta", columns, {"theta"}},
        {"thota", columns, {"theta"}},
        {"tehta", columns, {"theta"}},
        {"stpe", options, {"step"}},
        {"tetha", columns, {"theta"}},
        // two slips are allowed in words of more than four letters only, three never
        {"velosty", columns, {"velocity"}},
        {"frictoin1", columns, {"friction"}},
        {"vlct", columns, {}},
        {"stab", options, {}},
        {"velaseti", columns, {}},
        // another case counts as one slip
        {"THETA", columns, {"theta"}},
        {"m", columns, {"M"}},
        {"RD", of_system, {"Rd"}},
        {"THEAT", columns, {"theta"}},
        // the beginning of a longer name, if it is long enough
        {"freq", options, {"frequency"}},
        {"Vel", columns, {"velocity"}},
        {"ve", columns, {}},
        // two equally good matches are both named, three are too many, and worse ones do not count
        {"R", of_system, {"Rd", "Re"}},
        {"M", {"M1", "M2", "M3"}, {}},
        {"theta", {"theta12", "theta0", "theta1"}, {"theta0", "theta1"}},
        // nothing like it, nothing at all, itself, a name known twice
        {"q", columns, {}},
        {"", columns, {}},
        {"colour", columns, {}},
        {"theta", {}, {}},
        {std::string(5000, 'a'), columns, {}},
        {"theta", columns, {}},
        {"teta", {"theta", "theta", "M"}, {"theta"}},
        {"ls", globals, {}},
        {"x0", globals, {}},
        {"range", globals, {}},
        // other words for the same thing count more than a likeness of letters, but not more than another case
        {"sin", terms, {"harmonic"}},
        {"Cosine", terms, {"harmonic"}},
        {"impulse", terms, {"pulse"}},
        {"w0", fields, {"omega0"}},
        {"mass", fields, {"I"}},
        {"m", fields, {"M"}},
        {"sine", {"sin", "sinh"}, {"sin", "sinh"}},
        {"x", columns, {"theta"}},
    };
    for (const Case& one : cases) {
        CAPTURE(one.word);
        CHECK(suggestions(one.word, one.among) == one.found);
    }
    CHECK(suggestions("x", columns, dinal::text::Likeness::of_letters).empty());  // a user's variable may be anything
    CHECK(did_you_mean("teta", columns) == "; did you mean 'theta'?");
    CHECK(did_you_mean("R", of_system) == "; did you mean 'Rd' or 'Re'?");
    CHECK(did_you_mean("colour", columns).empty());
}

}  // namespace dinal::suggest_test
