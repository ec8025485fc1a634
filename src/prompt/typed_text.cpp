#include "prompt/typed_text.hpp"

namespace dinal::prompt {
namespace {

bool opens(const lua::Token& token) {
    return token.is("(") || token.is("{") || token.is("[");
}
bool closes_bracket(const lua::Token& token) {
    return token.is(")") || token.is("}") || token.is("]");
}
bool separates(const lua::Token& token) {
    return token.is(".") || token.is(":");
}

}  // namespace

TypedText::TypedText(std::string_view before) : tokens_(lua::tokens(before)) {
    find_cursor(before);
    find_call();
}

void TypedText::find_cursor(std::string_view before) {
    if (!tokens_.empty() && tokens_.back().end() == before.size()) {
        const lua::Token& last = tokens_.back();
        if (last.kind == lua::TokenKind::comment || last.kind == lua::TokenKind::number) {
            return;
        }
        if (last.kind == lua::TokenKind::string) {
            cursor_ = last.open && last.text.front() != '[' ? Cursor::string : Cursor::nothing;
            word_ = last.text.substr(1);
            tokens_.pop_back();
            return;
        }
        if (last.kind != lua::TokenKind::symbol) {
            word_ = last.text;
            tokens_.pop_back();
        }
    }
    cursor_ = Cursor::name;
    if (tokens_.size() > 1 && separates(tokens_.back())) {
        cursor_ = Cursor::member;
        separator_ = tokens_.back().text.front();
        owner_ = expression_before(tokens_.size() - 1);
    }
}

/// The expression that ends before token `end`: a name, fields, calls, brackets. Empty when none does.
std::span<const lua::Token> TypedText::expression_before(std::size_t end) const {
    std::size_t begin = end;
    while (begin > 0) {
        const lua::Token& last = tokens_[begin - 1];
        if (last.kind == lua::TokenKind::name) {
            --begin;
            if (begin < 2 || !separates(tokens_[begin - 1])) {
                break;
            }
            --begin;
        } else if (closes_bracket(last)) {
            int depth = 0;
            do {
                --begin;
                depth += closes_bracket(tokens_[begin]) ? 1 : opens(tokens_[begin]) ? -1 : 0;
            } while (depth > 0 && begin > 0);
            const bool called =
                begin > 0 && (tokens_[begin - 1].kind == lua::TokenKind::name || closes_bracket(tokens_[begin - 1]));
            if (!called) {
                break;
            }
        } else if (last.kind == lua::TokenKind::string && begin > 1 &&
                   tokens_[begin - 2].kind == lua::TokenKind::name) {
            --begin;  // f"text"
        } else {
            return {};
        }
    }
    return std::span(tokens_).subspan(begin, end - begin);
}

std::vector<std::size_t> TypedText::open_brackets() const {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
        if (opens(tokens_[i])) {
            open.push_back(i);
        } else if (closes_bracket(tokens_[i]) && !open.empty()) {
            open.pop_back();
        }
    }
    return open;
}

/// How the table that begins at one bracket stands in what begins at another: under which name, "" without one. None
/// when it is part of an expression there.
std::optional<std::string_view> TypedText::name_of_table(std::size_t bracket, std::size_t outer) const {
    const auto separates_items = [&](std::size_t i) {
        return i == outer || tokens_[i].is(",") || (tokens_[i].is(";") && tokens_[outer].is("{"));
    };
    if (separates_items(bracket - 1)) {
        return "";
    }
    const bool named = bracket - outer > 2 && tokens_[bracket - 1].is("=") && tokens_[outer].is("{") &&
                       tokens_[bracket - 2].kind == lua::TokenKind::name && separates_items(bracket - 3);
    return named ? std::optional(tokens_[bracket - 2].text) : std::nullopt;
}

void TypedText::find_call() {
    const std::vector<std::size_t> open = open_brackets();
    if (cursor_ == Cursor::string && !tokens_.empty() && tokens_.back().kind == lua::TokenKind::name) {
        call_ = OpenCall{.function = expression_before(tokens_.size())};  // f"...
        return;
    }
    if (open.empty()) {
        return;
    }
    const std::size_t bracket = open.back();
    OpenCall call{.function = expression_before(bracket)};
    call.options = tokens_[bracket].is("{");
    std::size_t around = open.size() - 1;
    for (; call.function.empty() && around > 0 && tokens_[open[around]].is("{"); --around) {
        const std::optional<std::string_view> name = name_of_table(open[around], open[around - 1]);
        if (!name) {
            return;
        }
        call.path.insert(call.path.begin(), *name);
        call.function = expression_before(open[around - 1]);
    }
    if (call.function.empty()) {
        return;
    }
    if (!call.path.empty() && call.path.front().empty()) {
        call.braces = tokens_[open[around]].is("(") ? help::Braces::in_parentheses : help::Braces::nested;
        call.path.erase(call.path.begin());
    }
    int depth = 0;
    for (std::size_t i = bracket + 1; i + 1 < tokens_.size(); ++i) {
        depth += opens(tokens_[i]) ? 1 : closes_bracket(tokens_[i]) ? -1 : 0;
        if (depth == 0 && tokens_[i].kind == lua::TokenKind::name && tokens_[i + 1].is("=")) {
            call.given.push_back(tokens_[i].text);
        }
    }
    const lua::Token& last = tokens_.back();
    if (call.options && cursor_ == Cursor::name && (last.is("{") || last.is(",") || last.is(";"))) {
        cursor_ = Cursor::option;
    }
    if (call.options && last.is("=") && tokens_.size() > bracket + 2) {
        call.option = tokens_[tokens_.size() - 2].text;
        cursor_ = cursor_ == Cursor::name ? Cursor::value : cursor_;
    }
    call_ = call;
}

}  // namespace dinal::prompt
