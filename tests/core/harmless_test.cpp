// A stranger's text cannot control the terminal that shows it.
#include "text/characters.hpp"

#include "support/catch.hpp"

namespace dinal::harmless_test {

using dinal::text::harmless;

TEST_CASE("lines, tabs, letters and colours are kept", "[text]") {
    for (const char* text : {"a\nb\tc\n", "θ ≤ 1", "\x1b[31m^^^\x1b[0m", "\x1b[1;4m(\x1b[m", "\x1b[90mgrey"}) {
        CHECK(harmless(text) == text);
    }
}

TEST_CASE("sequences that move the cursor, rename the window, hide text or blink are removed", "[text]") {
    CHECK(harmless("\x1b]0;title\x07") == "?]0;title?");
    CHECK(harmless("\x1b[2J\x1b[H") == "?[2J?[H");
    CHECK(harmless("\x1b[8mhidden") == "?[8mhidden");
    CHECK(harmless("\x1b[5m\x1b[1;8m") == "?[5m?[1;8m");
    CHECK(harmless("over\rwritten\b") == "over written?");
    CHECK(harmless("\xC2\x9B"
                   "2J") == "?2J");
    CHECK(harmless("\x9B"
                   "2J") ==
          "\xEF\xBF\xBD"
          "2J");
    CHECK(harmless("\xF0\x9F\x99\x82 \xE2\x88\x9E") == "\xF0\x9F\x99\x82 \xE2\x88\x9E");  // four bytes and three
    CHECK(harmless("\x1b[38;5;1m") == "?[38;5;1m");
    CHECK(harmless("\x1b[31") == "?[31");
}

}  // namespace dinal::harmless_test
