#include "files/csv.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <tuple>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace dinal::csv_test {

using Catch::Matchers::Contains;
using Catch::Matchers::Equals;
using namespace dinal::files;
using namespace dinal::testing;
using Strings = std::vector<std::string>;

namespace {

text::Expected<Table> table_in(text::Expected<ReadColumns> read) {
    return read ? table_of(*read) : text::Expected<Table>(read.error());
}

text::Expected<Table> read_csv(const std::string& path) {
    return table_in(read_columns(path));
}

text::Expected<Written> write_table(const std::string& path, const Table& table) {
    return write_csv(path, named_columns(table.names, table.values), table.comments);
}

Table parsed(std::string_view text) {
    const auto table = table_in(parse_columns(text, "x.csv"));
    INFO((table ? "" : table.error().sentence));
    REQUIRE(table);
    return *table;
}

std::string fault(std::string_view text) {
    const auto table = table_in(parse_columns(text, "x.csv"));
    return table ? "no error" : table.error().sentence;
}

/// What the same two rows must give, however they are written.
void check_is_the_pair(const Table& table) {
    REQUIRE(table.names == Strings{"t", "theta"});
    REQUIRE(table.values.rows() == 2);
    CHECK(table.values(0, 0) == 0.0);
    CHECK(table.values(0, 1) == 1.5);
    CHECK(table.values(1, 0) == 0.25);
    CHECK(table.values(1, 1) == -2e-3);
}

std::uint64_t bits(double value) {
    return std::bit_cast<std::uint64_t>(value);
}

/// Every value must come back with the same bits, from every column (the separator and the line end follow it).
void check_reads_back(const std::vector<double>& values) {
    const TemporaryFolder folder;
    Table table;
    table.names = {"a", "b"};
    table.values.resize(static_cast<Eigen::Index>(values.size()), 2);
    for (std::size_t i = 0; i < values.size(); ++i) {
        table.values.row(static_cast<Eigen::Index>(i)) << values[i], values[values.size() - 1 - i];
    }
    REQUIRE(write_table(folder.file("x.csv"), table));
    const auto back = read_csv(folder.file("x.csv"));
    REQUIRE(back);
    REQUIRE(back->values.rows() == table.values.rows());
    Eigen::Index wrong = 0;
    for (Eigen::Index i = 0; i < table.values.size(); ++i) {
        wrong += bits(back->values.data()[i]) == bits(table.values.data()[i]) ? 0 : 1;
    }
    CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("numbers read back bit by bit: extremes, and random bit patterns", "[csv]") {
    using limits = std::numeric_limits<double>;
    std::mt19937_64 random(1989);
    std::vector<double> values = {0.0,
                                  -0.0,
                                  -0.0,
                                  5e-324,
                                  -5e-324,
                                  limits::min(),
                                  std::nextafter(limits::min(), 0.0),
                                  limits::max(),
                                  limits::lowest(),
                                  0.1,
                                  1e22,
                                  1e23,
                                  9007199254740993.0,
                                  1.0,
                                  1.0};
    while (values.size() < 50000) {
        const double value = std::bit_cast<double>(random());
        if (std::isfinite(value)) {
            values.insert(values.end(), 1 + random() % 3, value);  // repeats take another way through the writer
        }
    }
    check_reads_back(values);
}

TEST_CASE("a file consists of comments, names and the shortest numbers", "[csv]") {
    const TemporaryFolder folder;
    const std::vector<double> t = {0, 0.1, 0.2, 0.30000000000000004};
    const std::vector<double> friction = {-16.5, -16.5, -16.5, 0};
    const std::vector<NamedColumn> columns = {{"t", t}, {"friction", friction}};
    // A NUL in a comment would make a file that no reader takes.
    const Strings comments = {std::string("dinal\0000.1.0", 11), "M = function(t)\n  return 1\r\nend", ""};
    const auto written = write_csv(folder.file("x.csv"), columns, comments);
    REQUIRE(written);
    const std::string expected =
        "# dinal 0.1.0\n# M = function(t)\n#   return 1\n# end\n#\nt,friction\n"
        "0,-16.5\n0.1,-16.5\n0.2,-16.5\n0.30000000000000004,0\n";
    CHECK(text_of(folder.file("x.csv")) == expected);
    CHECK(written->bytes == expected.size());
    CHECK(read_csv(folder.file("x.csv"))->comments ==
          Strings{"dinal 0.1.0", "M = function(t)", "  return 1", "end", ""});
}

TEST_CASE("a table without rows keeps its names", "[csv]") {
    const TemporaryFolder folder;
    const Table empty{{"t", "theta"}, Eigen::MatrixXd(0, 2), {"nothing happened"}};
    REQUIRE(write_table(folder.file("x.csv"), empty));
    const auto back = read_csv(folder.file("x.csv"));
    REQUIRE(back);
    CHECK(back->names == empty.names);
    CHECK(back->values.rows() == 0);
    CHECK(back->values.cols() == 2);
}

TEST_CASE("names that could be mistaken for something else are quoted and read back", "[csv]") {
    const TemporaryFolder folder;
    const Strings names = {"1", "rest angle", "a,b", "say \"x\"", "#", "x;y", "-2.5e3", "theta"};
    const Table table{names, Eigen::MatrixXd::Ones(1, 8), {}};
    REQUIRE(write_table(folder.file("x.csv"), table));
    CHECK(read_csv(folder.file("x.csv"))->names == names);
    const Strings leading = {"#t", "x"};  // the line would be a comment
    REQUIRE(write_table(folder.file("w.csv"), Table{leading, Eigen::MatrixXd::Ones(1, 2), {}}));
    CHECK(read_csv(folder.file("w.csv"))->names == leading);
    const Table no_rows{names, Eigen::MatrixXd(0, 8), {}};
    REQUIRE(write_table(folder.file("y.csv"), no_rows));
    CHECK(read_csv(folder.file("y.csv"))->names == names);
    // At the head of the line each of them could be a comment, a number, or two columns.
    for (const char* name :
         {"#", "#1", "# x", "a b", "a\tb", "a,b", "a;b", "\"", "say \"x\"", "1", "+1", ".5", "1e5"}) {
        for (const Strings& head : {Strings{name}, Strings{name, "theta"}}) {
            const Table alone{head, Eigen::MatrixXd::Ones(1, static_cast<Eigen::Index>(head.size())), {}};
            REQUIRE(write_table(folder.file("x.csv"), alone));
            const auto back = read_csv(folder.file("x.csv"));
            CAPTURE(name);
            REQUIRE(back);
            CHECK(back->names == head);
            CHECK(back->comments.empty());
        }
    }
}

TEST_CASE("a file can have very many columns", "[csv]") {
    const TemporaryFolder folder;
    Table wide;
    wide.values = Eigen::MatrixXd::Random(2, 20000);
    for (int i = 0; i < 20000; ++i) {
        wide.names.push_back("c" + std::to_string(i));
    }
    REQUIRE(write_table(folder.file("x.csv"), wide));
    CHECK(read_csv(folder.file("x.csv"))->values == wide.values);
}

TEST_CASE("the separator is found in the second line", "[csv]") {
    check_is_the_pair(parsed("t,theta\n0,1.5\n0.25,-2e-3\n"));
    check_is_the_pair(parsed("t;theta\n0;1.5\n0.25;-2e-3\n"));
    check_is_the_pair(parsed("t\ttheta\n0\t1.5\n0.25\t-2e-3\n"));
    check_is_the_pair(parsed("  t   theta\n  0   1.5  \n  0.25\t \t-2e-3\n"));
    check_is_the_pair(parsed("t , theta\n 0 ,\t1.5 \n0.25,-2e-3"));
    check_is_the_pair(parsed("\"t\", \"theta\"\n0,1.5\n0.25,-2e-3\n"));
    CHECK(parsed("rest angle;t\n1;2\n").names == Strings{"rest angle", "t"});
    CHECK(parsed("\"a, b\" c\n1 2\n").names == Strings{"a, b", "c"});
}

TEST_CASE("a file with tabs may have decimal commas, and Excel's line sep=; is not a line of names", "[csv]") {
    const auto second = [](const char* text) { return parse_columns(text, "x").value().columns.at(1); };
    CHECK(second("t\tx\n0,0\t0,5\n0,1\t0,25\n").numbers == std::vector<double>{0.5, 0.25});
    CHECK(second("t\tx\n0,0\t0,5\n0,1\t0,25\n").name == "x");
    CHECK(second("t\tx\n0\t1.5\n1\t2\n").numbers == std::vector<double>{1.5, 2});
    CHECK(second("t,x\n0,\t5\n1,\t6\n").numbers == std::vector<double>{5, 6});  // a comma, and a tab as a blank
    CHECK(second("t\tx\n0\t1\n1\t2,5\n").numbers == std::vector<double>{1, 2.5});
    CHECK(second("sep=;\nt;x\n0;1,5\n").numbers == std::vector<double>{1.5});
    CHECK(second("sep=;\nt;x\n0;1,5\n").name == "x");
    CHECK(second("sep=,\nt,x\n0,1\n").numbers == std::vector<double>{1});
    CHECK(parse_columns("sep=;\n", "x").error().sentence.find("empty") != std::string::npos);
}

TEST_CASE("all line ends, a byte order mark and blank lines are understood", "[csv]") {
    check_is_the_pair(parsed("t,theta\r\n0,1.5\r\n0.25,-2e-3\r\n"));
    check_is_the_pair(parsed("t,theta\r0,1.5\r0.25,-2e-3\r"));
    check_is_the_pair(parsed("t,theta\n0,1.5\r\n0.25,-2e-3\r"));
    check_is_the_pair(parsed("t,theta\n0,1.5\n0.25,-2e-3"));  // no line end at the end
    check_is_the_pair(parsed("\xEF\xBB\xBFt,theta\n0,1.5\n0.25,-2e-3\n"));
    check_is_the_pair(parsed("\n \nt,theta\n\n0,1.5\n0.25,-2e-3\n\n\t\n\r\n"));
}

TEST_CASE("comments are kept in order, wherever they are", "[csv]") {
    const Table table = parsed("#one\n# two\n\n  # three\nt,theta\n#  four\n0,1.5\n0.25,-2e-3\n#\n");
    check_is_the_pair(table);
    CHECK(table.comments == Strings{"one", "two", "three", " four", ""});
}

TEST_CASE("without a line of names the columns are numbered", "[csv]") {
    const Table table = parsed("# t theta\n0 1.5\n1 2.5\n");
    CHECK(table.names == Strings{"1", "2"});
    CHECK(table.values(1, 1) == 2.5);
    CHECK(parsed("3\n4\n").values.rows() == 2);
    CHECK(parsed("t,,M\n1,2,3\n").names == Strings{"t", "2", "M"});
}

TEST_CASE("numbers may have a plus sign, no digits on one side of the point, or be too small to differ from zero",
          "[csv]") {
    const Table table = parsed("+1,.5,5.,+.5,1E3\n1e-400,-1e-400,4.9e-324,1e-5,-7\n");
    CHECK(table.values.row(0) == Eigen::RowVectorXd{{1, .5, 5, .5, 1000}});
    CHECK(table.values.row(1) == Eigen::RowVectorXd{{0, 0, 4.9e-324, 1e-5, -7}});
    CHECK(std::signbit(table.values(1, 1)));
}

TEST_CASE("a row that begins with plain numbers is read once and as a whole, or refused", "[csv]") {
    for (const char* text : {"a,b,c\n1,2,+3\n4, 5\t,6\n", "a;b;c\n1;2;+3\n4;5 ; 6\n", "a\tb\tc\n1\t2\t+3\n 4\t5 \t6\n",
                             "a b c\n1 2 +3\n 4\t5  6 \n", "a,b,c\n1,2,3\n4,5,6"}) {
        CAPTURE(text);
        const Table table = parsed(text);
        REQUIRE(table.values.rows() == 2);
        for (int i = 0; i < 6; ++i) CHECK(table.values(i / 3, i % 3) == i + 1);
    }
    const Table of_fortran = parsed("1.0D+00 2.5d-1\n -.3D1 4.\n");
    CHECK(of_fortran.values(0, 1) == 0.25);
    CHECK(of_fortran.values(1, 0) == -3);
    CHECK_THAT(fault("a,b\n1,2\n3,4x\n"), Contains("x.csv:3: column 2 (b) is '4x', not a number"));
    CHECK_THAT(fault("a,b\n1,2\n3,inf\n"), Contains("only finite numbers"));
    CHECK_THAT(fault("a,b\n1,2,3\n"), Contains("found 3 fields, expected 2"));
    CHECK_THAT(fault("a,b\n1,2\n3\n"), Contains("found 1 field, expected 2"));
    CHECK_THAT(fault("a,b\n1,2\n3 4,5\n"), Contains("column 1 (a)"));
}

TEST_CASE("a ragged row is refused with its line", "[csv]") {
    for (const auto& [text, line, found] : {std::tuple{"t,theta\n0,1\n0\n", 3, "1 field"},
                                            {"# c\n\nt,theta\r\n0,1\r\n1,2,3\r\n", 5, "3 fields"},
                                            {"t,theta\n0\n", 2, "1 field"},
                                            {"0 1\n0 1 2\n", 2, "3 fields"},
                                            {"t,theta\n0,1,\n", 2, "3 fields"},
                                            {"t\ttheta\n0\t1\n\t1\t2\n", 3, "3 fields"}}) {
        CHECK(fault(text) == "x.csv:" + std::to_string(line) + ": found " + found +
                                 ", expected 2 as in the first line; put # before lines that are no columns");
    }
}

TEST_CASE("a field that is not a finite number is refused with its line and column", "[csv]") {
    CHECK(fault("t,theta\n0,1\n1,abc\n") == "x.csv:3: column 2 (theta) is 'abc', not a number");
    CHECK(fault("0,1\n1,\n") == "x.csv:2: column 2 is empty");
    CHECK(fault("t,theta\nnan,1\n") == "x.csv:2: column 1 (t) is 'nan', but only finite numbers can be used");
    for (const std::string text : {"inf", "-inf", "+inf", "Infinity", "NaN", "-nan"}) {
        CHECK_THAT(fault("t\n0\n" + text + "\n"), Contains("'" + text + "'") && Contains("x.csv:3: "));
    }
    CHECK_THAT(fault("t\n0\n-1e999\n"), Contains("'-1e999', too large for a number in double precision"));
    CHECK(parsed("t;u\n1;2,5\n").values(0, 1) == 2.5);
    CHECK_THAT(fault("t;u\n1;2\n3;4,5,6\n"), Contains("'4,5,6', not a number"));
    CHECK_THAT(fault("t\tu\n1\t2.5\n1\t2,5\n"), Contains("'2,5'") && Contains("decimal point instead of the comma"));
    for (const std::string text : {"1.5x", "0x10", "--1", "+-1", "1e", "1.2.3", "+", "-", ".", "\"1.5\"", "15D+00"}) {
        CHECK_THAT(fault("t\n0\n" + text + "\n"), Contains("'" + text + "', not a number"));
    }
    CHECK_THAT(fault("t\n0\n" + std::string(100000, 'x') + "\n"), Contains("xxx...'"));
    CHECK(fault("t\n0\n1\x01\n") == "x.csv:3: column 1 (t) is '1?', not a number");
}

TEST_CASE("a column name may be a number if it is quoted, or if a word precedes it", "[csv]") {
    CHECK(fault("0,abc\n1,2\n") == "x.csv:1: column 2 is 'abc', not a number");
    CHECK_THAT(fault("nan,0\n"), Contains("x.csv:1: column 1 is 'nan'"));
    CHECK(parsed("t,1,2\n0,0,0\n").names == Strings{"t", "1", "2"});
    CHECK(parsed("t,\"1\",\"2\"\n0,0,0\n").names == Strings{"t", "1", "2"});
    CHECK(fault("x,x\n1,2\n") == "x.csv:1: the name 'x' belongs to two columns");
}

TEST_CASE("a file without names or numbers is called empty", "[csv]") {
    for (const std::string_view text : {"", "\n\n", "# only\n# comments\n", "\xEF\xBB\xBF", "\r", " "}) {
        CHECK(fault(text) == "x.csv: the file is empty, it has neither names nor numbers");
    }
}

TEST_CASE("a binary file is refused with the line of its NUL byte", "[csv]") {
    using namespace std::string_view_literals;
    CHECK_THAT(fault("t\n1\n2\0\n"sv), Contains("x.csv:3: there is a NUL byte"));
    CHECK_THAT(fault("\xFF\xFEt\0,\0u\0\n\0"sv), Contains("x.csv:1: there is a NUL byte") && Contains("UTF-8"));
    CHECK_THAT(fault("# c\0\nt\n1\n"sv), Contains("x.csv:1: "));
}

TEST_CASE("a table that cannot be written leaves the old file", "[csv]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("x.csv");
    put_text(path, "old");
    const std::vector<double> two = {1, 2};
    const std::vector<double> three = {1, 2, 3};
    const std::vector<double> bad = {1, std::nan("")};
    const std::vector<double> infinite = {-HUGE_VAL, 0};
    CHECK(write_csv(path, std::vector<NamedColumn>{{"a", two}, {"b", bad}}).error().sentence ==
          "cannot write '" + path + "': row 2 of column 'b' is nan; only finite numbers can be saved");
    CHECK_THAT(write_csv(path, std::vector<NamedColumn>{{"a", infinite}}).error().sentence,
               Contains("row 1 of column 'a' is infinite"));
    CHECK_THAT(write_csv(path, std::vector<NamedColumn>{{"a", two}, {"b", three}}).error().sentence,
               Contains("column 'b' has 3 values, but 'a' has 2"));
    CHECK_THAT(write_csv(path, std::vector<NamedColumn>{}).error().sentence, Contains("no columns"));
    CHECK(text_of(path) == "old");
    CHECK(folder.count() == 1);
    if (std::filesystem::exists("/dev/full")) {
        CHECK_THAT(write_csv("/dev/full", std::vector<NamedColumn>{{"a", two}}).error().sentence,
                   Equals("cannot write '/dev/full': No space left on device"));
    }
}

TEST_CASE("a column is found by name or by number from 1", "[table]") {
    const Table table{{"t", "theta", "M"}, Eigen::MatrixXd(0, 3), {}};
    CHECK(*find_column(table.names, "M") == 2);
    CHECK(*find_column(table.names, 1) == 0);
    CHECK(*find_column(table.names, 3) == 2);
    CHECK(find_column(table.names, "tetha").error().message() ==
          "there is no column 'tetha' among t, theta, M; did you mean 'theta'?");
    CHECK(find_column(table.names, "velocity").error().sentence == "there is no column 'velocity' among t, theta, M");
    CHECK(find_column(table.names, 0).error().sentence ==
          "there is no column 0: they are numbered 1 to 3 (t, theta, M)");
    CHECK_FALSE(find_column(table.names, 4));
    CHECK_FALSE(find_column(table.names, std::numeric_limits<std::int64_t>::min()));
    CHECK_FALSE(find_column(table.names, ""));
}

}  // namespace dinal::csv_test
