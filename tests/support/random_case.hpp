// Random systems and excitations: the same number gives the same case, defined independently for dinal and the oracle.
#pragma once

#include <cstdint>
#include <string>

#include "motion/simulate.hpp"
#include "support/oracle.hpp"

namespace dinal::truth {

struct RandomCase {
    std::string story;  ///< a description sufficient to reproduce the case
    model::Oscillator system;
    model::Excitation excitation;
    Load load;  ///< the same excitation for the oracle
    model::State initial;
    motion::Window window;
    double size;  ///< about the greatest angle

    /// Output times: generic times in the window, increasing.
    std::vector<double> times;

    /// The rounding of times as a part of the narrowest bump.
    double lost_in_time = 0;
    /// The allowed delay of events, radians: a bump may be too steep for an error of M to explain it.
    double late = 0;
};

RandomCase random_case(std::uint64_t number);
/// Driven by smooth bumps with widths from 1e-6 to 10 T0; half of the cases begin at rest.
RandomCase random_case_of_bumps(std::uint64_t number);
/// Driven by terms with closed forms, some at resonance or within 1e-15 ... 0.1 of it, with any damping, including
/// within 1e-12 of critical.
RandomCase random_case_of_closed_forms(std::uint64_t number);

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

/// A term of M for dinal and for the oracle.
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
