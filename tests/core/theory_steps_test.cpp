// The greatest stable step of rk4.
#include <cmath>

#include "motion/rk4/rk4.hpp"
#include "support/catch.hpp"
#include "support/reference_systems.hpp"

namespace dinal::theory_steps_test {

using namespace dinal::motion;

TEST_CASE("the step limit of rk4 is where its amplification passes 1", "[theory]") {
    CHECK(std::fabs(rk4::stability_limit(truth::nondimensional(0.02387, 0)) - 0.457) <= 0.0005);
    CHECK(std::fabs(rk4::stability_limit(truth::nondimensional(0, 0)) - 0.4502) <= 0.00005);
}

}  // namespace dinal::theory_steps_test
