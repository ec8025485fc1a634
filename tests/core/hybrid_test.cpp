// Systems of all kinds by lot: laws of friction, springs, walls, belts, bases and states, each under sines, records,
// windows, jumps, delays, sampled controllers, relays and acts.
#include "support/catch.hpp"
#include "support/random_mixed.hpp"

namespace dinal::hybrid_test {

TEST_CASE("random systems of all kinds agree with an independent integrator, event by event", "[hybrid][mixed]") {
    truth::check_random_mixed(60);
}

}  // namespace dinal::hybrid_test
