// The eigenmodes of a system: its small free vibrations.
#pragma once

#include <complex>
#include <vector>

#include "model/drive.hpp"
#include "model/oscillator.hpp"
#include "model/system.hpp"
#include "text/expected.hpp"

namespace dinal::motion::engine {

/// The linear modes of the system without friction, each as a system of one body.
std::vector<model::Oscillator> modes_of(const model::System& system);

/// A one-body system whose frequency is at least that of every mode.
text::Expected<model::Oscillator> no_slower_than_modes(const model::System& system);

struct EigenMode {
    /// eigenvalue per time unit; of a conjugate pair the one with positive imaginary part
    std::complex<double> value;
    std::vector<std::complex<double>> shape{};  ///< amplitude of each body; the greatest is 1
};

/// Returns the modes of small motions about an equilibrium, searched from theta0, or about steady sliding: contacts on
/// belts slide, all others hold. Sorted by frequency.
text::Expected<std::vector<EigenMode>> modes_beside(const model::System& system, const model::Drive& drive);

}  // namespace dinal::motion::engine
