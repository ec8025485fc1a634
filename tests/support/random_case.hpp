// Systems and excitations by lot: the same number gives the same case, told twice, to dinal and to the oracle.
#pragma once

#include <cstdint>
#include <string>

#include "motion/simulate.hpp"
#include "support/oracle.hpp"

namespace dinal::truth {

struct RandomCase {
    std::string story;  ///< enough to write the case down elsewhere
    model::Oscillator system;
    model::Excitation excitation;
    Load load;  ///< the same excitation
    model::State initial;
    motion::Window window;
    double size;  ///< about the greatest angle

    /// Where it is told: generic times in the window, increasing.
    std::vector<double> times;

    /// Times are rounded: by this part of the narrowest bump.
    double lost_in_time = 0;
    /// What an event may be late by, radians. A bump may be so steep that no error of M explains it.
    double late = 0;
};

RandomCase random_case(std::uint64_t number);
/// Driven by smooth bumps, of 1e-6 T0 up to ten; half of them begin at rest.
RandomCase random_case_of_bumps(std::uint64_t number);
/// Driven by terms that have closed forms only, some of them at resonance or within 1e-15 ... 0.1 of it; at any
/// damping, also within 1e-12 of the critical one.
RandomCase random_case_of_closed_forms(std::uint64_t number);

/// Evenly distributed numbers that are the same with every library.
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

/// A term of M, told twice.
struct Ingredient {
    std::string story;
    model::Excitation excitation;
    Load load;
};
/// What a case is measured in.
struct Units {
    motion::Window window;
    double period;  ///< T0
    double angle;
    double torque;  ///< k angle
};
Ingredient random_native_term(Lot& lot, const Units& units);
/// A sine or an exponential that answers to the free motion.
Ingredient random_resonant_term(Lot& lot, const Units& units, double damping_ratio);
Ingredient random_bump(Lot& lot, const Units& units, double width);
Ingredient random_function_of_time(Lot& lot, const Units& units);
Ingredient random_feedback(Lot& lot, const Units& units);

/// The whole number that the environment has under this name: DINAL_ORACLE_CASES asks for more systems by lot than are
/// usual, or for fewer; DINAL_ORACLE_FIRST begins with another one.
long number_from(const char* variable, long otherwise);

}  // namespace dinal::truth
