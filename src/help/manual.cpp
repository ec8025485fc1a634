#include "help/manual.hpp"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace

std::string manual() {
    std::string text = fmt::format(
        "# dinal {}: manual of the Lua API\n\n"
        "This page is what `dinal --manual` prints; at the prompt `help(x)` prints the same, one entry at a time. "
        "Everything lives in the table `dinal`, and its members are plain globals, too. "
        "Options are named; an unknown one is an error. "
        "In the examples `-->` is followed by what the line prints.\n\n",
        DINAL_VERSION);
    for (const Section& section : sections()) {
        text += fmt::format("- [{}](#{})\n", section.title, anchor(section.title));
    }
    const auto entry = [&text](const lua::Doc& doc) {
        text += fmt::format("`{}`\n\n{}\n\n", signature(doc), doc.summary);
        for (const text::Call* call : calls_of(doc)) {
            for (const OptionLine& line : option_lines(call->options)) {
                text += fmt::format("- `{}`: {}\n", line.name, line.meaning);
            }
            if (!call->options.empty()) text += "\n";
        }
        text += fmt::format("```lua\n{}\n```\n", doc.example);
    };
    for (const Section& section : sections()) {
        text += fmt::format("\n## {}\n\n", section.title);
        entry(section.description->doc);
        for (const lua::Member& member : section.description->members) {
            text += fmt::format("\n### {}\n\n", listed_name(section, member));
            entry(member.doc);
        }
    }
    return text;
}

}  // namespace dinal::help
