#include "help/signature.hpp"

#include <algorithm>

#include "lua/tokens.hpp"
#include "text/words.hpp"

namespace dinal::help {
namespace {

bool is_class_of_objects(const Section& section) {
    return std::none_of(section.description->members.begin(), section.description->members.end(),
                        [](const lua::Member& member) { return member.kind == lua::Kind::function; });
}

}  // namespace

std::vector<std::string> option_names(std::string_view signature, Braces braces) {
    std::vector<std::string> names;
    int parentheses = 0;
    int depth = 0;
    std::string_view before;
    for (const lua::Token& token : lua::tokens(signature.substr(0, signature.find("->")))) {
        parentheses += token.is("(") ? 1 : token.is(")") ? -1 : 0;
        depth += token.is("{") ? 1 : token.is("}") ? -1 : 0;
        const bool begins = before == "{" || before == "," || before == "|";
        const bool asked = (parentheses > 0) == (braces == Braces::in_parentheses);
        if (depth == (braces == Braces::nested ? 2 : 1) && asked && begins && token.kind == lua::TokenKind::name) {
            names.emplace_back(token.text);
        }
        before = token.text;
    }
    return names;
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

const Section* result_class(std::string_view signature) {
    const std::size_t arrow = signature.find("-> ");
    if (arrow == std::string_view::npos) {
        return nullptr;
    }
    const std::string_view result = signature.substr(arrow + 3);
    const std::string_view name = result.substr(0, result.find_first_of(" ,"));
    for (const Section& section : sections()) {
        if (name == section.description->name && is_class_of_objects(section)) {
            return &section;
        }
    }
    return nullptr;
}

}  // namespace dinal::help
