#include "support/reference_systems.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "support/written.hpp"

namespace dinal::truth {

namespace {

constexpr model::State from_origin{0, 2 * std::numbers::pi};  // the report's free cases: unit amplitude without losses
constexpr model::State drawn_out{1, 0};                       // and its driven ones

const std::vector<Piece> no_drive{{-1, {}}};

void add_free(std::vector<ReferenceSystem>& list) {
    const auto free = [&](std::string name, const model::Oscillator& system, double t_end) {
        list.push_back({std::move(name), system, {}, no_drive, from_origin, {0, t_end}, 1});
    };
    free("free undamped", nondimensional(0, 0), 10.3);
    free("free underdamped (fig 16)", nondimensional(0.239, 0), 4.3);
    free("free critical (fig 17)", nondimensional(1, 0), 2.3);
    free("free overdamped (fig 18)", nondimensional(2.387, 0), 4.3);
    free("free Coulomb (fig 22)", nondimensional(0, 0.167), 3);
    free("free mixed (fig 26)", nondimensional(0.119, 0.06), 3);
    list.push_back({"free, Re = 2 Rd", nondimensional(0, 0.06, 0.12), {}, no_drive, {-1.03, 0.4}, {0, 6}, 1.1});
}

void add_driven(std::vector<ReferenceSystem>& list) {
    const auto driven = [&](std::string name, const model::Oscillator& system, double r, double t_end, double size) {
        list.push_back({std::move(name),
                        system,
                        harmonic(1, r * resonance),
                        harmonic_drive(1, r * resonance),
                        drawn_out,
                        {0, t_end},
                        size});
    };
    driven("resonance, no dry friction (fig 19)", nondimensional(0.239, 0), 1, 6.3, 2.1);
    driven("undamped resonance", nondimensional(0, 0), 1, 6.3, 20);
    driven("growing resonance with friction (fig 23)", nondimensional(0, 0.167), 1, 6.3, 14);
    driven("W3: one stop per half cycle (fig 24)", nondimensional(0, 0.836), 1, 20.3, 1);
    driven("W4: resonance, both frictions (fig 27)", nondimensional(0.119, 0.418), 1, 20.3, 2);
    driven("r = 1.35 (fig 25)", nondimensional(0, 0.5), 1.35, 10.3, 1.5);
    driven("slow load, several stops per cycle", nondimensional(0, 0.4), 0.1, 25.3, 1.4);
    driven("Re = 1.25 Rd at r = 0.6", nondimensional(0, 0.5, 0.625), 0.6, 12.3, 1.5);
    driven("Rd = 0 < Re", nondimensional(0.1, 0, 0.9), 0.37, 8.3, 1.5);
}

model::Oscillator block() {
    return system_of({.inertia = 10, .stiffness = 4000, .kinetic_friction = 19.62, .breakaway = 29.43});
}

void add_field_cases(std::vector<ReferenceSystem>& list) {
    // The angle is a distance here: a block of 10 kg, pulled through a spring of 4000 N/m at 0.01 m/s.
    list.push_back(
        {"spring-pulled block", block(), native(model::Ramp{.slope = 40}), {{0, {.slope = 40}}}, {0, 0}, {0, 4}, 0.04});
    list.push_back({"newsgroup oscillator",
                    system_of({.inertia = 1, .stiffness = 1, .kinetic_friction = 10}),
                    {},
                    no_drive,
                    {0, 5},
                    {0, 2},
                    1.2});

    std::vector<Piece> square;
    for (int i = 0; i < 20; ++i) square.push_back({0.75L * i, {.level = i % 2 == 0 ? 1.0L : -1.0L}});
    list.push_back({"square wave with sticking",
                    nondimensional(0.05, 0.45, 0.6),
                    native(model::Square{.amplitude = 1, .period = 1.5}),
                    square,
                    {0, 0},
                    {0, 9.9},
                    2});

    list.push_back({"pulse on a resting mass at 20 T0",
                    nondimensional(0, 0.167),
                    native(model::Pulse{.amplitude = 3, .at = 20, .width = 0.125}),
                    {{0, {}}, {20, {.level = 3}}, {20.125L, {}}},
                    {0.05, 0},
                    {0, 24},
                    1});
    list.push_back({"start on the limit",
                    system_of({.inertia = 0.7, .stiffness = 3, .kinetic_friction = 0.5}),
                    {},
                    no_drive,
                    {0.5 / 3, 0},
                    {0, 5},
                    0.2});
    list.push_back(
        {"stiff, C = 4000",
         system_of({.inertia = 1, .stiffness = 39.48, .damping = 4000, .kinetic_friction = 2, .breakaway = 3}),
         harmonic(20, 5),
         harmonic_drive(20, 5),
         {0.2, 30},
         {0, 2},
         0.2});
}

/// amplitude sin(omega t) - share sgn(velocity)
class FrictionByHand : public model::UserFunction {
public:
    FrictionByHand(double share, double amplitude, double omega)
        : share_(share), amplitude_(amplitude), omega_(omega) {}
    double value(double t, const model::State& state) override {
        const double against = state.velocity == 0 ? 0 : std::copysign(share_, state.velocity);
        return amplitude_ * std::sin(omega_ * t) - against;
    }

private:
    double share_, amplitude_, omega_;
};

/// `system` with a share of its sliding friction moved into M.
ReferenceSystem braked_by_hand(std::string name, const ReferenceSystem& s, double share) {
    const Drive& drive = s.drives.front().drive;
    const auto function =
        std::make_shared<FrictionByHand>(share, static_cast<double>(drive.amplitude), static_cast<double>(drive.omega));
    ReferenceSystem copy = s;
    copy.name = std::move(name);
    copy.same_as = s.oscillator;
    copy.oscillator = system_of({.inertia = s.oscillator.inertia(),
                                 .stiffness = s.oscillator.stiffness(),
                                 .damping = s.oscillator.damping(),
                                 .kinetic_friction = s.oscillator.kinetic_friction() - share,
                                 .breakaway = s.oscillator.breakaway()});
    copy.excitation = native(model::Scripted{.function = function, .feedback = true});
    return copy;
}

/// The same motion in other units: theta times `angle`, with the given inertia and stiffness.
ReferenceSystem rescaled(const ReferenceSystem& base, std::string name, double inertia, double stiffness,
                         double angle) {
    const double time = std::sqrt(inertia / stiffness) * base.oscillator.natural_frequency();
    const double torque = angle * stiffness / base.oscillator.stiffness();
    const Drive& drive = base.drives.front().drive;
    if (base.drives.size() != 1) throw std::logic_error("rescaled: only for one drive");
    const auto amplitude = static_cast<double>(drive.amplitude) * torque;
    const auto omega = static_cast<double>(drive.omega) / time;
    return {std::move(name),
            system_of({.inertia = inertia,
                       .stiffness = stiffness,
                       .damping = base.oscillator.damping() * torque / angle * time,
                       .kinetic_friction = base.oscillator.kinetic_friction() * torque,
                       .breakaway = base.oscillator.breakaway() * torque}),
            harmonic(amplitude, omega),
            harmonic_drive(amplitude, omega),
            {base.initial.theta * angle, base.initial.velocity * angle / time},
            {base.window.start * time, base.window.end * time},
            base.size * angle};
}

}  // namespace

double ReferenceSystem::fastest_rate() const {
    double rate = std::max(oscillator.natural_frequency(), oscillator.damping() / oscillator.inertia());
    for (const Piece& piece : drives) rate = std::max(rate, static_cast<double>(piece.drive.omega));
    return rate;
}

model::Oscillator system_of(const model::OscillatorParameters& parameters) {
    return model::Oscillator::make(parameters).value();
}

model::Oscillator nondimensional(double zeta, double friction_ratio, double breakaway_ratio) {
    return system_of({.inertia = 1 / (4 * std::numbers::pi * std::numbers::pi),
                      .stiffness = 1,
                      .damping = zeta / std::numbers::pi,  // 2 zeta sqrt(I k)
                      .kinetic_friction = friction_ratio,
                      .breakaway = breakaway_ratio});
}

model::Excitation harmonic(double amplitude, double omega, double phase) {
    return native(model::Harmonic{.amplitude = amplitude, .omega = omega, .phase = phase});
}

std::vector<Piece> harmonic_drive(double amplitude, double omega, double phase) {
    return {{-model::never, {.amplitude = amplitude, .omega = omega, .phase = phase}}};
}

const std::vector<ReferenceSystem>& reference_systems() {
    static const std::vector<ReferenceSystem> systems = [] {
        std::vector<ReferenceSystem> list;
        add_free(list);
        add_driven(list);
        add_field_cases(list);
        const auto named = [&](std::string_view name) {
            return *std::find_if(list.begin(), list.end(), [&](const auto& s) { return s.name == name; });
        };
        const ReferenceSystem w3 = named("W3: one stop per half cycle (fig 24)");
        const ReferenceSystem w4 = named("W4: resonance, both frictions (fig 27)");
        list.push_back(rescaled(w3, "W3 with I = 1e-6, k = 1e3, angles of 1e-9", 1e-6, 1e3, 1e-9));
        list.push_back(rescaled(w3, "W3 with I = 1e5, k = 1, angles of 1e6", 1e5, 1, 1e6));
        list.push_back(rescaled(w4, "W4 with I = 1e-6, k = 1e3, angles of 1e6", 1e-6, 1e3, 1e6));
        list.push_back(rescaled(w4, "W4 with I = 1e5, k = 1, angles of 1e-9", 1e5, 1, 1e-9));
        return list;
    }();
    return systems;
}

const std::vector<ReferenceSystem>& jumping_feedback_systems() {
    static const std::vector<ReferenceSystem> systems = [] {
        std::vector<ReferenceSystem> list;
        // Comes to rest at t = 3 pi, where k theta = 0.1.
        const ReferenceSystem free{
            "", system_of({.inertia = 1, .stiffness = 1, .kinetic_friction = 0.2}), {}, no_drive, {1.1, 0}, {0, 20},
            1.1};
        list.push_back(braked_by_hand("free, half of the friction by feedback", free, 0.1));
        for (const char* name :
             {"free mixed (fig 26)", "W3: one stop per half cycle (fig 24)", "W4: resonance, both frictions (fig 27)",
              "slow load, several stops per cycle", "Re = 1.25 Rd at r = 0.6"}) {
            const ReferenceSystem& s = reference_system(name);
            list.push_back(
                braked_by_hand(s.name + ", a third of Rd by feedback", s, s.oscillator.kinetic_friction() / 3));
        }
        return list;
    }();
    return systems;
}

const ReferenceSystem& reference_system(std::string_view name) {
    for (const ReferenceSystem& system : reference_systems()) {
        if (system.name == name) return system;
    }
    throw std::logic_error("no such reference system");
}

}  // namespace dinal::truth
