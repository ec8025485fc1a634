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

/// A number that counts how often such numbers are copied.
struct Counted {
    int value = 0;
    static inline std::size_t copies = 0;

    Counted() = default;
    Counted(int number) : value(number) {}  // NOLINT(google-explicit-constructor)
    Counted(const Counted& other) : value(other.value) { ++copies; }
    Counted& operator=(const Counted& other) {
        value = other.value;
        ++copies;
        return *this;
    }
    ~Counted() = default;
};

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

TEST_CASE("a table that follows another one has the rows of both, and that one keeps its own", "[growing]") {
    const Growing<int> first = numbers(0, 5);
    const Growing<int> second = first.followed_by(5, numbers(5, 8), no_limit);
    const Growing<int> third = second.followed_by(8, numbers(8, 20), no_limit);
    CHECK(list(third) == list(numbers(0, 20)));
    CHECK(list(second) == list(numbers(0, 8)));
    CHECK(list(first) == list(numbers(0, 5)));
    CHECK(third.front() == 0);
    CHECK(third.back() == 19);
    CHECK(third.size() == 20);
}

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

TEST_CASE("nothing follows nothing, and nothing follows something", "[growing]") {
    const Growing<int> none;
    CHECK(list(none).empty());
    CHECK(list(none.followed_by(0, Growing<int>(), no_limit)).empty());
    CHECK(list(none.followed_by(0, numbers(0, 2), no_limit)) == std::vector{0, 1});
    CHECK(list(numbers(0, 2).followed_by(2, none, no_limit)) == std::vector{0, 1});
    CHECK(list(numbers(0, 3).followed_by(1, none, no_limit)) == std::vector{0});
}

TEST_CASE("n tables that follow each other copy as much as a few of the last, not n squared", "[growing]") {
    constexpr std::size_t n = 3000;
    for (const bool end_replaced : {false, true}) {
        Growing<Counted> table(std::vector<Counted>(10));
        Counted::copies = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const Growing<Counted> later(std::vector<Counted>(2));
            table = table.followed_by(table.size() - (end_replaced && i > 0 ? 1 : 0), later, no_limit);
        }
        // Each row is copied when its list is made, when it is appended and when the room doubles: 1 + 1/2 + 1/4 ...
        CHECK(Counted::copies <= 6 * 2 * n);
    }
}

TEST_CASE("room to grow is not taken beyond what is allowed", "[growing]") {
    const Growing<int> first = numbers(0, 1000);
    CHECK(first.followed_by(1000, numbers(1000, 1100), no_limit).own_bytes() == 2100 * sizeof(int));
    CHECK(first.followed_by(1000, numbers(1000, 1100), 1200).own_bytes() == 1200 * sizeof(int));
    CHECK(first.followed_by(1000, numbers(1000, 1100), 500).own_bytes() == 1100 * sizeof(int));  // what must be must be
}

}  // namespace dinal::growing_test
