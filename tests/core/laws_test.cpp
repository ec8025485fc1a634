// Friction laws other than one number each for sliding and holding; oracle_test.cpp and corners_test.cpp have their
// motions against independent integrators.
#include <cmath>

#include "analysis/energy.hpp"
#include "model/laws/coulomb.hpp"
#include "model/laws/stribeck.hpp"
#include "model/laws/tabulated.hpp"
#include "model/laws/user_law.hpp"
#include "model/sticking.hpp"
#include "support/catch.hpp"
#include "support/measure.hpp"

namespace dinal::laws_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;
using model::laws::AsymmetricCoulomb;
using model::laws::Coulomb;

namespace {

struct LawCase {
    const char* name;
    Friction law;
};

/// 0.25 + 0.1 v^2, as a user would write it.
class QuadraticLaw final : public UserFunction {
public:
    double value(double speed, const State& /*state*/) override {
        CHECK(speed >= 0);  // a root there would be no number
        return 0.25 + 0.1 * speed * speed;
    }
};

const std::vector<LawCase>& law_cases() {
    static const std::vector<LawCase> cases = {
        {"coulomb", Coulomb{0.25, 0.6}},
        {"asymmetric", AsymmetricCoulomb{.forward = {0.1, 0.3}, .backward = {0.35, 0.5}}},
        {"stribeck", model::laws::Stribeck{.kinetic = 0.25, .breakaway = 0.6, .speed = 0.4}},
        {"tustin", model::laws::Stribeck{.kinetic = 0.25, .breakaway = 0.6, .speed = 0.4, .shape = 1}},
        {"table", model::laws::Tabulated{.speed = {0, 0.5, 2}, .torque = {0.45, 0.2, 0.35}, .breakaway = 0.6}},
        {"function",
         model::laws::UserLaw{.function = std::make_shared<QuadraticLaw>(), .at_zero = 0.25, .breakaway = 0.6}},
    };
    return cases;
}

Oscillator with_law(const Friction& law, double damping = 0) {
    return system_of({.inertia = 1, .stiffness = 1, .damping = damping, .friction = law});
}

}  // namespace

TEST_CASE("the energy adds up under every friction law, and rows contain its friction", "[laws][energy]") {
    for (const LawCase& c : law_cases()) {
        CAPTURE(c.name);
        const Run run =
            must_run(with_law(c.law, 0.02), harmonic(0.8, 0.7), {1.3, 0}, {0, 60}, Grid::every(0.5), Spectral{});
        const auto energy = analysis::energy_of(run);
        REQUIRE(energy);
        CHECK(energy->closure() < 1e-12);
        CHECK(energy->total.work.dry > 0.1 * energy->flow);
        CHECK(energy->total.work.input > 0.1 * energy->flow);  // what M did, not what it did less friction
        const auto columns = analysis::energy_columns(run);
        CHECK(columns.col(static_cast<Eigen::Index>(analysis::EnergyColumn::error)).cwiseAbs().maxCoeff() <
              1e-12 * energy->flow);
        for (Eigen::Index i = 0; i < run.size(); ++i) {
            const double v = run.rows(i, 2);
            if (v != 0) CHECK(run.rows(i, 4) == -sign_of(motion_of(v)) * c.law.sliding(motion_of(v), std::fabs(v)));
        }
    }
}

TEST_CASE("a law with equal numbers in both directions is Coulomb's, bit for bit", "[laws]") {
    const Oscillator plain = system_of({.inertia = 1, .stiffness = 1, .kinetic_friction = 0.1, .breakaway = 0.2});
    const Oscillator twice = with_law(AsymmetricCoulomb{.forward = {0.1, 0.2}, .backward = {0.1, 0.2}});
    for (const Integrator& integrator : std::vector<Integrator>{Exact{}, Spectral{}, Rk4{0.01}}) {
        const auto run = [&](const Oscillator& system) {
            return must_run(system, harmonic(0.5, 1.3), {1, 0}, {0, 50}, Grid::every(0.1), integrator).rows;
        };
        CHECK(run(plain) == run(twice));
    }
}

}  // namespace dinal::laws_test
