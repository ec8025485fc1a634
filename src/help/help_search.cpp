// Finds the entries for a name or for words passed to help().
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "help/help_text.hpp"
#include "help/library.hpp"
#include "lua/lua_text.hpp"
#include "text/characters.hpp"
#include "text/suggest.hpp"
#include "text/words.hpp"

namespace dinal::help {

namespace {

std::vector<std::string_view> words_of(std::string_view text) {
    std::vector<std::string_view> words = text::split(text, ' ');  // not tokens: the letters may be invalid in Lua
    std::erase(words, "");
    return words;
}

bool has_word(std::string_view words, std::string_view wanted) {
    const std::vector<std::string_view> all = words_of(words);
    return text::contains(all, wanted);
}

struct HelpEntry {
    const Section* section;
    const lua::Member* member;  // null: the section itself
};

std::vector<HelpEntry> entries() {
    std::vector<HelpEntry> all;
    for (const Section& section : sections()) {
        for (const lua::Member& member : section.description->members) all.push_back({&section, &member});
    }
    return all;
}

/// Calls visit(entry, option) for each option of each entry; an option of two calls is visited twice.
template <class Visit>
void each_option(const Visit& visit) {
    for (const HelpEntry& entry : entries()) {
        for (const text::Call* call : calls_of(entry.member->doc)) {
            for (const OptionLine& option : option_lines(call->options)) visit(entry, option);
        }
    }
}

// Accepts sys.simulate, sys:simulate, system:simulate and simulate.
bool has_name(const HelpEntry& entry, std::string_view name) {
    const Section& section = *entry.section;
    if (entry.member->kind == lua::Kind::metamethod) return false;
    const std::size_t separator = name.find_last_of(".:");
    if (separator == std::string_view::npos) return name == entry.member->name;
    const std::string_view owner = name.substr(0, separator);
    return name.substr(separator + 1) == entry.member->name &&
           (owner == section.prefix || owner == section.description->name ||
            (owner == "dinal" && *section.prefix == '\0'));
}

/// The texts of the entries with this name; if it is global, such as `excitation`, not those of run.excitation.
std::string entries_named(std::string_view name, const terminal::Display& screen) {
    std::string globals, others;
    const auto add = [](std::string& text, const std::string& entry) { text += (text.empty() ? "" : "\n") + entry; };
    for (const HelpEntry& entry : entries()) {
        if (!has_name(entry, name)) continue;
        add(*entry.section->prefix == '\0' ? globals : others, member_text(*entry.section, *entry.member, screen));
    }
    for (const Section& section : sections()) {
        const bool is_name = name == section.description->name || name == section.prefix;
        if (is_name && *section.prefix != '\0') add(globals, class_text(section, screen));
    }
    return globals.empty() ? others : globals;
}

/// Lower case, with blanks for underscores: "dead zone" finds dead_zone.
std::string searchable(std::string_view text) {
    std::string result = text::lower(text);
    std::ranges::replace(result, '_', ' ');
    return result;
}

/// Lines about the entries that contain all of the words, first those with the words in their names.
std::string entries_that_mention(std::string_view wanted, const terminal::Display& screen) {
    constexpr std::size_t most = 10;
    const std::string words = searchable(wanted);
    std::vector<HelpEntry> in_name, elsewhere;
    for (const HelpEntry& entry : entries()) {
        const lua::Doc& doc = entry.member->doc;
        const std::string name = searchable(listed_name(*entry.section, *entry.member));
        std::string all = fmt::format("{} {} {}", name, signature(doc), doc.summary);
        for (const text::Call* call : calls_of(doc)) {
            for (const text::Option& option : call->options) all.append(" ").append(option.meaning);
        }
        const auto has_words = [&words](const std::string& text) {
            const std::vector<std::string_view> each = words_of(words);
            return std::ranges::all_of(each,
                                       [&text](std::string_view word) { return text.find(word) != std::string::npos; });
        };
        if (has_words(name)) {
            in_name.push_back(entry);
        } else if (has_words(searchable(all))) {
            elsewhere.push_back(entry);
        }
    }
    in_name.insert(in_name.end(), elsewhere.begin(), elsewhere.end());
    std::string text;
    for (std::size_t i = 0; i < std::min(most, in_name.size()); ++i) {
        const auto [section, member] = in_name[i];
        text += line_about(listed_name(*section, *member), member->doc.summary, screen);
    }
    if (in_name.size() > most) {
        text += fmt::format("  ... and {} more: use more of the word\n", in_name.size() - most);
    }
    return text;
}

/// The most similar name or option, otherwise the most similar longer word in the summaries.
std::string similar_name_hint(std::string_view word) {
    constexpr std::size_t shortest = 6;
    std::vector<std::string> names, words;
    for (const Section& section : sections()) names.emplace_back(section.description->name);
    for (const HelpEntry& entry : entries()) {
        const std::string whole = signature(entry.member->doc);
        for (const lua::Token& token : lua::tokens(whole)) {
            if (token.kind == lua::TokenKind::name) names.emplace_back(token.text);
        }
        for (const lua::Token& token : lua::tokens(entry.member->doc.summary)) {
            const bool longer = token.kind == lua::TokenKind::name && token.text.size() >= shortest;
            if (longer) words.push_back(text::lower(token.text));
        }
    }
    const std::string hint = text::did_you_mean(word, names);
    return hint.empty() ? text::did_you_mean(word, words) : hint;
}

/// The part of a name after the last separator, "energy" in run.energy; "" without one.
std::string_view last_name(std::string_view words) {
    const std::size_t separator = words.find_last_of(".:");
    return separator == std::string_view::npos ? "" : words.substr(separator + 1);
}

std::string nothing_found(std::string_view words) {
    std::string hint = similar_name_hint(words);
    if (hint.empty() && !last_name(words).empty()) hint = similar_name_hint(last_name(words));  // run.enrgy
    const std::string shown = text::quoted(words);  // control characters would steer the terminal
    return fmt::format("nothing about '{}'{}{}\n", shown.substr(1, shown.size() - 2), hint,
                       hint.empty() ? "; help \"contents\" lists what there is" : "");
}

std::string contents(const terminal::Display& screen) {
    std::string text;
    for (const Section& section : sections()) {
        std::vector<std::string> names;
        for (const lua::Member& member : section.description->members) {
            if (member.kind != lua::Kind::metamethod) names.push_back(written_name(section, member));
        }
        const std::size_t width = std::min(screen.width - 1, text::readable_width) - 2;
        text += fmt::format("{}{}\n  {}\n", text.empty() ? "" : "\n", section.title,
                            text::indented(text::wrapped(fmt::format("{}", fmt::join(names, ", ")), width), 2));
    }
    return text + "\nhelp \"name\" says more about each of them.\n";
}

/// Entries, options and mentions; empty without any.
std::string found_about(std::string_view words, const terminal::Display& screen) {
    std::string calls, options, last;
    each_option([&](const HelpEntry& entry, const OptionLine& line) {
        if (line.option != words) return;
        const std::string call = written_name(*entry.section, *entry.member);
        // A function that is called in two ways has the option twice.
        if (call != last) calls += (calls.empty() ? "" : ", ") + call;
        last = call;
        options += line_about(fmt::format("{}{{ {} }}", call, line.name), line.meaning, screen);
    });
    if (const std::string text = entries_named(words, screen); !text.empty()) {
        const std::size_t width = std::min<std::size_t>(screen.width, 80) - 1;
        return calls.empty() ? text : text + text::wrapped("An option of: " + calls, width) + "\n";
    }
    if (!options.empty()) return options;
    // The name may be the user's: help "rig:simulate", where rig is a variable.
    std::string text = last_name(words).empty() ? "" : entries_named(last_name(words), screen);
    return text.empty() ? entries_that_mention(words, screen) : text;
}

/// A question without common words: "how do I fit a record" becomes "fit record".
std::string without_small_words(std::string_view question) {
    constexpr std::string_view small =
        "how do i a an the to can is are of my for in what which why does you it make get";
    std::vector<std::string_view> rest;
    for (const std::string_view word : words_of(question)) {
        if (!has_word(small, text::lower(word))) rest.push_back(word);
    }
    return fmt::format("{}", fmt::join(rest, " "));
}

bool is_question(std::string_view words) {
    const std::vector<std::string_view> all = words_of(words);
    return all.size() > 1 && has_word("how what which why where can", text::lower(all.front()));
}

struct Topic {
    std::string_view words;  // words in lower case; one match is enough
    std::string_view text;
    std::string_view more = {};  // two matches are enough
};

// Lines have at most 77 columns. A test checks every name in these texts.
constexpr std::array<Topic, 52> topics = {{
    {"degrees degree deg radians radian angle angles",
     "Angles are in radians: theta, theta0, velocity per time unit. math.rad(90)\nmakes radians of 90 degrees, "
     "math.deg(x) degrees of radians, and of a whole\ncolumn 180/math.pi*run.theta. Lags are in radians as well.\n"},
    {"tutorial tour start lesson course",
     "help() is a tour of two minutes. docs/tutorial.md takes half an hour, the\nsheets in docs/lab are a course "
     "of seven afternoons, and the programs in\nexamples show one idea each.\n"},
    {"dinal1989 fortran 1989",
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
     "vector.normal and vector.random make random numbers with a seed, to add noise to\na record; identify finds "
     "a system from a noisy record, and fit.noise is the\nnoise it found. A noisy M is a table: "
     "excitation.samples.\n"},
    {"fit fitting regression estimate calibrate",
     "identify finds the system that made a record, with standard errors: identify{ data = load \"decay.csv\" }.\n"},
    {"matlab octave python numpy scipy simulink modelica",
     "docs/guide.md has a table for those who come from MATLAB or SciPy: indices\n"
     "begin at 1, options stand in braces, a power is x^2, and a vector v has its\n"
     "functions behind a colon: v:max(). Python reads what run:save \"run.csv\"\n"
     "writes.\n"},
    {"kernel jupyter notebook ipython",
     "dinal --jupyter-install, typed to a shell, makes a kernel for Jupyter:\n"
     "docs/notebook.md.\n"},
    {"safe sandbox",
     "dinal --safe runs the script of a stranger: it sees one folder, and --max-time\n"
     "and --max-memory limit what it takes: docs/safe-mode.md.\n"},
    {"fourier fft psd welch periodogram",
     "run:spectrum() returns frequencies and amplitudes, and\n"
     "run:spectrum{ of = \"velocity\", method = \"welch\" } a power density;\n"
     "run:spectrum():plot() draws it.\n",
     "frequency frequencies content analysis"},
    {"export pandas spreadsheet",
     "run:save \"run.csv\" writes a run, d:save \"d.csv\" data; run:columns{ \"t\", \"theta\" }\n"
     "chooses columns. pandas.read_csv(\"run.csv\", comment=\"#\") reads it\n"
     "(docs/csv-elsewhere.md).\n",
     "csv excel save write file disk results columns"},
    {"import excel semicolon separator delimiter xlsx",
     "load \"file.csv\" reads columns, or a run that run:save wrote, and\n"
     "excitation.samples \"force.csv\" an M. Columns are separated by commas, semicolons\n"
     "or tabs; with the last two 1,5 is a number. A line of units below the names is\n"
     "understood. Save a spreadsheet as CSV first.\n",
     "read load open csv file data record measurement measured decimal comma"},
    {"compare comparison overlay superimpose",
     "Keep both runs in variables, a and b, and plot both:\n"
     "plot{ { a.t, a.theta, label = \"a\" }, { b.t, b.theta, label = \"b\" } }.\n"
     "Numbers: a:at(1.5), a.theta:max(), (a.theta - b.theta):abs():max() on equal rows.\n",
     "two runs both several curves same one plot picture difference"},
    {"graph figure picture diagram svg png pdf latex",
     "run:plot() draws a run, plot{ { x, y } } vectors, d:plot() data. With\n"
     "file = \"a.svg\" (png, pdf, tex, gp) a plot goes into a file; xlabel, ylabel, title,\n"
     "xlim, ylim shape it.\n",
     "plot draw save file label axis axes title limits"},
    {"portrait", "run:phase_plot() draws velocity over theta, with the dead zone.\n", "phase plane space"},
    {"resonance frf bode",
     "sys:response{ over = { frequency = vector.linspace(.1, 2, 50) } } finds the steady\n"
     "amplitude for each frequency; :plot() draws it. sys:steady finds one.\n",
     "amplitude frequency response curve harmonic forced"},
    {"stationary",
     "sys:steady{ M = excitation.harmonic{ frequency = .4 } } finds the steady motion\n"
     "directly; run:steady() does from a run. s.amplitude, s.lag, s.stable describe it.\n",
     "steady state periodic motion amplitude"},
    {"squeal selfexcited self-excited",
     "sys:steady{ belt = .2 } finds the limit cycle, with s.period and s.amplitude;\n"
     "examples/250-belt-squeal.lua shows one.\n",
     "limit cycle belt stick-slip oscillation"},
    {"eigenfrequency eigenvalue natural modal modes campbell",
     "sys.omega0 and sys.T0 are the natural frequency and period without damping,\n"
     "sys.omega1 is the damped frequency. sys:modes has the frequencies and damping of several\n"
     "bodies or a sliding contact; docs/bodies.md plots them over a parameter.\n",
     "frequency frequencies period own mode shape damping parameter"},
    {"decrement dashpot",
     "C of system{} is viscous damping, sys.zeta the damping ratio, Rd dry friction.\n"
     "theory.logarithmic_decrement converts zeta; theory.identify finds both dampings\nfrom three extremes.\n",
     "viscous damping ratio zeta"},
    {"adhesion static stiction coulomb",
     "Rd is the torque of friction while the mass slides, Re (>= Rd) the largest torque\n"
     "that holds it at rest. run.events lists each stick and slip; friction.coulomb,\n"
     "friction.stribeck and friction.law give other laws.\n",
     "stick sticking stuck friction dry breakaway coefficient law"},
    {"accuracy accurate precise precision tolerance exactly",
     "The default integrator is accurate to rounding; integrator.spectral{ tolerance = 1e-9 }\nchanges it. dt "
     "only sets the rows. integrator.rk4{ h = .01 } has a step size.\n",
     "step size error steps integrator"},
    {"study studies grid parallel parametric",
     "sweep{ over = { Re = { .4, .5 } }, run = function(p) return { x = p.Re } end } runs all\n"
     "combinations, on all cores; docs/many-machines.md is about clusters.\n",
     "parameter parameters vary variation sweep many runs values loop"},
    {"optimise optimize optimisation optimization",
     "minimise{ over = { Re = { .1, 2 } }, run = function(p) return cost end } finds the least\n"
     "value; identify fits a system to a record.\n",
     "best minimum minimal least tune"},
    {"animate animation movie video",
     "run:animate{ file = \"motion.svg\" } writes the motion, which a browser plays.\n", "moving motion show"},
    {"controller pid feedback actuator",
     "M may depend on the motion: M = function(t, theta, velocity) return -2*theta end.\n"
     "excitation.sampled has a memory and a sampling time, excitation.relay switches,\n"
     "excitation.delayed has a dead time; states = { z = ... } integrates equations of your own.\n",
     "control loop integral memory state states delay relay"},
    {"hit kick hammer impulse",
     "excitation.pulse, excitation.half_sine and excitation.gaussian are pulses; an impulse is\n"
     "a velocity0.\n",
     "pulse short force shock"},
    {"bounce collision obstacle",
     "system{ walls = { lower = -1, upper = 1, restitution = .5 } } bounces at walls; impacts are\n"
     "events of the run.\n",
     "wall walls gap impact impacts restitution"},
    {"multibody coupled clutch gear gearbox planetary brake pulley ratchet isolator blade machine masses",
     "system{ bodies = { ... }, links = { ... } } has several bodies: docs/bodies.md shows nine machines.\n",
     "two several bodies mass chain degrees freedom"},
    {"measured measurement",
     "M from a table: excitation.samples{ t = { 0, 1 }, M = { 0, 2 } } or excitation.samples \"force.csv\".\n"
     "A measured motion: identify{ data = load \"decay.csv\" } finds the system.\n",
     "table samples force file csv record data"},
    {"dimension dimensions si newton",
     "Any consistent units: units of a system name them, system{ ..., units = { theta = \"rad\" } }, and\n"
     "plots and files show them. nondimensional{} counts in T0 and Mc/k.\n",
     "unit units metre kg"},
    {"abort cancel endless hang hangs interrupt",
     "Ctrl-C stops a run or a loop; dinal.partial then holds the rows so far.\n", "stop running loop run"},
    {"slow performance benchmark faster",
     "A Lua function that is a formula is read and costs nothing extra: run:explain() says\n"
     "whether M was read. Native terms (excitation.harmonic) are fastest; sweep uses all cores.\n",
     "fast speed time takes long"},
    {"homework assignment submit marks grade sheet",
     "lab.number(4711), lab.given(1) and check(\"1a\", 3.2) are the course; docs/lab has its sheets.\n"
     "dinal --report 1-4711.lua, in a shell, makes the page to hand in.\n",
     "lab hand in report page course number answer make"},
    {"chaos chaotic feigenbaum",
     "bifurcation{ over = ..., at = ... } draws how the steady motion changes with a parameter;\n"
     "run:poincare{ period = 1 } cuts a run once a period.\n",
     "poincare section map bifurcation period doubling"},
    {"dissipation dissipated work losses",
     "run:energy() returns where the energy went: its total, and each half cycle.\n", "energy loss lost power"},
    {"story describe", "run:explain() tells a run in words: turns, sticking, what stopped it.\n",
     "explain words happened happens why run"},
    {"seed reproducible", "vector.random{ n = 100, seed = 1 } and sweep{ ..., seed = 1 } repeat the same numbers.\n",
     "random same numbers"},
    {"history undo commands",
     ":history lists what was typed, :edit changes the last input in an editor, :save lab.lua\n"
     "writes what ran without error into a script.\n",
     "session save typed previous line"},
    {"settings options arguments",
     "help \"simulate\" lists the options of a call with their defaults; Shift-Tab shows them\n"
     "while you type.\n",
     "which list"},
    {"ode45 solve_ivp odeint lsim ode integrate solver",
     "sys:simulate{ M = M, theta0 = 1, t_end = 20 } makes a run; no tolerance and no event\n"
     "function is needed. docs/guide.md has a table of what MATLAB and SciPy call it.\n"},
    {"initial",
     "theta0 and velocity0 of sys:simulate{ theta0 = 1, velocity0 = 0, t_end = 20 } are the state\n"
     "at t_start; run:continue{ t_end = 40 } begins where a run ended.\n",
     "start condition conditions position velocity value values"},
    {"conveyor",
     "sys:simulate{ belt = .2, t_end = 20 } lets the mass rub on a belt of that velocity, and\n"
     "sys:steady{ belt = .2 } finds its limit cycle; belt may be a function of t.\n",
     "belt moving speed run"},
    {"square rectangular",
     "excitation.square{ amplitude = 1, period = 2 } is a square wave; excitation.sawtooth and\n"
     "excitation.triangle are others.\n",
     "wave periodic pulse train"},
    {"heaviside",
     "excitation.step{ amplitude = 1, at = 0 } is a step:\n"
     "sys:simulate{ M = excitation.step{ amplitude = 1 }, t_end = 20 }:plot().\n",
     "step response jump load sudden"},
    {"zoom legend",
     "plot and run:plot have xlim = { 2, 3 } and ylim to show a part, label for the name of a\n"
     "curve: plot{ { x, y, label = \"a\" }, xlim = { 2, 3 } }.\n",
     "range part axis curve name label"},
    {"maximum average rms",
     "A column is a vector: run.theta:max(), :min(), :mean(), :abs(); run.theta[run.t > 10]:max()\n"
     "of a part.\n",
     "max min mean value column peak largest"},
    {"turning",
     "run.events lists turns, sticks, slips and rest: run.events[1].t, #run.events, and the\n"
     "last one is run.events[#run.events]; run.events.kind is a column.\n",
     "list events event last first count number stops turns when"},
    {"quit exit leave", "Ctrl-D or :quit leaves dinal; os.exit() ends a script.\n", "close program"},
    {"shell ls cd pwd dir folder terminal",
     ":ls lists the files of the current folder, :cd folder changes it, :pwd shows it; Ctrl-Z\n"
     "suspends dinal, and fg brings it back. load and excitation.samples read files.\n"},
}};

/// Words of other languages with their English translations.
constexpr std::array<std::pair<std::string_view, std::string_view>, 24> foreign = {{
    {"reibung rozamiento friccion fricción frottement attrito", "friction"},
    {"feder muelle resorte ressort molla", "spring"},
    {"daempfung dämpfung amortiguamiento amortissement smorzamento", "damping"},
    {"schwinger oscilador oscillateur oscillatore sistema système", "system"},
    {"erregung anregung excitacion excitación eccitazione", "excitation"},
    {"resonanz resonancia résonance risonanza", "resonance"},
    {"energie energía energia énergie", "energy"},
    {"hilfe ayuda aide aiuto", "help"},
    {"giro giros", "turn"},
    {"adherencia adherido pegado", "stick"},
    {"despegue", "breakaway"},
    {"reposo parada paradas", "rest"},
    {"zona-muerta", "dead zone"},
    {"corrida simular simulación simulacion", "simulate"},
    {"período periodo", "period"},
    {"figura gráfico grafico dibujar", "plot"},
    {"guardar", "save"},
    {"salir", "quit"},
    {"embrague acoplamiento", "clutch"},
    {"engranaje engranajes", "gear"},
    {"archivo archivos", "file"},
    {"amplitud", "amplitude"},
    {"frecuencia", "frequency"},
    {"evento eventos", "events"},
}};

/// Translates words of other languages, such as Reibung to friction; others stay.
std::string in_english(std::string_view words) {
    const auto translated = [](std::string_view word) {
        std::string wanted = text::lower(word);
        std::ranges::replace(wanted, ' ', '-');
        const auto* const found =
            std::ranges::find_if(foreign, [&](const auto& row) { return has_word(row.first, wanted); });
        return found == foreign.end() ? word : found->second;
    };
    if (const std::string_view whole = translated(words); whole != words) return std::string(whole);
    std::vector<std::string_view> english = words_of(words);
    std::ranges::transform(english, english.begin(), translated);
    return fmt::format("{}", fmt::join(english, " "));
}

/// Some lines about the topic that shares most words, ignoring case; empty if there is none.
std::string_view topic(std::string_view words) {
    const std::string wanted = text::lower(words);
    std::string_view best;
    int most = 1;
    for (const Topic& one : topics) {
        int fits = 0;
        for (const std::string_view word : words_of(wanted)) {
            fits += has_word(one.words, word) ? 2 : has_word(one.more, word) ? 1 : 0;
        }
        if (fits > most) best = one.text;
        most = std::max(most, fits);
    }
    return best;
}

}  // namespace

std::vector<std::string> help_names() {
    std::vector<std::string> names = {"contents"};
    for (const Section& section : sections()) {
        if (*section.prefix != '\0') names.emplace_back(section.description->name);
    }
    for (const auto& [section, member] : entries()) {
        if (member->kind == lua::Kind::metamethod) continue;
        names.push_back(written_name(*section, *member));
        names.emplace_back(member->name);
    }
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

std::vector<std::string> help_option_names() {
    std::vector<std::string> names;
    each_option([&names](const HelpEntry& /*entry*/, const OptionLine& line) { names.push_back(line.option); });
    return names;
}

std::string help_about(std::string_view words, const terminal::Display& screen) {
    const std::string english = in_english(text::trimmed(words, " "));
    words = english;
    if (words == "contents") return contents(screen);
    if (std::string word = lua_word(words); !word.empty()) {
        const std::string named = entries_named(words, screen);
        return word + (named.empty() ? "" : "\n") + named;
    }
    const std::string rest = without_small_words(words);
    std::string about(topic(rest.empty() ? words : rest));
    if (about.empty()) about = lua_word(rest);
    std::string found = is_question(words) ? "" : found_about(words, screen);
    if (found.empty() && !rest.empty()) found = found_about(rest, screen);
    for (const std::string_view word : words_of(rest)) {
        if (about.empty() && found.empty()) about = lua_word(word);
    }
    if (about.empty() && found.empty()) return nothing_found(rest.empty() ? words : rest);
    return about + (about.empty() || found.empty() ? "" : "\n") + found;
}

}  // namespace dinal::help
