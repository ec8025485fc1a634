// A continued run against the same run without a stop.
#include <cmath>
#include <numbers>

#include "support/catch.hpp"
#include "support/systems.hpp"

namespace dinal::resume_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

/// A motion that turns at resonance, with both frictions.
const Oscillator turning = nondimensional(0.119, 0.418);
const State drawn_out{1, 0};
Excitation resonant() {
    return harmonic(1, 2 * std::numbers::pi);
}

void check_like_whole(const Run& parts, const Run& whole, double tolerance) {
    REQUIRE(parts.size() == whole.size());
    for (Eigen::Index i = 0; i < whole.size(); ++i) {
        REQUIRE(parts.rows(i, 0) == whole.rows(i, 0));
        REQUIRE(std::fabs(parts.rows(i, 1) - whole.rows(i, 1)) <= tolerance);
    }
    REQUIRE(parts.events.size() == whole.events.size());
    for (std::size_t i = 0; i < whole.events.size(); ++i) {
        CHECK(parts.events[i].kind == whole.events[i].kind);
        CHECK(std::fabs(parts.events[i].theta - whole.events[i].theta) <= tolerance);
    }
    CHECK(parts.outcome == whole.outcome);
    CHECK(parts.t_start == whole.t_start);
    CHECK(parts.t_stop == whole.t_stop);
    for (const double part : {0.01, 0.2, 0.49, 0.51, 0.97}) {
        const double t = whole.t_start + part * (whole.t_stop - whole.t_start);
        CHECK(std::fabs(parts.at(t)->theta - whole.at(t)->theta) <= tolerance);
    }
}

}  // namespace

TEST_CASE("a run that is stopped among many rows between two events continues as if it had not been", "[resume]") {
    const Oscillator system = nondimensional(0.01, 0);
    const Grid rows = Grid::every(1e-5);
    const auto first = simulate(system, {{}, {1, 0}}, {0, 2.5}, rows, Exact{}, [](double t) { return t < 0.9; });
    REQUIRE(first);
    CHECK(first->outcome == Outcome::interrupted);
    // Some 65536 rows lie between two questions.
    CHECK((first->t_stop >= 0.9 && first->t_stop < 1.7));
    CHECK(first->rows(first->size() - 1, 0) == first->t_stop);
    const auto both = resume(system, {}, *first, 2.5, rows, Exact{});
    REQUIRE(both);
    const Run whole = must_run(system, {}, {1, 0}, {0, 2.5}, rows, Exact{});
    REQUIRE(both->size() == whole.size());
    for (Eigen::Index i = 0; i < whole.size(); i += 97) {
        REQUIRE(both->rows(i, 0) == whole.rows(i, 0));
        REQUIRE(std::fabs(both->rows(i, 1) - whole.rows(i, 1)) <= 1e-13);
    }
    CHECK(both->events.size() == whole.events.size());
}

TEST_CASE("a run can be continued from any time, also from the very moment of a slip", "[long][resume]") {
    const Oscillator system = nondimensional(0.01, 0.3);
    const Excitation M = Excitation::make(Harmonic{.amplitude = 1, .omega = 1}).value();
    const Run whole = must_run(system, M, {0, 0}, {0, 400}, Grid::every(1), Spectral{});
    for (const Integrator& integrator : std::vector<Integrator>{Exact{}, Spectral{}, Rk4{0.01}}) {
        int slips = 0;
        for (double stop = 20; stop < 400; stop += 3.1) {
            auto first = simulate(system, {M, {0, 0}}, {0, 400}, Grid::every(1), integrator,
                                  [stop](double t) { return t < stop; });
            REQUIRE(first);
            if (first->outcome != Outcome::interrupted) continue;
            slips += first->events.back().kind == EventKind::slip && first->events.back().t == first->t_stop ? 1 : 0;
            auto both = resume(system, M, *first, 400, Grid::every(1), integrator);
            REQUIRE(both);
            CAPTURE(stop, first->t_stop);
            CHECK(both->events.size() == whole.events.size());
        }
        CHECK((slips > 0 || !std::holds_alternative<Spectral>(integrator)));  // such stops are among them
    }
}

TEST_CASE("a run with very many rows at rest stops on request, and can be continued", "[resume]") {
    const Oscillator system = nondimensional(0, 0.5);
    const Excitation load = harmonic(0.3, 1);  // cannot move it
    const auto part =
        simulate(system, {load, {0.1, 0}}, {0, 2500}, Grid::every(0.01), Spectral{}, [](double t) { return t < 1000; });
    REQUIRE(part);
    CHECK(part->outcome == Outcome::interrupted);
    CHECK(part->t_stop >= 1000);
    CHECK(part->t_stop < 2000);
    CHECK(part->rows(part->size() - 1, 0) == part->t_stop);
    const auto all = resume(system, load, *part, 2500, Grid::every(0.01), Spectral{});
    const Run whole = must_run(system, load, {0.1, 0}, {0, 2500}, Grid::every(0.01), Spectral{});
    REQUIRE(all);
    CHECK(all->outcome == whole.outcome);
    CHECK(all->rows == whole.rows);
}

TEST_CASE("a run continued from the time of a row to rounding has that row once", "[resume]") {
    const Excitation M = resonant();
    const Grid rows = Grid::every(0.03);
    const double middle = 0.1 * 3;
    REQUIRE(middle != 10 * 0.03);
    const auto part = simulate(turning, {M, drawn_out}, {0, middle}, rows, Spectral{});
    REQUIRE(part);
    const auto all = resume(turning, M, *part, 0.6, rows, Spectral{});
    REQUIRE(all);
    const Run whole = must_run(turning, M, drawn_out, {0, 0.6}, rows, Spectral{});
    REQUIRE(all->size() == whole.size());
    for (Eigen::Index i = 0; i < whole.size(); ++i) {
        CHECK(std::fabs(all->rows(i, 0) - whole.rows(i, 0)) <= 6e-17);  // one unit of the last place of 0.3
    }
}

TEST_CASE("n continuations of a run share its memory, and leave the earlier runs unchanged", "[resume]") {
    const Excitation M = resonant();
    const Grid rows = Grid::every(0.03);  // no part ends on a row of all
    constexpr int parts = 200;
    const auto end_of = [](int part) { return 0.1 * (part + 1) + 0.005; };
    std::vector<Run> runs;
    std::size_t bytes = 0, event_bytes = 0;
    for (int i = 0; i < parts; ++i) {
        auto run = i == 0 ? simulate(turning, {M, drawn_out}, {0, end_of(0)}, rows, Spectral{})
                          : resume(turning, M, runs.back(), end_of(i), rows, Spectral{});
        REQUIRE(run);
        runs.push_back(std::move(run).value());
        bytes += runs.back().rows.table().own_bytes();
        event_bytes += runs.back().events.own_bytes();
    }
    // Room doubles: all that was ever taken is less than 1 + 1/2 + 1/4 ... of the last, which may be twice too large.
    const Run& last = runs.back();
    CHECK(bytes <= 4 * static_cast<std::size_t>(last.size()) * column_count * sizeof(double));
    CHECK(event_bytes <= 4 * last.events.size() * sizeof(Event));

    for (const int i : {0, 1, 57, 199}) {
        const auto run = static_cast<std::size_t>(i);
        CAPTURE(i);
        REQUIRE(runs[run].t_stop == end_of(i));
        const Run whole = must_run(turning, M, drawn_out, {0, end_of(i)}, rows, Spectral{});
        check_like_whole(runs[run], whole, 2e-12);
    }
}

}  // namespace dinal::resume_test
