#include "lua/manual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "io/screen.hpp"
#include "lua/lua_text.hpp"

namespace dinal {

namespace {

// A terminal over ssh has 80 columns.
constexpr std::size_t text_width = 79;

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

std::string first_sentence(std::string_view summary) {
    for (std::size_t stop = summary.find(". "); stop != std::string_view::npos; stop = summary.find(". ", stop + 1)) {
        return std::string(summary.substr(0, stop + 1));
    }
    return std::string(summary);
}

std::string indented(std::string_view text) {
    std::string result = "    ";
    for (const char c : text) {
        result += c;
        if (c == '\n') {
            result += "    ";
        }
    }
    return result;
}

std::string doc_text(const Doc& doc) {
    return fmt::format("{}\n\n{}\n\n{}\n", doc.signature, wrapped(doc.summary, text_width), indented(doc.example));
}

std::string listed_name(const Section& section, const Member& member) {
    if (member.kind == Kind::metamethod) {
        const std::string_view signature = member.doc.signature;
        return std::string(signature.substr(0, signature.find(" ->")));
    }
    return written_name(section, member);
}

struct Hit {
    const Section* section;
    const Member* member;  // none: the section itself
};

std::string hit_text(const Hit& hit) {
    return hit.member != nullptr ? member_text(*hit.section, *hit.member) : class_text(*hit.section);
}

// A user may write sys.simulate, sys:simulate, system:simulate or simulate.
bool has_name(const Section& section, const Member& member, std::string_view name) {
    if (member.kind == Kind::metamethod) {
        return false;
    }
    const std::size_t separator = name.find_last_of(".:");
    if (separator == std::string_view::npos) {
        return name == member.name;
    }
    const std::string_view owner = name.substr(0, separator);
    return name.substr(separator + 1) == member.name &&
           (owner == section.prefix || owner == section.description->name ||
            (owner == "dinal" && *section.prefix == '\0'));
}

/// Globals first: `excitation` is the module and its class, although run.excitation is a field, too.
std::vector<Hit> named(std::string_view name) {
    std::vector<Hit> globals;
    std::vector<Hit> others;
    for (const Section& section : sections()) {
        const bool is_function_table = *section.prefix == '\0';
        for (const Member& member : section.description->members) {
            if (has_name(section, member, name)) {
                (is_function_table ? globals : others).push_back({&section, &member});
            }
        }
        if (!is_function_table && name == section.description->name) {
            globals.push_back({&section, nullptr});
        }
    }
    return globals.empty() ? others : globals;
}

/// Lower case, and dead_zone is found as "dead zone".
std::string searchable(std::string_view text) {
    std::string result = lower(text);
    std::replace(result.begin(), result.end(), '_', ' ');
    return result;
}

/// Does every word stand somewhere in the text?
bool has_words(const std::string& text, std::string_view words) {
    const std::string wanted = searchable(words);
    for (std::size_t at = 0; at < wanted.size();) {
        const std::size_t end = std::min(wanted.find(' ', at), wanted.size());
        if (text.find(wanted.substr(at, end - at)) == std::string::npos) {
            return false;
        }
        at = end + 1;
    }
    return true;
}

/// Those with the words in their names first.
std::vector<Hit> mentioning(std::string_view words) {
    std::vector<Hit> in_name;
    std::vector<Hit> elsewhere;
    for (const Section& section : sections()) {
        for (const Member& member : section.description->members) {
            const std::string name = searchable(listed_name(section, member));
            if (has_words(name, words)) {
                in_name.push_back({&section, &member});
            } else if (has_words(searchable(fmt::format("{} {} {}", name, member.doc.signature, member.doc.summary)),
                                 words)) {
                elsewhere.push_back({&section, &member});
            }
        }
    }
    in_name.insert(in_name.end(), elsewhere.begin(), elsewhere.end());
    return in_name;
}

std::string line_about(const Hit& hit) {
    constexpr std::size_t indent = 28;
    std::string text = wrapped(first_sentence(hit.member->doc.summary), text_width - indent);
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
        text.insert(at + 1, indent, ' ');
    }
    return fmt::format("  {:<{}} {}\n", listed_name(*hit.section, *hit.member), indent - 3, text);
}

std::string no_help(std::string_view words) {
    std::vector<std::string> known;  // names, and the options in signatures
    for (const Section& section : sections()) {
        known.emplace_back(section.description->name);
        for (const Member& member : section.description->members) {
            for (std::string& name : free_names(member.doc.signature)) {
                known.push_back(std::move(name));
            }
            if (member.kind != Kind::metamethod) {
                known.emplace_back(member.name);
            }
        }
    }
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    const std::vector<std::string_view> names(known.begin(), known.end());
    return fmt::format("nothing about '{}'{}; help() shows where to begin\n", words, did_you_mean(words, names));
}

}  // namespace

std::string written_name(const Section& section, const Member& member) {
    const std::string_view prefix = section.prefix;
    const std::string_view separator = prefix.empty() ? "" : member.kind == Kind::method ? ":" : ".";
    return fmt::format("{}{}{}", prefix, separator, member.name);
}

std::string member_text(const Section&, const Member& member) {
    return doc_text(member.doc);
}

std::string class_text(const Section& section) {
    std::string text = doc_text(section.description->doc) + "\n";
    for (const Member& member : section.description->members) {
        text += line_about({&section, &member});
    }
    return text;
}

std::string help_about(std::string_view words) {
    constexpr std::size_t most = 10;
    while (!words.empty() && words.back() == ' ') words.remove_suffix(1);
    while (!words.empty() && words.front() == ' ') words.remove_prefix(1);
    if (words.empty()) {
        return start_page();
    }
    std::string text;
    for (const Hit& hit : named(words)) {
        text += (text.empty() ? "" : "\n") + hit_text(hit);
    }
    if (!text.empty()) {
        return text;
    }
    const std::vector<Hit> hits = mentioning(words);
    if (hits.empty()) {
        return no_help(words);
    }
    for (std::size_t i = 0; i < std::min(most, hits.size()); ++i) {
        text += line_about(hits[i]);
    }
    if (hits.size() > most) {
        text += fmt::format("  ... and {} more: use more of the word\n", hits.size() - most);
    }
    return text;
}

std::string start_page() {
    std::string text =
        "A laboratory for oscillators with dry friction: make a system, excite it,\n"
        "look at the run.\n\n"
        "    sys = system{ I = 1, k = 4*math.pi^2, C = 1.5, Rd = 16.5, Re = 18 }\n"
        "    M = function(t) return 30*math.sin(6*t) end\n"
        "    run = sys:simulate{ M = M, t_end = 20, dt = 0.01 }\n"
        "    print(run)          -- a summary; run.t, run.theta, run.events, run:at(3.2)\n"
        "    run:save(\"run.csv\")\n\n"
        "More about a function, a word, a module:\n\n"
        "    help(sys.simulate), help \"theta0\", help(excitation)\n\n";
    for (const Section& section : sections()) {
        text += fmt::format("  {:<22} {}\n", section.title, section.description->doc.signature);
    }
    return text;
}

std::string manual() {
    std::string text = fmt::format(
        "# dinal {}: manual of the Lua API\n\n"
        "This page is what `dinal --manual` prints; at the prompt `help(x)` prints the same, one entry at a time. "
        "Everything "
        "lives in the table `dinal`, and its members are plain globals, too. Options are named; an unknown one is an "
        "error. "
        "In the examples `-->` is followed by what the line prints.\n\n",
        DINAL_VERSION);
    for (const Section& section : sections()) {
        text += fmt::format("- [{}](#{})\n", section.title, [&] {
            std::string anchor = lower(section.title);
            std::replace(anchor.begin(), anchor.end(), ' ', '-');
            return anchor;
        }());
    }
    const auto entry = [&text](const Doc& doc) {
        text += fmt::format("`{}`\n\n{}\n\n```lua\n{}\n```\n", doc.signature, doc.summary, doc.example);
    };
    for (const Section& section : sections()) {
        text += fmt::format("\n## {}\n\n", section.title);
        entry(section.description->doc);
        for (const Member& member : section.description->members) {
            text += fmt::format("\n### {}\n\n", listed_name(section, member));
            entry(member.doc);
        }
    }
    return text;
}

}  // namespace dinal
