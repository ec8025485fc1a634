#include "files/record1989.hpp"

#include <cmath>
#include <limits>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace dinal::record1989_test {

using Catch::Matchers::Contains;
using namespace dinal::files;
using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::testing;

namespace {

Table parsed(std::string_view text) {
    const auto table = parse_record1989(text, "x.dat");
    INFO((table ? "" : table.error().sentence));
    REQUIRE(table);
    return *table;
}

std::string fault(std::string_view text) {
    const auto table = parse_record1989(text, "x.dat");
    return table ? "no error" : table.error().sentence;
}

/// I = 1, k = 4: omega0 = 2, all quotients exact.
Oscillator system_with_stiffness_4() {
    return std::move(Oscillator::make({.inertia = 1, .stiffness = 4, .damping = 0.5, .kinetic_friction = 1})).value();
}

Run small_run() {
    Run run;
    run.own_names = {"t", "theta", "velocity", "M", "friction", "damping"};
    Eigen::MatrixXd rows(2, 6);
    rows << 0, 1, 0, 2, -0.0, 0,  //
        0.1, 0.75, -3, 1, 1, 1.5;
    run.rows = Rows(rows);
    return run;
}

}  // namespace

TEST_CASE("a run is recorded as the number of rows, then time and five angles for each", "[record1989]") {
    const TemporaryFolder folder;
    REQUIRE(write_record1989(folder.file("x.dat"), small_run(), system_with_stiffness_4()));
    CHECK(text_of(folder.file("x.dat")) == "2\n0 1 0 0.5 -0 0\n0.1 0.75 -1.5 0.25 0.25 0.375\n");
}

TEST_CASE("columns are taken by name, whatever their order", "[record1989]") {
    const TemporaryFolder folder;
    Run run = small_run();
    std::swap(run.own_names[0], run.own_names[5]);
    Eigen::MatrixXd rows = run.rows.matrix();
    rows.col(0).swap(rows.col(5));
    run.rows = Rows(rows);
    REQUIRE(write_record1989(folder.file("x.dat"), run, system_with_stiffness_4()));
    CHECK(text_of(folder.file("x.dat")) == "2\n0 1 0 0.5 -0 0\n0.1 0.75 -1.5 0.25 0.25 0.375\n");
    run.own_names[3] = "load";
    const auto written = write_record1989(folder.file("y.dat"), run, system_with_stiffness_4());
    REQUIRE_FALSE(written);
    CHECK_THAT(written.error().sentence, Contains("needs six columns") && Contains("there is no column 'M'"));
    CHECK(folder.count() == 1);
}

TEST_CASE("a record reads back bit by bit and is saved again as it was", "[record1989]") {
    using limits = std::numeric_limits<double>;
    const TemporaryFolder folder;
    Eigen::MatrixXd values(3, 6);
    values << 0.0, -0.0, limits::denorm_min(), limits::max(), limits::lowest(), 0.1,  //
        1.0 / 3, -0.0, 0.0, limits::min(), 1e23, 5e-324,                              //
        1.0 / 3, 0.0, 0.0, -limits::min(), 1e22, 2.2250738585072011e-308;
    REQUIRE(write_record1989(folder.file("a.dat"), values));
    const auto back = read_record1989(folder.file("a.dat"));
    REQUIRE(back);
    CHECK(back->names == record1989_names());
    REQUIRE(back->values.rows() == 3);
    CHECK(back->values == values);
    CHECK(back->values.array().isFinite().all());
    CHECK(std::signbit(back->values(0, 1)));
    CHECK_FALSE(std::signbit(back->values(2, 1)));
    REQUIRE(write_record1989(folder.file("b.dat"), back->values));
    CHECK(text_of(folder.file("b.dat")) == text_of(folder.file("a.dat")));
}

TEST_CASE("a record without rows has NPUNT = 0", "[record1989]") {
    const TemporaryFolder folder;
    REQUIRE(write_record1989(folder.file("x.dat"), Eigen::MatrixXd(0, 6)));
    CHECK(text_of(folder.file("x.dat")) == "0\n");
    CHECK(read_record1989(folder.file("x.dat"))->values.rows() == 0);
}

TEST_CASE("numbers are read in all forms that Fortran writes", "[record1989]") {
    const Table table = parsed(
        "           2\n"
        "  0.000000000E+00   1.5D+00  -1.5d-1  +.25  5.  1Q2\n"
        "   1.0-300  2.0+300, 0.5D0 -1.D-3, 7 , 1.e0\n");
    CHECK(table.values.row(0) == Eigen::RowVectorXd{{0, 1.5, -0.15, 0.25, 5, 100}});
    CHECK(table.values.row(1) == Eigen::RowVectorXd{{1e-300, 2e300, 0.5, -1e-3, 7, 1}});
}

TEST_CASE("a row may continue in the next lines and use repeat counts", "[record1989]") {
    const Table table = parsed("2\n 1 2 3\n 4\n\n 5 6\n 2*0.5 3*-1D0\n 9\n");
    CHECK(table.values.row(0) == Eigen::RowVectorXd{{1, 2, 3, 4, 5, 6}});
    CHECK(table.values.row(1) == Eigen::RowVectorXd{{.5, .5, -1, -1, -1, 9}});
    CHECK(parsed("\xEF\xBB\xBF\r\n1\r\n1,2,3,4,5,\r\n6\r\n\r\n").values(0, 5) == 6);
}

TEST_CASE("NPUNT must be the number of rows", "[record1989]") {
    CHECK(fault("3\n1 2 3 4 5 6\n1 2 3 4 5 6\n") ==
          "x.dat: NPUNT in the first line is 3, but there are 2 rows; correct NPUNT if none is missing");
    CHECK_THAT(fault("1\n1 2 3 4 5 6\n1 2 3 4 5 6\n"), Contains("is 1, but there are 2 rows"));
    CHECK_THAT(fault("18446744073709551615\n"), Contains("but there are 0 rows"));
    CHECK_THAT(fault("1 2 3 4 5 6\n"), Contains("x.dat:1: NPUNT") && Contains("'1 2 3 4 5 6'") && Contains(".csv"));
    for (const std::string first : {"-1", "2.0", "abc", "99999999999999999999", "t,theta"}) {
        CHECK_THAT(fault("\n" + first + "\n"), Contains("x.dat:2: NPUNT") && Contains("'" + first + "'"));
    }
    for (const std::string_view empty : {"", "\n \n", "\xEF\xBB\xBF"}) {
        CHECK_THAT(fault(empty), Contains("x.dat: the file is empty"));
    }
}

TEST_CASE("a row without six numbers is refused with its line", "[record1989]") {
    CHECK(fault("1\n1 2 3 4 5\n") == "x.dat:2: the last row has 5 of its six numbers");
    CHECK(fault("1\n1 2 3 4 5 6 7\n") == "x.dat:2: there are more than six numbers in this row");
    CHECK(fault("2\n1 2 3 4 5\n1 2 3 4 5 6\n") ==
          "x.dat:3: there are more than six numbers in this row, which begins in line 2");
    CHECK_THAT(fault("1\n7*0\n"), Contains("more than six"));
    CHECK_THAT(fault("1\n18446744073709551615*0\n"), Contains("more than six"));
}

TEST_CASE("a record with a value that is not a finite number is refused with its line and column", "[record1989]") {
    CHECK(fault("1\n0 abc 0 0 0 0\n") == "x.dat:2: theta is 'abc', not a number");
    CHECK(fault("1\n0 0 0\n*** 0 0\n") == "x.dat:3: M_over_k is '***', not a number");
    CHECK_THAT(fault("1\n0 NaN 0 0 0 0\n"), Contains("x.dat:2: theta is 'NaN', but only finite numbers"));
    CHECK_THAT(fault("1\n0 0 0 0 0 Infinity\n"), Contains("damping_over_k is 'Infinity'"));
    CHECK_THAT(fault("1\n0 0 0 0 0 1D+999\n"), Contains("'1D+999'"));
    CHECK_THAT(fault("1\n0,,0,0,0,0\n"), Contains("theta is empty"));
    for (const std::string text : {"1D", "1DD2", "1+2+3", "D5", "0*1", "*", "2*", "1e5D3", "--1"}) {
        CHECK_THAT(fault("1\n" + text + " 0 0 0 0 0\n"), Contains("x.dat:2: t "));
    }
}

TEST_CASE("a file that is not text is refused with the line of its NUL byte", "[record1989]") {
    using namespace std::string_view_literals;
    CHECK_THAT(fault("1\n0 0 0 0 0 0\0\n"sv), Contains("x.dat:2: there is a NUL byte"));
}

TEST_CASE("a record that cannot be written leaves the old file", "[record1989]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("x.dat");
    put_text(path, "old");
    CHECK_THAT(write_record1989(path, Eigen::MatrixXd::Ones(1, 5)).error().sentence,
               Contains("has six columns, here are 5"));
    Eigen::MatrixXd bad = Eigen::MatrixXd::Ones(2, 6);
    bad(1, 3) = HUGE_VAL;
    CHECK_THAT(write_record1989(path, bad).error().sentence, Contains("row 2 of column 'M_over_k' is infinite"));
    CHECK(text_of(path) == "old");
    CHECK(folder.count() == 1);
}

}  // namespace dinal::record1989_test
