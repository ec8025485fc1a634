// Which entries belong to a name or to words that somebody asks help() about.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "help/help_text.hpp"
#include "help/lua_words.hpp"
#include "help/signature.hpp"
#include "help/topics.hpp"
#include "lua/tokens.hpp"
#include "text/characters.hpp"
#include "text/suggest.hpp"
#include "text/words.hpp"

namespace dinal::help {

namespace {

struct Hit {
    const Section* section;
    const lua::Member* member;  // none: the section itself
};

std::string hit_text(const Hit& hit, const terminal::Display& screen) {
    return hit.member != nullptr ? member_text(*hit.section, *hit.member, screen) : class_text(*hit.section, screen);
}

std::string hit_line(const Hit& hit, const terminal::Display& screen) {
    return line_about(listed_name(*hit.section, *hit.member), hit.member->doc.summary, screen);
}

// A user may write sys.simulate, sys:simulate, system:simulate or simulate.
bool has_name(const Section& section, const lua::Member& member, std::string_view name) {
    if (member.kind == lua::Kind::metamethod) {
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
        for (const lua::Member& member : section.description->members) {
            if (has_name(section, member, name)) {
                (is_function_table ? globals : others).push_back({&section, &member});
            }
        }
        if (!is_function_table && (name == section.description->name || name == section.prefix)) {
            globals.push_back({&section, nullptr});
        }
    }
    return globals.empty() ? others : globals;
}

/// Lower case, and dead_zone is found as "dead zone".
std::string searchable(std::string_view text) {
    std::string result = text::lower(text);
    std::replace(result.begin(), result.end(), '_', ' ');
    return result;
}

/// Does every word stand somewhere in the text? Both are searchable().
bool has_words(const std::string& text, const std::string& wanted) {
    for (std::size_t at = 0; at < wanted.size();) {
        const std::size_t end = std::min(wanted.find(' ', at), wanted.size());
        if (text.find(wanted.substr(at, end - at)) == std::string::npos) {
            return false;
        }
        at = end + 1;
    }
    return true;
}

std::string option_meanings(const lua::Doc& doc) {
    std::string text;
    for (const text::Call* call : calls_of(doc)) {
        for (const text::Option& option : call->options) text.append(option.meaning).append(" ");
    }
    return text;
}

/// What `one` says about each call that has an option of this name.
template <class One>
std::string about_option(std::string_view name, const One& one) {
    std::string text;
    for (const Section& section : sections()) {
        for (const lua::Member& member : section.description->members) {
            for (const text::Call* call : calls_of(member.doc)) {
                for (const OptionLine& line : option_lines(call->options)) {
                    text += line.option == name ? one(written_name(section, member), line) : "";
                }
            }
        }
    }
    return text;
}

/// Those with the words in their names first.
std::vector<Hit> mentioning(std::string_view words) {
    std::vector<Hit> in_name;
    std::vector<Hit> elsewhere;
    const std::string wanted = searchable(words);
    for (const Section& section : sections()) {
        for (const lua::Member& member : section.description->members) {
            const std::string name = searchable(listed_name(section, member));
            if (has_words(name, wanted)) {
                in_name.push_back({&section, &member});
            } else if (has_words(searchable(fmt::format("{} {} {} {}", name, signature(member.doc), member.doc.summary,
                                                        option_meanings(member.doc))),
                                 wanted)) {
                elsewhere.push_back({&section, &member});
            }
        }
    }
    in_name.insert(in_name.end(), elsewhere.begin(), elsewhere.end());
    return in_name;
}

std::string likely(std::string_view word, const std::vector<std::string>& known) {
    const std::vector<std::string_view> views(known.begin(), known.end());
    return text::did_you_mean(word, views);
}

/// A name or an option, else one of the longer words of all summaries.
std::string likely(std::string_view word) {
    constexpr std::size_t shortest = 6;
    std::vector<std::string> names;
    std::vector<std::string> words;
    for (const Section& section : sections()) {
        names.emplace_back(section.description->name);
        for (const lua::Member& member : section.description->members) {
            const std::string whole = signature(member.doc);
            for (const lua::Token& token : lua::tokens(whole)) {
                if (token.kind == lua::TokenKind::name) {
                    names.emplace_back(token.text);
                }
            }
            for (const lua::Token& token : lua::tokens(member.doc.summary)) {
                if (token.kind == lua::TokenKind::name && token.text.size() >= shortest) {
                    words.push_back(text::lower(token.text));
                }
            }
        }
    }
    const std::string hint = likely(word, names);
    return hint.empty() ? likely(word, words) : hint;
}

std::string no_help(std::string_view words) {
    std::string hint = likely(words);
    if (const std::size_t last = words.find_last_of(".:"); hint.empty() && last != std::string_view::npos) {
        hint = likely(words.substr(last + 1));  // run.enrgy
    }
    const std::string shown = text::quoted(words);  // control characters would steer the terminal
    return fmt::format("nothing about '{}'{}{}\n", shown.substr(1, shown.size() - 2), hint,
                       hint.empty() ? "; help \"contents\" lists what there is" : "");
}

std::string contents(const terminal::Display& screen) {
    std::string text;
    for (const Section& section : sections()) {
        text += fmt::format("{}{}\n", text.empty() ? "" : "\n", section.title);
        std::string names;
        for (const lua::Member& member : section.description->members) {
            if (member.kind != lua::Kind::metamethod) {
                names += (names.empty() ? "" : ", ") + written_name(section, member);
            }
        }
        const std::size_t width = std::min(screen.width - 1, text::readable_width) - 2;
        text += "  " + text::indented(text::wrapped(names, width), 2) + "\n";
    }
    return text + "\nhelp \"name\" says more about each of them.\n";
}

}  // namespace

std::vector<std::string> help_names() {
    std::vector<std::string> names = {"contents"};
    for (const Section& section : sections()) {
        if (*section.prefix != '\0') {
            names.emplace_back(section.description->name);
        }
        for (const lua::Member& member : section.description->members) {
            if (member.kind != lua::Kind::metamethod) {
                names.push_back(written_name(section, member));
                names.emplace_back(member.name);
            }
        }
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

std::vector<std::string> help_option_names() {
    std::vector<std::string> names;
    for (const Section& section : sections()) {
        for (const lua::Member& member : section.description->members) {
            for (const text::Call* call : calls_of(member.doc)) {
                for (const text::Option& option : call->options) names.emplace_back(option.name);
            }
        }
    }
    return names;
}

namespace {

/// Entries, options and mentions; empty when there are none.
std::string found_about(std::string_view words, const terminal::Display& screen) {
    constexpr std::size_t most = 10;
    std::string text;
    for (const Hit& hit : named(words)) {
        text += (text.empty() ? "" : "\n") + hit_text(hit, screen);
    }
    if (!text.empty()) {
        const auto listed = [](const std::string& call, const OptionLine& /*line*/) { return ", " + call; };
        const std::string calls = about_option(words, listed);
        const std::size_t width = std::min<std::size_t>(screen.width, 80) - 1;
        return calls.empty() ? text : text + text::wrapped("An option of: " + calls.substr(2), width) + "\n";
    }
    text = about_option(words, [&screen](const std::string& call, const OptionLine& line) {
        return line_about(fmt::format("{}{{ {} }}", call, line.name), line.meaning, screen);
    });
    if (!text.empty()) {
        return text;
    }
    const std::vector<Hit> hits = mentioning(words);
    for (std::size_t i = 0; i < std::min(most, hits.size()); ++i) {
        text += hit_line(hits[i], screen);
    }
    if (hits.size() > most) {
        text += fmt::format("  ... and {} more: use more of the word\n", hits.size() - most);
    }
    return text;
}

/// "how do I fit a record" without the words that every question has.
std::string without_small_words(std::string_view question) {
    constexpr std::array<std::string_view, 22> small = {"how", "do",   "i",   "a",  "an",   "the", "to",   "can",
                                                        "is",  "are",  "of",  "my", "for",  "in",  "what", "which",
                                                        "why", "does", "you", "it", "make", "get"};
    std::string rest;
    for (std::size_t begin = 0; begin < question.size();) {
        const std::size_t end = std::min(question.find(' ', begin), question.size());
        const std::string word = text::lower(question.substr(begin, end - begin));
        if (!word.empty() && std::find(small.begin(), small.end(), word) == small.end()) {
            rest.append(rest.empty() ? "" : " ").append(question.substr(begin, end - begin));
        }
        begin = end + 1;
    }
    return rest;
}

bool is_question(std::string_view words) {
    constexpr std::array<std::string_view, 6> heads = {"how ", "what ", "which ", "why ", "where ", "can "};
    return std::any_of(heads.begin(), heads.end(),
                       [&](std::string_view head) { return text::lower(words).starts_with(head); });
}

std::string entries_named(std::string_view name, const terminal::Display& screen) {
    std::string text;
    for (const Hit& hit : named(name)) text += "\n" + hit_text(hit, screen);
    return text;
}

}  // namespace

std::string help_about(std::string_view words, const terminal::Display& screen) {
    words = in_english(text::trimmed(words, " "));
    if (words == "contents") {
        return contents(screen);
    }
    if (std::string word = lua_word(words); !word.empty()) {
        return word + entries_named(words, screen);
    }
    const std::string rest = without_small_words(words);
    std::string about(topic(rest.empty() ? words : rest));
    if (about.empty()) about = lua_word(rest);
    std::string found = is_question(words) ? "" : found_about(words, screen);
    if (found.empty() && !rest.empty()) {
        found = found_about(rest, screen);
    }
    for (std::size_t begin = 0; begin < rest.size() && about.empty() && found.empty();) {
        const std::size_t end = std::min(rest.find(' ', begin), rest.size());
        about = lua_word(std::string_view(rest).substr(begin, end - begin));
        begin = end + 1;
    }
    if (about.empty() && found.empty()) {
        return no_help(rest.empty() ? words : rest);
    }
    return about + (about.empty() || found.empty() ? "" : "\n") + found;
}

}  // namespace dinal::help
