// Tables that go on without being copied.
#include "motion/growing.hpp"

#include <limits>
#include <numeric>
#include <vector>

#include "support/catch.hpp"

namespace dinal::growing_test {

using dinal::motion::Growing;

namespace {

constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

template <class T>
std::vector<T> list(const Growing<T>& table) {
    return {table.begin(), table.end()};
}

Growing<int> numbers(int from, int until) {
    std::vector<int> values(static_cast<std::size_t>(until - from));
    std::iota(values.begin(), values.end(), from);
    return Growing<int>(values);
}

/// Columns of n, 10 n and 100 n.
Growing<int> three_columns(int from, int until) {
    const auto rows = static_cast<std::size_t>(until - from);
    Growing<int> table(rows, 3);
    int* values = table.writable();
    for (const int factor : {1, 10, 100}) {
        for (int n = from; n < until; ++n) *values++ = factor * n;
    }
    return table;
}

}  // namespace

TEST_CASE("a table can be followed in the place of its last row, whoever has seen that", "[growing]") {
    for (const bool seen : {false, true}) {
        Growing<int> table = numbers(0, 3);
        std::vector<Growing<int>> all;
        for (int end = 3; end < 40; ++end) {
            // Each ends with a row of -1 that the next one does not have.
            table = table.followed_by(end == 3 ? 3 : table.size() - 1, Growing<int>(std::vector{end, -1}), no_limit);
            if (seen) CHECK(table.column(0).back() == -1);
            all.push_back(table);
        }
        for (const Growing<int>& one : all) {
            REQUIRE(one.back() == -1);
            for (std::size_t i = 0; i + 1 < one.size(); ++i) REQUIRE(one[i] == static_cast<int>(i));
        }
    }
}

TEST_CASE("two tables that follow the same one do not write into each other", "[growing]") {
    const Growing<int> first = numbers(0, 5).followed_by(5, numbers(5, 7), no_limit);
    const Growing<int> one = first.followed_by(7, Growing<int>(std::vector{70, 71}), no_limit);
    const Growing<int> other = first.followed_by(7, Growing<int>(std::vector{80, 81, 82}), no_limit);
    const Growing<int> shorter = first.followed_by(6, Growing<int>(std::vector{90}), no_limit);
    CHECK(list(one) == std::vector{0, 1, 2, 3, 4, 5, 6, 70, 71});
    CHECK(list(other) == std::vector{0, 1, 2, 3, 4, 5, 6, 80, 81, 82});
    CHECK(list(shorter) == std::vector{0, 1, 2, 3, 4, 5, 90});
    CHECK(list(first) == std::vector{0, 1, 2, 3, 4, 5, 6});
}

TEST_CASE("columns stay contiguous while a table grows", "[growing]") {
    Growing<int> table = three_columns(0, 4);
    for (int end = 4; end < 100; end += 3)
        table = table.followed_by(table.size(), three_columns(end, end + 3), no_limit);
    REQUIRE(table.columns() == 3);
    for (const std::size_t column : {0U, 1U, 2U}) {
        const auto values = table.column(column);
        for (std::size_t i = 0; i < values.size(); ++i) REQUIRE(values[i] == table(i, column));
        REQUIRE(values[50] == (column == 0 ? 50 : column == 1 ? 500 : 5000));
    }
    CHECK(table.column(1).data() == table.column(0).data() + table.stride());
}

}  // namespace dinal::growing_test
