#include "help/manual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "help/help_text.hpp"
#include "help/signature.hpp"
#include "text/version.hpp"
#include "text/words.hpp"

namespace dinal::help {

namespace {

std::string anchor(std::string_view title) {
    std::string text = text::lower(title);
    std::replace(text.begin(), text.end(), ' ', '-');
    return text;
}

/// Without the limits of a number, which an error states: "(s, must be positive)" becomes "(s)".
std::string without_limits(std::string meaning) {
    const std::size_t must = meaning.rfind("must ");
    if (must == std::string::npos || !meaning.ends_with(")") || must < 2) return meaning;
    const std::size_t end = std::min(meaning.find(", ", must), meaning.size() - 1);
    if (meaning[must - 1] == '(' && end == meaning.size() - 1) return meaning.substr(0, must - 2);
    if (meaning[must - 1] == '(') return meaning.erase(must, end + 2 - must);
    if (meaning[must - 2] != ',') return meaning;
    return meaning.erase(must - 2, end - (must - 2));
}

std::string listed(const OptionLine& line) {
    return fmt::format("- `{}`: {}\n", line.name, without_limits(line.meaning));
}

/// The options that stand with the same words in several calls, in the order in which they come first.
std::vector<std::string> shared_options() {
    constexpr std::size_t least = 40;  // what is shorter is read more quickly than looked for
    std::vector<std::string> once, shared;
    for (const Section& section : sections()) {
        for (const lua::Member& member : section.description->members) {
            for (const text::Call* call : calls_of(member.doc)) {
                for (const OptionLine& line : option_lines(call->options)) {
                    const std::string words = listed(line);
                    const auto has = [&words](const std::vector<std::string>& list) {
                        return std::find(list.begin(), list.end(), words) != list.end();
                    };
                    if (words.size() < least || has(shared)) continue;
                    (has(once) ? shared : once).push_back(words);
                }
            }
        }
    }
    return shared;
}

struct Task {
    const char *task, *names;
};
constexpr Task tasks[] = {
    {"describe a system", "system, nondimensional, sys:with, friction, spring"},
    {"describe M(t)", "excitation, a Lua function, excitation.samples for a table or file"},
    {"run it and look", "sys:simulate, run:plot, run.events, run:at, run:explain"},
    {"several bodies", "system{ bodies, links }, sys:simulate, sys:steady, run.load"},
    {"a controller", "states, excitation.sampled, excitation.relay, excitation.delayed"},
    {"a steady motion or limit cycle", "sys:steady, run:cycle, run:poincare"},
    {"a response curve", "sys:response, theory.den_hartog, theory.linearised"},
    {"find parameters from a record", "identify, load"},
    {"many runs", "sweep, bifurcation, minimise"},
    {"energy and frequencies", "run:energy, run:spectrum"},
    {"files and reports", "run:save, load, d:save, report"},
    {"pictures", "plot, run:plot, d:plot, run:phase_plot, run:animate"},
};

/// Writes entries; the page has no options that stand in `shared`, and an example for each section only.
struct Writer {
    std::string text;
    Extent extent = Extent::page;
    std::vector<std::string> shared;

    void options(const text::Call& call) {
        std::string elsewhere;
        for (const OptionLine& line : option_lines(call.options)) {
            if (std::find(shared.begin(), shared.end(), listed(line)) == shared.end()) {
                text += listed(line);
            } else {
                elsewhere += fmt::format("{}`{}`", elsewhere.empty() ? "" : ", ", line.option);
            }
        }
        if (!elsewhere.empty()) text += fmt::format("- [shared](#options-of-several-calls): {}\n", elsewhere);
        if (!call.options.empty()) text += "\n";
    }
    void example(const lua::Doc& doc) { text += fmt::format("```lua\n{}\n```\n", doc.example); }
    void entry(const lua::Doc& doc) {
        const std::string call = extent == Extent::page ? doc.signature : signature(doc);
        text += fmt::format("`{}`\n\n{}\n\n", call, doc.summary);
        for (const text::Call* each : calls_of(doc)) options(*each);
    }
    void row(const lua::Doc& doc) {
        std::string summary = doc.summary;
        for (std::size_t at = summary.find_first_of("|\n"); at != std::string::npos;
             at = summary.find_first_of("|\n", at + 2)) {
            summary.replace(at, 1, summary[at] == '|' ? "\\|" : " ");
        }
        text += fmt::format("| `{}` | {} |\n", signature(doc), summary);
    }
    void section(const Section& section) {
        text += fmt::format("\n## {}\n\n", section.title);
        entry(section.description->doc);
        example(section.description->doc);
        const auto in_table = [this](const lua::Member& member) {
            return !shared.empty() && calls_of(member.doc).empty();
        };
        bool table = false;
        for (const lua::Member& member : section.description->members) {
            if (!in_table(member)) continue;
            if (!table) text += "\n| | |\n|---|---|\n";
            table = true;
            row(member.doc);
        }
        for (const lua::Member& member : section.description->members) {
            if (in_table(member)) continue;
            text += fmt::format("\n### {}\n\n", listed_name(section, member));
            entry(member.doc);
            if (extent == Extent::all) example(member.doc);
        }
    }
};

}  // namespace

std::string manual(Extent extent) {
    Writer writer;
    writer.text = fmt::format(
        "# dinal {}: manual of the Lua API\n\n"
        "`dinal --manual` prints this page; at the prompt `help(x)` prints the entry of x with an example and all limits. "
        "Everything is in the table `dinal`, and its members are globals as well. "
        "Options are named; an unknown one is an error. Objects cannot be changed. "
        "In the examples `-->` is followed by what the line prints.\n\n",
        DINAL_VERSION);
    writer.extent = extent;
    if (extent == Extent::page) {
        writer.shared = shared_options();
        writer.text += "| task | look at |\n|---|---|\n";
        for (const Task& task : tasks) writer.text += fmt::format("| {} | {} |\n", task.task, task.names);
        writer.text += "\n- [Options of several calls](#options-of-several-calls)\n";
    }
    for (const Section& section : sections()) {
        writer.text += fmt::format("- [{}](#{})\n", section.title, anchor(section.title));
    }
    if (extent == Extent::page) {
        writer.text += fmt::format("\n## Options of several calls\n\n{}", fmt::join(writer.shared, ""));
    }
    for (const Section& section : sections()) writer.section(section);
    if (extent == Extent::page) writer.text += "\nNext: [limits](limits.md).\n";
    return std::move(writer.text);
}

}  // namespace dinal::help
