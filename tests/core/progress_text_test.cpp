
#include <string>

#include "support/catch.hpp"
#include "terminal/progress.hpp"

namespace dinal::progress_text_test {

using namespace dinal::terminal;

namespace {

const ProgressFacts sweep{"sweep", 0.42, "42 of 100", "3.2/s", 18};

/// Of UTF-8 in which every character takes one column.
std::size_t width(const std::string& text) {
    std::size_t count = 0;
    for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0U) == 0x80U ? 0 : 1;
    return count;
}

}  // namespace

TEST_CASE("the progress line has label, fraction, count, rate and time left", "[progress]") {
    CHECK(progress_text(sweep, 79, Letters::ascii) ==
          "sweep  42% [############..................] 42 of 100, 3.2/s, 18 s left");
    CHECK(progress_text(sweep, 79, Letters::utf8) ==
          "sweep  42% ▕████████████▌                 ▏ 42 of 100, 3.2/s, 18 s left");
}

TEST_CASE("parts that do not fit are omitted, the least important first", "[progress]") {
    CHECK(progress_text(sweep, 60, Letters::ascii) == "sweep  42% [#######............] 42 of 100, 3.2/s, 18 s left");
    CHECK(progress_text(sweep, 50, Letters::ascii) == "sweep  42% [########............] 3.2/s, 18 s left");
    CHECK(progress_text(sweep, 36, Letters::ascii) == "sweep  42% [##....] 3.2/s, 18 s left");
    CHECK(progress_text(sweep, 30, Letters::ascii) == "sweep  42% [##.....] 18 s left");
    CHECK(progress_text(sweep, 22, Letters::ascii) == "sweep  42% 18 s left");
    CHECK(progress_text(sweep, 12, Letters::ascii) == "swe.  42%");
    CHECK(progress_text(sweep, 5, Letters::ascii) == " 42%");
    CHECK(progress_text(sweep, 3, Letters::ascii).empty());
}

TEST_CASE("the progress line is never wider than the window", "[progress]") {
    for (const double fraction : {-1.0, 0.0, 0.001, 0.5, 0.9999, 1.0}) {
        for (const char* label : {"", "a", "sweep over forty-two frequencies and then some more of them"}) {
            for (const Letters letters : {Letters::ascii, Letters::utf8}) {
                for (std::size_t columns = 0; columns < 200; ++columns) {
                    const ProgressFacts facts{label, fraction, "t = 123.4 of 1e+06", "1.23e+05/s", 1e5};
                    CAPTURE(fraction, label, columns);
                    CHECK(width(progress_text(facts, columns, letters)) <= columns);
                }
            }
        }
    }
}

TEST_CASE("a fraction is rounded down, and the bar with it", "[progress]") {
    ProgressFacts almost = sweep;
    almost.fraction = 0.99999;
    CHECK(progress_text(almost, 30, Letters::ascii) == "sweep  99% [######.] 18 s left");
    almost.fraction = 1;
    CHECK(progress_text(almost, 30, Letters::ascii) == "sweep 100% [#######] 18 s left");
}

TEST_CASE("without a known end the progress line has only the count and the rate", "[progress]") {
    const ProgressFacts endless{"", -1, "42", "3.2/s", 0};
    CHECK(progress_text(endless, 79, Letters::utf8) == "42, 3.2/s");
    CHECK(progress_text(endless, 6, Letters::utf8) == "3.2/s");
}

TEST_CASE("a label can neither steer the terminal nor break the line", "[progress]") {
    ProgressFacts odd = sweep;
    odd.label = "a\nb\x1b[2J\tc\xff";
    CHECK(progress_text(odd, 60, Letters::ascii).substr(0, 11) == "a b?[2J c? ");
    odd.label = "Δθ 角";  // the last one takes two columns
    CHECK(progress_text(odd, 26, Letters::utf8) == "Δθ 角  42% 18 s left");
    CHECK(progress_text(odd, 60, Letters::ascii).substr(0, 13) == "Deltatheta ? ");
}

TEST_CASE("durations are written as on a clock", "[progress]") {
    CHECK(duration_text(0) == "0 s");
    CHECK(duration_text(0.2) == "1 s");
    CHECK(duration_text(59.5) == "1:00");
    CHECK(duration_text(125) == "2:05");
    CHECK(duration_text(3725) == "1:02:05");
    CHECK(duration_text(1e6) == "12 days");
    CHECK(duration_text(1e300) == "1000000 days");
    CHECK(duration_text(std::numeric_limits<double>::quiet_NaN()) == "1000000 days");
}

}  // namespace dinal::progress_text_test
