// The gnuplot commands of one panel, in our own style.
#pragma once

#include <string>
#include <vector>

#include "plots/curve_script.hpp"

namespace dinal::plots {

using Selection = std::vector<Trace>;  ///< one for each curve

std::string panel_script(const Sheet& sheet, const PaperPanel& panel, const Selection& kept, GnuplotData& data);

}  // namespace dinal::plots
