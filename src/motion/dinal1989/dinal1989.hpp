// integrator.dinal1989: the program DINAL as it was printed in 1989, stop rule included.
#pragma once

#include "motion/method.hpp"

namespace dinal::motion::dinal1989 {

struct Dinal1989 {
    enum class Stop {
        /// stop if |v| <= |v' - v|, where v is the previous step's velocity and v' the new one, and the torque is
        /// within Re
        listing,
        text,  ///< stop if |v| < |v' - v| / 2, as in section 6 of the report
    };
    double h = 0;  ///< not limited, because its divergence is a result
    Stop stop = Stop::listing;
    bool slip = false;  ///< whether stage 3 uses the wrong index, as chapter 6 of the report did

    static constexpr bool evaluates_in_order = true;
    static const MethodText about;
    [[nodiscard]] std::optional<text::Error> wrong_for(const model::Oscillator& system,
                                                       const model::Excitation& excitation) const;
    Resolution resolution(const model::Oscillator& /*system*/) const { return {"h", h}; }
    Run run(const Problem& problem) const;
    OwnRule own_rule() const;
};

inline constexpr const char* stop_rules[] = {"listing", "text"};
inline constexpr text::Option dinal1989_options[] = {
    {"h", "time units", text::needed, text::positive, "the step", text::fills<&Dinal1989::h>},
    text::option<&Dinal1989::stop>("stop", "the stop rule: that of the listing, or that of the report's text",
                                   {.choices = stop_rules}),
    text::option<&Dinal1989::slip>("slip", "with the wrong index of the report's chapter 6"),
};

inline constexpr MethodText Dinal1989::about{
    {"integrator.dinal1989", "integrator.dinal1989{ h = 0.01 }", dinal1989_options},
    "The program DINAL as it was printed in 1989, with step h (time units) and its own rule for stops, for "
    "comparison. stop = \"text\" uses the rule of the report's text; slip = true repeats the wrong index of the "
    "report's chapter 6. As in 1989, M is evaluated in order of time, so this method alone does not detect an M "
    "with memory.",
    "sys = nondimensional{}\n"
    "run = sys:simulate{ theta0 = 1, t_end = 0.5, dt = 0.5, integrator = integrator.dinal1989{ h = 0.1 } }\n"
    "print(string.format(\"%.6f\", run.theta[2]))  --> -0.997964"};

}  // namespace dinal::motion::dinal1989
