
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "help/help_text.hpp"
#include "help/library.hpp"
#include "text/version.hpp"
#include "text/words.hpp"

namespace dinal::help {

namespace {

/// The anchor of a heading, as GitHub forms it.
std::string anchor(std::string_view title) {
    std::string place;
    for (const char c : text::lower(title)) {
        if (text::is_name_char(c) || c == '-') place += c;
        if (c == ' ') place += '-';
    }
    return place;
}

struct Page {
    std::string_view name, title;
    std::vector<std::string_view> sections;
};

const std::vector<Page>& manual_pages() {
    static const std::vector<Page> all{
        {"systems",
         "systems, friction, springs",
         {"Systems", "A system", "A system of several bodies", "Laws of friction", "A law of friction", "Springs",
          "A spring"}},
        {"excitations", "excitations", {"Excitations", "An excitation"}},
        {"runs", "runs", {"Integrators", "An integrator", "A run", "The energy of a run", "Files"}},
        {"questions",
         "steady motions, sweeps, identification",
         {"A steady motion", "Identification", "A fit", "Sweeps"}},
        {"theory", "closed forms", {"Theory"}},
        {"data", "vectors and data", {"Vectors", "A vector", "Data", "Named columns"}},
        {"pictures", "pictures and reports", {"Plots", "A picture", "Reports", "A report", "Progress"}},
        {"program", "the lab, help, the table dinal", {}},  // and everything that no other page has
    };
    return all;
}

const Page& page_of(const Section& section) {
    const auto has = [&section](const Page& topic) { return text::contains(topic.sections, section.title); };
    const auto found = std::find_if(manual_pages().begin(), manual_pages().end(), has);
    return found == manual_pages().end() ? manual_pages().back() : *found;
}

/// A picture in the documents that shows what a function draws.
struct Drawing {
    std::string_view name, file, words;
};
constexpr Drawing drawings[] = {
    {"run:plot", "pictures/stick-slip.svg",
     "A block pulled through a spring: the load rises evenly to 0.04 m in 4 s, the angle in four steps of 0.0083 m; bars "
     "show when it sticks"},
    {"run:phase_plot", "report/fig22.svg",
     "Left, the angle swings twice and rests at 0.15 from t = 1.7 on, while friction jumps between -0.17 and 0.17; right, "
     "the phase plane: half circles that end in the dead zone"},
    {"sys:response", "pictures/resonance.svg",
     "Left, a load that friction holds: the true block stays at 0, that with tanh creeps to 0.47; right, a resonance that "
     "leans over, with two folds"},
    {"d:plot", "pictures/map.svg",
     "A map: colours from blue, 0.15, to yellow, 0.43, for the amplitude over C and speed; hatched where nothing moves, "
     "above a line of folds; a dashed line of Hopf points below it"},
};

/// Removes the limits of a number, which error messages state: "(s, must be positive)" becomes "(s)".
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

/// The meaning of an option without its default and "needed", which differ between calls such as system and sys:with.
std::string sense(const OptionLine& line) {
    std::string meaning = without_limits(line.meaning);
    const std::size_t needed = meaning.rfind("needed)");
    if (needed != std::string::npos && needed + 7 == meaning.size())
        meaning = meaning[needed - 1] == '(' ? meaning.substr(0, needed - 1) : meaning.substr(0, needed - 2) + ")";
    return fmt::format("{}: {}", line.option, meaning);
}

/// An option with the number of calls that have it in the same sense.
struct Listed {
    std::string sense, words;  ///< the words of the first of these calls
    std::string_view name;
    int calls = 1;
};

std::vector<Listed> listed_options() {
    std::vector<Listed> all;
    for (const Section& section : sections()) {
        for (const lua::Member& member : section.description->members) {
            for (const text::Call* call : calls_of(member.doc)) {
                for (const OptionLine& line : option_lines(call->options)) {
                    const auto known = std::ranges::find(all, sense(line), &Listed::sense);
                    if (known == all.end()) {
                        all.push_back({sense(line), listed(line), line.option});
                    } else {
                        ++known->calls;
                    }
                }
            }
        }
    }
    return all;
}

/// The options that several calls have in the same sense, in the order of their first appearance. Short ones are shared
/// only by three or more calls, and only if no other shared option has the same name, because reading them is quicker
/// than looking them up.
std::vector<Listed> shared_options() {
    const std::vector<Listed> all = listed_options();
    const auto is_long = [](const Listed& each) { return each.calls > 1 && each.words.size() >= 40; };
    const auto is_short = [](const Listed& each) { return each.calls > 2 && each.words.size() < 40; };
    std::vector<Listed> shared;
    for (const Listed& each : all) {
        const auto has_the_name = [&](const Listed& other) {
            return &other != &each && other.name == each.name && (is_long(other) || is_short(other));
        };
        if (is_long(each) || (is_short(each) && std::ranges::none_of(all, has_the_name))) shared.push_back(each);
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

/// Writes entries. Pages omit options in `shared`, and have one example for each section.
struct Writer {
    std::string text;
    bool all = false;  ///< whether every entry is complete, with its example
    std::vector<Listed> shared = {};

    void options(const text::Call& call) {
        std::string elsewhere;
        for (const OptionLine& line : option_lines(call.options)) {
            const bool is_shared =
                std::ranges::any_of(shared, [&line](const Listed& each) { return each.sense == sense(line); });
            if (is_shared) {
                elsewhere += fmt::format("{}`{}`", elsewhere.empty() ? "" : ", ", line.option);
            } else {
                text += listed(line);
            }
        }
        if (!elsewhere.empty())
            text += fmt::format("- [shared](../manual.md#options-of-several-calls): {}\n", elsewhere);
        if (!call.options.empty()) text += "\n";
    }
    void example(const lua::Doc& doc) { text += fmt::format("```lua\n{}\n```\n", doc.example); }
    void entry(const lua::Doc& doc) {
        const std::string call = all ? signature(doc) : doc.signature;
        text += fmt::format("`{}`\n\n{}\n\n", call, doc.summary);
        for (const text::Call* each : calls_of(doc)) options(*each);
    }
    void row(const lua::Doc& doc) {
        std::string summary = doc.summary;
        std::ranges::replace(summary, '\n', ' ');
        text += fmt::format("- `{}`: {}\n", signature(doc), summary);
    }
    void section(const Section& section) {
        text += fmt::format("\n## {}\n\n", section.title);
        entry(section.description->doc);
        example(section.description->doc);
        const auto in_list = [this](const lua::Member& member) {
            return !shared.empty() && calls_of(member.doc).empty();
        };
        bool any = false;
        for (const lua::Member& member : section.description->members) {
            // tostring of each object is described on the first page.
            if (!in_list(member) || std::string_view(member.doc.signature).starts_with("tostring(")) continue;
            if (!any) text += "\n";
            any = true;
            row(member.doc);
        }
        for (const lua::Member& member : section.description->members) {
            if (in_list(member)) continue;
            text += fmt::format("\n### {}\n\n", listed_name(section, member));
            entry(member.doc);
            if (all) example(member.doc);
            if (!all) picture_of(listed_name(section, member));
        }
    }
    void picture_of(std::string_view name) {
        for (const Drawing& drawing : drawings) {
            if (drawing.name == name) text += fmt::format("![{}](../{})\n", drawing.words, drawing.file);
        }
    }
};

/// All names of a section, each linked to its place.
std::string index_of(const Section& section, const Page& topic) {
    std::string text = fmt::format("[{}](manual/{}.md#{}):", section.title, topic.name, anchor(section.title));
    for (const lua::Member& member : section.description->members) {
        if (member.kind == lua::Kind::metamethod) continue;
        const std::string name = listed_name(section, member);
        text += calls_of(member.doc).empty() ? fmt::format(" {},", name)
                                             : fmt::format(" [{}](manual/{}.md#{}),", name, topic.name, anchor(name));
    }
    text.back() = '.';
    return text;
}

std::string index_page() {
    std::string text = fmt::format(
        "# dinal {}: manual of the Lua API\n\nAll names, by topic. At the prompt `help(x)` prints the entry of x with an "
        "example and all limits. Everything is in the table `dinal`, and its members are globals as well. Options are "
        "named; an unknown one is an error. Objects cannot be changed; print shows each as text. In the examples `-->` is followed by what the line "
        "prints.\n",
        DINAL_VERSION);
    for (const Page& topic : manual_pages()) {
        text += fmt::format("\n**[{}](manual/{}.md)**\n\n", topic.title, topic.name);
        for (const Section& section : sections()) {
            if (&page_of(section) == &topic) text += fmt::format("- {}\n", index_of(section, topic));
        }
    }
    text += "\n| task | look at |\n|---|---|\n";
    for (const Task& task : tasks) text += fmt::format("| {} | {} |\n", task.task, task.names);
    text += "\n## Options of several calls\n\n`help(x)` has the default of each call, and what it needs.\n\n";
    for (const Listed& each : shared_options()) text += each.words;
    return text + "\nNext: [limits](limits.md).\n";
}

std::string text_of_page(const Page& topic) {
    Writer writer{.text = fmt::format("# Manual: {}\n\n[All topics and names](../manual.md).\n", topic.title),
                  .shared = shared_options()};
    for (const Section& section : sections()) {
        if (&page_of(section) == &topic) writer.section(section);
    }
    return std::move(writer.text);
}

}  // namespace

text::Expected<std::string> manual(std::string_view page) {
    if (page.empty()) return index_page();
    if (page == "all") {
        Writer writer{.text = "# Every entry\n", .all = true};
        for (const Section& section : sections()) writer.section(section);
        return std::move(writer.text);
    }
    std::vector<std::string_view> names;
    for (const Page& topic : manual_pages()) {
        if (topic.name == page) return text_of_page(topic);
        names.push_back(topic.name);
    }
    return text::error("the manual has no page '{}': the pages are {} and all", page, fmt::join(names, ", "));
}

}  // namespace dinal::help
