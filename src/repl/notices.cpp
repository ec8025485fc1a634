#include "repl/notices.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "lua/misspelling.hpp"
#include "lua/tokens.hpp"
#include "repl/output.hpp"

namespace dinal {
namespace {

bool opens_block(const Token& token) {
    return token.is("function") || token.is("do") || token.is("if") || token.is("repeat");
}
bool closes_block(const Token& token) {
    return token.is("end") || token.is("until");
}

/// The names that `local`, which is token `at`, declares.
std::vector<std::string_view> declared(const std::vector<Token>& all, std::size_t at) {
    std::vector<std::string_view> names;
    std::size_t i = at + 1 + (at + 1 < all.size() && all[at + 1].is("function") ? 1 : 0);
    for (; i < all.size() && all[i].kind == TokenKind::name; i += 2) {
        names.push_back(all[i].text);
        if (i + 1 >= all.size() || !all[i + 1].is(",")) {
            break;
        }
    }
    return names;
}

/// How often a name stands there. Once only: where it is declared.
std::ptrdiff_t uses(const std::vector<Token>& all, std::string_view name) {
    return std::count_if(all.begin(), all.end(),
                         [name](const Token& t) { return t.kind == TokenKind::name && t.text == name; });
}

}  // namespace

std::string nil_notice(lua_State* L, const Chunk& chunk) {
    const std::vector<Token> all = tokens(chunk.expression);
    if (all.size() != 1 || all.front().kind != TokenKind::name || all.front().is("ans")) {
        return "";
    }
    const std::string_view name = all.front().text;
    if (name == "exit" || name == "quit") {
        return "there is no such variable; :quit or Ctrl-D leaves";
    }
    const std::string hint = similar_global(L, name);
    return hint.empty() ? "" : fmt::format("there is no variable '{}'{}", name, hint);
}

std::string local_notice(const std::string& text) {
    const std::vector<Token> all = tokens(text);
    int depth = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].is("local") && depth == 0) {
            for (const std::string_view name : declared(all, i)) {
                if (uses(all, name) == 1) {
                    return fmt::format(
                        "a local variable ends with the line: to keep '{}' at the prompt, leave out the word local",
                        name);
                }
            }
        }
        depth += opens_block(all[i]) ? 1 : closes_block(all[i]) ? -1 : 0;
    }
    return "";
}

void say_notice(const std::string& notice) {
    if (!notice.empty()) {
        say_error("(" + notice + ")");
    }
}

}  // namespace dinal
