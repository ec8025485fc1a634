#include "help/topics.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "text/words.hpp"

namespace dinal::help {
namespace {

struct Topic {
    std::string_view words;  // in lower case
    std::string_view text;
};

// No line is longer than 77 columns. A test looks for every name that stands here.
constexpr std::array<Topic, 12> topics = {{
    {"degrees degree deg radians radian angle angles",
     "Angles are in radians: theta, theta0, velocity per time unit. math.rad(90)\n"
     "makes radians of 90 degrees, math.deg(x) degrees of radians, and of a whole\n"
     "column 180/math.pi*run.theta. Lags are in radians, too; explain() tells them\n"
     "in degrees.\n"},
    {"tutorial tour start lesson course",
     "help() is a tour of two minutes. docs/tutorial.md takes half an hour, the\n"
     "sheets in docs/lab are a course of six afternoons, and the programs in\n"
     "examples show one idea each.\n"},
    {"dinal1989 fortran 1989 report",
     "dinal is named after DINAL, the Fortran program of a report of 1989 about a\n"
     "governor with friction. integrator.dinal1989 is its listing, step by step;\n"
     "run:save \"name.dat\" writes its record; docs/report.md reads the report again.\n"},
    {"readdin",
     "READDIN picked two columns out of the record of DINAL, in 1989, for the\n"
     "plotter. run:columns does that; load reads such a record.\n"},
    {"draar",
     "DRAAR drew the two columns that READDIN had picked, in 1989, on a plotter.\n"
     "run:plot and plot do that.\n"},
    {"governor flyball sleeve hunting",
     "A governor is an oscillator with friction inside a loop: docs/governor.md and\n"
     "examples/270-governor.lua, or sheet 6 of the course in docs/lab. The rotor is\n"
     "one of the states of a run: help(sys.simulate) has the option states.\n"},
    {"noise noisy random",
     "vector.normal and vector.random make numbers with a seed, which a record can\n"
     "be blurred with; identify finds a system in spite of it, and fit.noise is how\n"
     "much there was. A noisy M is a table: excitation.samples.\n"},
    {"fit fitting regression estimate calibrate",
     "identify finds the system that made a record, with the errors of what it\n"
     "finds: identify{ data = load \"decay.csv\" }.\n"},
    {"matlab octave python numpy scipy simulink modelica",
     "docs/guide.md has a table for those who come from MATLAB or SciPy: indices\n"
     "begin at 1, options stand in braces, a power is x^2, and a vector v has its\n"
     "functions behind a colon: v:max(). Python reads what run:save \"run.csv\"\n"
     "writes.\n"},
    {"kernel jupyter notebook ipython",
     "dinal --jupyter-install, typed to a shell, makes a kernel for Jupyter:\n"
     "docs/notebook.md.\n"},
    {"safe sandbox limit limits",
     "dinal --safe runs the script of a stranger: it sees one folder, and --max-time\n"
     "and --max-memory limit what it takes: docs/safe-mode.md.\n"},
    {"shell ls pwd terminal",
     "No shell is in here: Ctrl-Z goes back to yours, and fg comes back. Files are\n"
     "read by load and excitation.samples.\n"},
}};

/// Words of other languages, and ours for the same.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> foreign = {{
    {"reibung rozamiento friccion fricción frottement attrito", "friction"},
    {"feder muelle resorte ressort molla", "spring"},
    {"daempfung dämpfung amortiguamiento amortissement smorzamento", "damping"},
    {"schwinger oscilador oscillateur oscillatore sistema système", "system"},
    {"erregung anregung excitacion excitación eccitazione", "excitation"},
    {"resonanz resonancia résonance risonanza", "resonance"},
    {"energie energía energia énergie", "energy"},
    {"hilfe ayuda aide aiuto", "help"},
}};

bool has_word(std::string_view words, std::string_view wanted) {
    for (std::size_t begin = 0; begin < words.size();) {  // not tokens: a letter of these may be none of Lua
        const std::size_t end = std::min(words.find(' ', begin), words.size());
        if (words.substr(begin, end - begin) == wanted) return true;
        begin = end + 1;
    }
    return false;
}

}  // namespace

std::string_view in_english(std::string_view word) {
    const std::string wanted = text::lower(word);
    const auto* const found =
        std::find_if(foreign.begin(), foreign.end(), [&](const auto& row) { return has_word(row.first, wanted); });
    return found == foreign.end() ? word : found->second;
}

std::string_view topic(std::string_view word) {
    const std::string wanted = text::lower(word);
    for (const Topic& one : topics) {
        if (has_word(one.words, wanted)) {
            return one.text;
        }
    }
    return {};
}

}  // namespace dinal::help
