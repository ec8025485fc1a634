// How small disturbances of a rest, or of an even sliding or turning, grow or die out: eigenvalues and shapes.
#pragma once

#include <complex>
#include <vector>

#include "analysis/steady.hpp"
#include "text/expected.hpp"

namespace dinal::analysis {

/// A disturbance that goes with exp(value t).
struct RestMode {
    std::complex<double> value;                ///< per time unit
    std::vector<std::complex<double>> angles;  ///< of each body, the greatest one 1
};

/// The modes beside the rest that is found from the start of the question, which is timeless: those with imaginary
/// parts of at least 0, the slowest first. Contacts that hold are fixed, those that slide have the slope of their law as
/// a damping. Each way of going on with its velocity, which nothing pulls back, has the value 0. Fails where no rest is
/// found.
text::Expected<std::vector<RestMode>> modes_beside_rest(const SteadyQuestion& question,
                                                        const motion::Monitor& monitor = {});

}  // namespace dinal::analysis
