// Errors of a fit: independent parameters, and valleys that are flat.
#include "analysis/least_squares.hpp"

#include <cmath>

#include "support/catch.hpp"
#include "support/within.hpp"

namespace dinal::least_squares_test {

using namespace dinal::analysis;

namespace {

Eigen::MatrixXd columns(std::initializer_list<Eigen::VectorXd> all) {
    Eigen::MatrixXd J(all.begin()->size(), static_cast<Eigen::Index>(all.size()));
    Eigen::Index i = 0;
    for (const Eigen::VectorXd& column : all) J.col(i++) = column;
    return J;
}

const Eigen::VectorXd ones = Eigen::VectorXd::Ones(100);
const Eigen::VectorXd ramp = Eigen::VectorXd::LinSpaced(100, -1, 1);

}  // namespace

TEST_CASE("what a record tells has the variance of the linear problem", "[identify]") {
    const Covariance found = covariance_of(columns({ones, ramp}), Eigen::Vector2d(1, 5), 1e-3);
    // A millionth by what was known before: the noise of 1e-3 is 1e-4 of ten wholes.
    CHECK(found.matrix(0, 0) == within(1 / ones.squaredNorm(), 1e-9));
    CHECK(found.matrix(1, 1) == within(1 / ramp.squaredNorm(), 1e-9));
    CHECK(std::fabs(found.matrix(0, 1)) < 1e-15);
    CHECK(found.silent == std::vector<bool>{false, false});
    CHECK(found.log_volume == within(-std::log(ones.norm() * 5 * ramp.norm()), 1e-9));
}

TEST_CASE("all parameters that a flat valley runs through are silent, and no other one", "[identify]") {
    // Only the difference of the first two is told, with noise and without.
    for (const double noise : {0.1, 0.0}) {
        const Covariance found = covariance_of(columns({ones, -ones, ramp}), Eigen::Vector3d(1, 2, 1), noise);
        CHECK(found.silent == std::vector<bool>{true, true, false});
        CHECK(found.matrix(2, 2) == within(1 / ramp.squaredNorm(), 1e-4));
        const double of_difference = found.matrix(0, 0) + found.matrix(1, 1) - 2 * found.matrix(0, 1);
        CHECK(of_difference == within(1 / ones.squaredNorm(), 1e-2));
    }
    // What nothing depends on is silent alone.
    const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(100);
    CHECK(covariance_of(columns({ones, nothing}), Eigen::Vector2d(1, 1), 0.1).silent == std::vector<bool>{false, true});
    // A valley that is nearly flat has the errors that it leaves open, up to what is known before.
    const Covariance long_valley = covariance_of(columns({ones, -ones + 0.1 * ramp}), Eigen::Vector2d(1, 1), 0.1);
    CHECK(long_valley.silent == std::vector<bool>{false, false});
    CHECK(long_valley.matrix(1, 1) == within(100 / ramp.squaredNorm(), 0.05));
}

TEST_CASE("with nothing to fit there is what is left, and no variance", "[identify]") {
    const Prediction model = [](const Eigen::VectorXd&) { return std::optional(Eigen::VectorXd(2 * ramp)); };
    const auto fit = least_squares(model, ramp, Eigen::VectorXd(0), {}, 10);
    REQUIRE(fit);
    CHECK(fit->sum == within(ramp.squaredNorm(), 1e-14));
    CHECK(covariance_of(Eigen::MatrixXd(100, 0), Eigen::VectorXd(0), 1).silent.empty());
}

}  // namespace dinal::least_squares_test
