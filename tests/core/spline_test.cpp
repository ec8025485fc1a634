// excitation.samples with a cubic spline: against the polynomials and derivatives that define it, the dense system of
// its equations, a sine, and motions under it by two integrators.
#include "model/terms/polyline.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "model/closed_form.hpp"
#include "model/excitation.hpp"
#include "support/catch.hpp"
#include "support/systems.hpp"
#include "support/within.hpp"

namespace dinal::spline_test {

using namespace dinal::model;

namespace {

constexpr double pi = std::numbers::pi;

Samples cubic(std::vector<double> t, std::vector<double> M, std::optional<double> period = {}) {
    return {.t = std::move(t), .M = std::move(M), .interpolation = Interpolation::cubic, .period = period};
}
Polyline through(Samples samples) {
    return std::make_shared<const Samples>(std::move(samples));
}
/// The derivatives 0 to 2 (and 3) of the powers of h that are in a cubic, at h.
Eigen::RowVector4d powers_of(double h, int derivative) {
    switch (derivative) {
        case 0:
            return {1, h, h * h, h * h * h};
        case 1:
            return {0, 1, 2 * h, 3 * h * h};
        case 2:
            return {0, 0, 2, 6 * h};
        default:
            return {0, 0, 0, 6};
    }
}
/// The coefficients of all pieces from one dense system: values at both ends of each, slopes and bends that go on at
/// the points between, and at the ends the third derivative that goes on (not a knot) or all that comes again.
Eigen::VectorXd dense_spline(const std::vector<double>& t, const std::vector<double>& M, bool periodic) {
    const auto pieces = static_cast<Eigen::Index>(t.size()) - 1;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4 * pieces, 4 * pieces);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(4 * pieces);
    Eigen::Index row = 0;
    const auto length = [&](Eigen::Index i) {
        return t[static_cast<std::size_t>(i) + 1] - t[static_cast<std::size_t>(i)];
    };
    const auto goes_on = [&](Eigen::Index from, Eigen::Index to, int derivative) {
        A.block<1, 4>(row, 4 * from) += powers_of(length(from), derivative);
        A.block<1, 4>(row++, 4 * to) -= powers_of(0, derivative);
    };
    for (Eigen::Index i = 0; i < pieces; ++i) {
        A.block<1, 4>(row, 4 * i) = powers_of(0, 0);
        b[row++] = M[static_cast<std::size_t>(i)];
        A.block<1, 4>(row, 4 * i) = powers_of(length(i), 0);
        b[row++] = M[static_cast<std::size_t>(i) + 1];
    }
    for (Eigen::Index i = 0; i + 1 < pieces; ++i) {
        goes_on(i, i + 1, 1);
        goes_on(i, i + 1, 2);
    }
    if (periodic) {
        goes_on(pieces - 1, 0, 1);
        goes_on(pieces - 1, 0, 2);
    } else {
        goes_on(0, 1, 3);
        goes_on(pieces - 2, pieces - 1, 3);
    }
    return A.fullPivLu().solve(b);
}

}  // namespace

TEST_CASE("a spline solves all its equations at once, with not-a-knot and periodic ends", "[spline]") {
    std::vector<double> t{0.2, 0.5, 0.55, 1.3, 1.4, 2.1, 2.2, 3}, M{1, -0.5, 0.2, 2, 1.5, -3, -2.5, 1};
    for (const std::size_t points : {t.size(), std::size_t{5}, std::size_t{4}}) {
        t.erase(t.begin() + static_cast<std::ptrdiff_t>(points), t.end());
        M.resize(points);
        for (const bool periodic : {false, true}) {
            M.back() = periodic ? M.front() : M.back();
            const auto period = periodic ? std::optional(t.back() - t.front()) : std::nullopt;
            const Polyline line = through(cubic(t, M, period));
            std::vector<double> back;
            for (const double at : t) back.insert(back.begin(), -at);
            CHECK(through(cubic(back, {M.rbegin(), M.rend()}, period)).most() == within(line.most(), 1e-11));
            const Eigen::VectorXd truth = dense_spline(t, M, periodic);
            for (std::size_t i = 0; i + 1 < points; ++i) {
                const Eigen::Vector4d piece = truth.segment<4>(4 * static_cast<Eigen::Index>(i));
                for (const double part : {0.0, 0.2, 0.5, 0.9}) {
                    const double h = part * (t[i + 1] - t[i]);
                    // The dense system's own rounding, from a condition of some 1e4.
                    CHECK(line.value(t[i] + h) == within(powers_of(h, 0).dot(piece), 1e-11));
                }
            }
        }
    }
}

TEST_CASE("a spline through points of a cubic is that cubic, wherever the points are", "[spline]") {
    const auto f = [](double t) { return 2 - t + 0.5 * t * t - 0.25 * t * t * t; };
    std::vector<double> t{-1, -0.4, 0.1, 0.35, 1.7, 2, 3.5}, M;
    for (const double x : t) M.push_back(f(x));
    const Polyline line = through(cubic(t, M));
    for (int i = 0; i <= 90; ++i) {
        const double x = -1 + 0.05 * i;
        CHECK(line.value(x) == within(f(x), 1e-13));
        CHECK(std::fabs(line.value(x)) <= line.most());
    }
    CHECK(line.value(-5) == M.front());
    CHECK(line.value(9) == M.back());
    // Three points are a parabola, two a straight line, one a constant.
    CHECK(through(cubic({0, 1, 3}, {0, 1, 9})).value(2) == within(4, 1e-14));
    CHECK(through(cubic({0, 2}, {1, 5})).value(0.5) == 2);
    CHECK(through(cubic({4}, {7})).value(-3) == 7);
    // Two points again and again, with the slope -2 at both: 1.5 m0 + 3 m1 = 3 m0 + 1.5 m1 = -9. One is a constant.
    CHECK(through(cubic({0, 2}, {1, 5}, 3)).value(0.5) == within(1.25, 1e-14));
    CHECK(through(cubic({0, 2}, {1, 5}, 3)).value(2.5) == within(3, 1e-14));
    const Polyline level = through(cubic({4}, {7}, 3));
    CHECK(level.value(-3) == 7);
    CHECK(level.constant_from() == -model::never);
    CHECK(level.repeats_after() == 0);
}

TEST_CASE("two integrators agree on a motion under a spline, and its steady motion is that of the sine", "[spline]") {
    const Oscillator system = truth::nondimensional(0.05, 0.3, 0.35);
    Samples s{.t = {}, .M = {}, .interpolation = Interpolation::cubic, .period = 1.6};
    for (int i = 0; i < 64; ++i) {
        s.t.push_back(0.025 * i);
        s.M.push_back(std::sin(2 * pi * i / 64.0));
    }
    const auto M = Excitation::make(through(std::move(s)));
    REQUIRE(M);
    const motion::Window window{0, 12};
    const auto rows = motion::Grid::every(0.5);
    const auto a = truth::must_run(system, *M, {1, 0}, window, rows, motion::Exact{});
    const auto b = truth::must_run(system, *M, {1, 0}, window, rows, motion::Spectral{});
    const auto c = truth::must_run(system, truth::harmonic(1, 2 * pi / 1.6), {1, 0}, window, rows, motion::Exact{});
    REQUIRE(a.events.size() == b.events.size());
    for (const auto column : {motion::Column::theta, motion::Column::velocity}) {
        const auto first = a.column(column), second = b.column(column), sine = c.column(column);
        for (Eigen::Index i = 0; i < a.size(); ++i) {
            CHECK(first[i] == within(second[i], 1e-10));
            CHECK(first[i] == within(sine[i], 1e-4));
        }
    }
}

}  // namespace dinal::spline_test
