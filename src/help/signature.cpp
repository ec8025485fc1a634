#include "help/signature.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lua/tokens.hpp"
#include "text/words.hpp"

namespace dinal::help {
namespace {

constexpr std::string_view options_mark = "OPTIONS";

std::string with_default(const text::Option& option) {
    const std::string otherwise = text::default_text(option);
    return otherwise.empty() ? option.name : fmt::format("{} = {}", option.name, otherwise);
}

bool is_class_of_objects(const Section& section) {
    return std::ranges::none_of(section.description->members,
                                [](const lua::Member& member) { return member.kind == lua::Kind::function; });
}

}  // namespace

std::string option_list(std::span<const text::Option> options) {
    std::string list;
    for (const text::Option& option : options) {
        list += list.empty() ? "" : option.instead_of_previous ? " | " : ", ";
        list += with_default(option);
    }
    return list;
}

std::string signature(const lua::Doc& doc) {
    std::string text = doc.signature;
    for (const text::Call* call : calls_of(doc)) {
        const bool none = call->options.empty();  // then the blanks around OPTIONS go, too
        const std::size_t place = text.find(options_mark) - (none ? 1 : 0);
        text.replace(place, options_mark.size() + (none ? 2 : 0), option_list(call->options));
    }
    return text;
}

const text::Call* call_with(const lua::Doc& doc, Braces braces) {
    const std::vector<const text::Call*> calls = calls_of(doc);
    std::size_t next = 0;
    int parentheses = 0;
    int depth = 0;
    for (const lua::Token& token : lua::tokens(doc.signature)) {
        parentheses += token.is("(") ? 1 : token.is(")") ? -1 : 0;
        depth += token.is("{") ? 1 : token.is("}") ? -1 : 0;
        if (token.is(options_mark)) {
            const bool asked = (parentheses > 0) == (braces == Braces::in_parentheses);
            if (asked && depth == (braces == Braces::nested ? 2 : 1)) {
                return calls[next];
            }
            ++next;
        }
    }
    return nullptr;
}

std::vector<const text::Call*> calls_of(const lua::Doc& doc) {
    std::vector<const text::Call*> calls(doc.calls.begin(), doc.calls.end());
    std::erase(calls, nullptr);
    return calls;
}

std::vector<OptionLine> option_lines(std::span<const text::Option> options) {
    std::vector<OptionLine> lines;
    for (std::size_t i = 0; i < options.size(); ++i) {
        const text::Option& option = options[i];
        std::vector<std::string> facts;
        if (*option.unit != '\0') {
            facts.emplace_back(option.unit);
        }
        std::string others;
        for (std::size_t j = i + 1; j < options.size() && options[j].instead_of_previous; ++j) {
            others += fmt::format(" or {}", options[j].name);
        }
        if (option.instead_of_previous) {
            std::size_t first = i - 1;
            while (options[first].instead_of_previous) --first;
            facts.push_back(fmt::format("instead of {}", options[first].name));
        } else if (option.otherwise == text::needed) {
            facts.push_back(others.empty() ? "needed" : fmt::format("this{} is needed", others));
        }
        if (option.range.must != std::string_view(text::any_finite.must)) {
            const std::string_view must = option.range.must;
            facts.push_back(fmt::format("must {}", must.substr(0, must.find(':'))));  // without the reason
        }
        if (!option.choices.empty()) {
            facts.push_back(fmt::format("\"{}\"", fmt::join(option.choices, "\", \"")));
        }
        lines.push_back(
            {option.name, with_default(option),
             facts.empty() ? option.meaning : fmt::format("{} ({})", option.meaning, fmt::join(facts, ", "))});
    }
    return lines;
}

std::string parameters(std::string_view signature) {
    const std::size_t open = signature.find_first_of("({");
    const std::size_t close = signature.substr(0, signature.find("->")).find_last_of(")}");
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) {
        return "";
    }
    return std::string(text::trimmed(signature.substr(open + 1, close - open - 1), " "));
}

char call_bracket(std::string_view signature) {
    const std::size_t open = signature.substr(0, signature.find("->")).find_first_of("({");
    return open == std::string_view::npos ? ' ' : signature[open];
}

const Section* section_of_result(std::string_view signature) {
    const std::size_t arrow = signature.find("-> ");
    if (arrow == std::string_view::npos) {
        return nullptr;
    }
    const std::string_view result = signature.substr(arrow + 3);
    const std::string_view name = result.substr(0, result.find_first_of(" ,"));
    for (const Section& section : sections()) {
        if ((name == section.description->name || name == section.prefix) && is_class_of_objects(section)) {
            return &section;
        }
    }
    return nullptr;
}

}  // namespace dinal::help
