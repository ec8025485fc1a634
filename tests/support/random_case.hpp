// Random systems, excitations and whole cases: the same number gives the same case, defined independently for dinal and
// for the integrator of mixed_truth.hpp.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "model/drive.hpp"
#include "motion/integrators.hpp"
#include "motion/simulate.hpp"
#include "support/mixed_truth.hpp"

namespace dinal::truth {

struct RandomCase {
    std::string story;  ///< a description sufficient to reproduce the case
    model::OscillatorParameters parameters;
    model::Drive drive;
    motion::Window window;
    /// The same case in units of its own, from t = 0 on.
    MixedSystem truth;
    real time = 1, angle = 1;                                 ///< these units in those of the case
    double z0 = 0;                                            ///< start of its state
    bool untold = false, remembers = false, corners = false;  ///< unannounced jumps of M; a controller; corners of the
                                                              ///< law
    /// Output times: generic times in the window, increasing.
    std::vector<double> times;
    /// Additional error of rows: the rounding of times as a part of the narrowest bump.
    double lost_in_time = 0;
    /// The allowed delay of events, radians: a bump may be too steep for an error of M to explain it.
    double late = 0;
};

/// A plain system under native terms, functions of time and feedback.
RandomCase random_case(std::uint64_t number);
/// Driven by smooth bumps with widths from 1e-6 to 10 T0; half of the cases begin at rest.
RandomCase random_case_of_bumps(std::uint64_t number);
/// Driven by terms with closed forms, some at resonance or within 1e-15 ... 0.1 of it, with any damping, including
/// within 1e-12 of critical.
RandomCase random_case_of_closed_forms(std::uint64_t number);
/// With combined features: laws, springs, walls, states, controllers, belts, bases, acts.
RandomCase random_case_of_all_kinds(std::uint64_t number);

/// An integrator, and the error that it is allowed, as a part of the size of the case and of what an equal error of the
/// load would cause.
struct Compared {
    motion::Integrator method;
    double accuracy;
    std::function<bool(const RandomCase&, std::uint64_t number)> takes = {};  ///< empty: all cases
};
/// Compares runs of `cases` cases, event by event, with the independent integrator; a failure prints the case. One in
/// `clear` cases may have decisions too close to call.
void check_cases(RandomCase (*random)(std::uint64_t number), const std::vector<Compared>& methods, long cases,
                 long clear);

/// Uniform random numbers that are the same with every library.
class Lot {
public:
    explicit Lot(std::uint64_t seed) : state_(seed) {}
    double between(double a, double b) { return a + (b - a) * (static_cast<double>(next() >> 11U) * 0x1p-53); }
    /// One of 0 .. n - 1.
    int of(int n) { return static_cast<int>(between(0, n)); }
    bool once_in(int n) { return of(n) == 0; }
    double power_of_ten(double a, double b);

private:
    std::uint64_t next();
    std::uint64_t state_;
};

/// M for the independent integrator: smooth on each stretch between breaks.
struct Load {
    /// M at t by the formulas valid at the time `inside`, so that both ends of a stretch can be evaluated.
    std::function<real(real t, real inside, const MixedPoint&)> torque;
    std::vector<double> breaks = {};
};
/// A term of M for dinal and for the independent integrator.
struct Ingredient {
    std::string story;
    model::Excitation excitation;
    Load load;
};
/// The scales of a case.
struct Units {
    motion::Window window;
    double period;  ///< T0
    double angle;
    double torque;  ///< k angle
};
Ingredient random_native_term(Lot& lot, const Units& units);
/// A sine or an exponential in resonance with the free motion.
Ingredient random_resonant_term(Lot& lot, const Units& units, double damping_ratio);
Ingredient random_bump(Lot& lot, const Units& units, double width);
Ingredient random_function_of_time(Lot& lot, const Units& units);
Ingredient random_feedback(Lot& lot, const Units& units);

/// The whole number in an environment variable: DINAL_ORACLE_CASES sets the number of random systems,
/// DINAL_ORACLE_FIRST the first one.
long number_from(const char* variable, long otherwise);

}  // namespace dinal::truth
