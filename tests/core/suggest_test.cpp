#include "text/suggest.hpp"

#include <array>

#include "support/catch.hpp"

namespace dinal::suggest_test {

using dinal::text::did_you_mean;
using dinal::text::suggestions;
using Names = std::vector<std::string>;

namespace {
constexpr std::array<std::string_view, 5> of_system = {"I", "k", "C", "Rd", "Re"};
constexpr std::array<std::string_view, 6> columns = {"t", "theta", "velocity", "M", "friction", "damping"};
constexpr std::array<std::string_view, 7> options = {"amplitude", "frequency", "omega", "phase", "at", "width", "step"};
}  // namespace

TEST_CASE("a word with one slip is recognised", "[suggest]") {
    CHECK(suggestions("teta", columns) == Names{"theta"});    // missing
    CHECK(suggestions("thetta", columns) == Names{"theta"});  // too many
    CHECK(suggestions("thota", columns) == Names{"theta"});   // wrong
    CHECK(suggestions("tehta", columns) == Names{"theta"});   // swapped
    CHECK(suggestions("stpe", options) == Names{"step"});     // swapped in a short word
    CHECK(suggestions("widht", options) == Names{"width"});
}

TEST_CASE("two slips are allowed in words of more than four letters only", "[suggest]") {
    CHECK(suggestions("velosty", columns) == Names{"velocity"});
    CHECK(suggestions("frictoin1", columns) == Names{"friction"});
    CHECK(suggestions("vlct", columns).empty());
    CHECK(suggestions("stab", options).empty());
    CHECK(suggestions("velaseti", columns).empty());  // three
}

TEST_CASE("another case counts as one slip, however many letters differ", "[suggest]") {
    CHECK(suggestions("THETA", columns) == Names{"theta"});
    CHECK(suggestions("m", columns) == Names{"M"});
    CHECK(suggestions("T", columns) == Names{"t"});
    CHECK(suggestions("RD", of_system) == Names{"Rd"});
    CHECK(suggestions("THEAT", columns) == Names{"theta"});
}

TEST_CASE("the beginning of a longer name is recognised", "[suggest]") {
    CHECK(suggestions("freq", options) == Names{"frequency"});
    CHECK(suggestions("amp", options) == Names{"amplitude"});
    CHECK(suggestions("Vel", columns) == Names{"velocity"});
    CHECK(suggestions("ve", columns).empty());
}

TEST_CASE("two equally good matches are both named, three are too many", "[suggest]") {
    CHECK(suggestions("R", of_system) == Names{"Rd", "Re"});
    CHECK(suggestions("Rs", of_system) == Names{"Rd", "Re"});
    constexpr std::array<std::string_view, 3> three = {"M1", "M2", "M3"};
    CHECK(suggestions("M", three).empty());
}

TEST_CASE("only the best matches count", "[suggest]") {
    constexpr std::array<std::string_view, 3> near = {"theta12", "theta0", "theta1"};
    CHECK(suggestions("theta", near) == Names{"theta0", "theta1"});
}

TEST_CASE("nothing is suggested for a word that is like none", "[suggest]") {
    CHECK(suggestions("q", columns).empty());
    CHECK(suggestions("", columns).empty());
    CHECK(suggestions("colour", columns).empty());
    CHECK(suggestions("theta", {}).empty());
    CHECK(suggestions(std::string(5000, 'a'), columns).empty());
}

TEST_CASE("other words for the same thing are known, and count more than a likeness of letters", "[suggest]") {
    constexpr std::array<std::string_view, 4> terms = {"harmonic", "pulse", "samples", "chirp"};
    CHECK(suggestions("sin", terms) == Names{"harmonic"});
    CHECK(suggestions("Cosine", terms) == Names{"harmonic"});
    CHECK(suggestions("impulse", terms) == Names{"pulse"});
    constexpr std::array<std::string_view, 4> fields = {"T0", "omega0", "I", "M"};
    CHECK(suggestions("w0", fields) == Names{"omega0"});
    CHECK(suggestions("mass", fields) == Names{"I"});
    CHECK(suggestions("m", fields) == Names{"M"});  // a letter of another case comes first
    constexpr std::array<std::string_view, 2> of_math = {"sin", "sinh"};
    CHECK(suggestions("sine", of_math) == Names{"sin", "sinh"});  // only what is there
    CHECK(suggestions("x", columns) == Names{"theta"});
    CHECK(suggestions("x", columns, dinal::text::Likeness::of_letters)
              .empty());  // a variable of the user may be anything
}

TEST_CASE("short words must be very much alike", "[suggest]") {
    constexpr std::array<std::string_view, 4> globals = {"os", "rawget", "T0", "dofile"};
    CHECK(suggestions("ls", globals).empty());
    CHECK(suggestions("x0", globals).empty());
    CHECK(suggestions("range", globals).empty());
    CHECK(suggestions("tetha", columns) == Names{"theta"});  // the same letters
}

TEST_CASE("a word is no suggestion for itself and a name known twice is named once", "[suggest]") {
    constexpr std::array<std::string_view, 3> twice = {"theta", "theta", "M"};
    CHECK(suggestions("theta", columns).empty());
    CHECK(suggestions("teta", twice) == Names{"theta"});
}

TEST_CASE("the suggestion ends an error sentence", "[suggest]") {
    CHECK(did_you_mean("teta", columns) == "; did you mean 'theta'?");
    CHECK(did_you_mean("R", of_system) == "; did you mean 'Rd' or 'Re'?");
    CHECK(did_you_mean("colour", columns).empty());
}

}  // namespace dinal::suggest_test
