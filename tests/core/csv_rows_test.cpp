// Rows of numbers in CSV files, plain ones and others.
#include <string>
#include <string_view>

#include "files/csv.hpp"
#include "support/catch.hpp"

namespace dinal::csv_rows_test {

using Catch::Matchers::Contains;
using namespace dinal::files;

namespace {

std::string fault(std::string_view text) {
    const auto table = parse_csv(text, "x.csv");
    return table ? "no error" : table.error().sentence;
}

}  // namespace

TEST_CASE("a row whose first numbers are plain is read once and as a whole, or refused", "[csv]") {
    for (const char* text : {"a,b,c\n1,2,+3\n4, 5\t,6\n", "a;b;c\n1;2;+3\n4;5 ; 6\n", "a\tb\tc\n1\t2\t+3\n 4\t5 \t6\n",
                             "a b c\n1 2 +3\n 4\t5  6 \n", "a,b,c\n1,2,3\n4,5,6"}) {
        CAPTURE(text);
        const auto table = parse_csv(text, "x.csv");
        REQUIRE(table);
        REQUIRE(table->values.rows() == 2);
        for (int i = 0; i < 6; ++i) CHECK(table->values(i / 3, i % 3) == i + 1);
    }
    const auto of_fortran = parse_csv("1.0D+00 2.5d-1\n -.3D1 4.\n", "x.csv");
    REQUIRE(of_fortran);
    CHECK(of_fortran->values(0, 1) == 0.25);
    CHECK(of_fortran->values(1, 0) == -3);
    CHECK_THAT(fault("a,b\n1,2\n3,4x\n"), Contains("x.csv:3: column 2 (b) is '4x', not a number"));
    CHECK_THAT(fault("a,b\n1,2\n3,inf\n"), Contains("only finite numbers"));
    CHECK_THAT(fault("a,b\n1,2,3\n"), Contains("found 3 fields, expected 2"));
    CHECK_THAT(fault("a,b\n1,2\n3\n"), Contains("found 1 field, expected 2"));
    CHECK_THAT(fault("a,b\n1,2\n3 4,5\n"), Contains("column 1 (a)"));
}

}  // namespace dinal::csv_rows_test
