#include "model/excitation.hpp"

#include "support/excitations.hpp"

namespace dinal::term_check_test {

using namespace dinal::model;
using namespace dinal::excitations;

TEST_CASE("a term with impossible options is refused with a sentence", "[excitation]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(complaint(Constant{nan}) == "excitation.constant: amplitude = nan must be finite");
    CHECK(complaint(Harmonic{1, -2, 0}) == "excitation.harmonic: omega = -2 must not be negative");
    CHECK(complaint(Harmonic{never, 1, 0}) == "excitation.harmonic: amplitude = inf must be finite");
    CHECK(complaint(Step{1, never}) == "excitation.step: at = inf must be finite");
    CHECK(complaint(Pulse{1, 0, -1}) == "excitation.pulse: width = -1 must be positive");
    CHECK(complaint(HalfSine{1, 0, 0}) == "excitation.half_sine: width = 0 must be positive");
    CHECK(complaint(Gaussian{1, 0, 0}) == "excitation.gaussian: sigma = 0 must be positive");
    CHECK(complaint(Ramp{1, 0, nan}) == "excitation.ramp: duration = nan must be a number");
    CHECK(complaint(Ramp{1, 0, never}).empty());
    CHECK(complaint(Square{1, 0}) == "excitation.square: period = 0 must be positive");
    CHECK(complaint(Square{1, 1, 1}) == "excitation.square: duty = 1 must lie between 0 and 1");
    CHECK(complaint(Sawtooth{1, -0.5}) == "excitation.sawtooth: period = -0.5 must be positive");
    CHECK(complaint(Triangle{1, never}) == "excitation.triangle: period = inf must be finite");
    CHECK(complaint(Chirp{1, -1, 2, 3}) == "excitation.chirp: from = -1 must not be negative");
    CHECK(complaint(Chirp{1, 1, 2, 0}) == "excitation.chirp: duration = 0 must be positive");
    CHECK(complaint(Exponential{1, 0}) == "excitation.exponential: tau = 0 must not be zero");
    CHECK(complaint(Polynomial{{1, nan}}) == "excitation.polynomial: coefficients[2] = nan must be finite");
    CHECK(complaint(Polynomial{}).find("coefficients is empty") != std::string::npos);
}

}  // namespace dinal::term_check_test
