#include "lua/lua_message.hpp"

#include <algorithm>
#include <charconv>

namespace dinal::lua {
namespace {

constexpr std::string_view end_of_chunk = "<eof>";

/// The text between the first `head` and the next `tail`; "" if there is none.
std::string_view between(std::string_view words, std::string_view head, std::string_view tail) {
    const std::size_t at = words.find(head);
    if (at == std::string_view::npos) {
        return {};
    }
    const std::string_view rest = words.substr(at + head.size());
    const std::size_t end = rest.find(tail);
    return end == std::string_view::npos ? std::string_view() : rest.substr(0, end);
}

std::vector<std::string_view> quoted_in(std::string_view words) {
    std::vector<std::string_view> found;
    for (std::size_t at = words.find('\''); at != std::string_view::npos; at = words.find('\'', at)) {
        const std::size_t end = words.find('\'', at + 1);
        if (end == std::string_view::npos) {
            break;
        }
        found.push_back(words.substr(at + 1, end - at - 1));
        at = end + 1;
    }
    return found;
}

}  // namespace

LuaMessage running_message(std::string_view words) {
    LuaMessage message{words};
    message.quoted = quoted_in(words.substr(0, words.find('\n')));
    message.type = between(words, " a ", " value");
    const std::string_view variable = between(words, " value (", "')");
    message.kind = variable.substr(0, variable.find(" '"));
    message.name = variable.substr(std::min(message.kind.size() + 2, variable.size()));
    message.calls = words.starts_with("attempt to call a ");
    message.calculates = words.starts_with("attempt to perform arithmetic on ");
    message.misses_a_value =
        words.find("nil") != std::string_view::npos && words.find("nil value (") == std::string_view::npos;
    return message;
}

std::optional<SyntaxMessage> syntax_message(std::string_view words) {
    constexpr std::string_view head = " near ";
    const std::size_t at = words.find(head);
    const std::string_view near = at == std::string_view::npos ? std::string_view() : words.substr(at + head.size());
    if (!near.starts_with('\'') && !near.starts_with('<')) {
        return std::nullopt;
    }
    SyntaxMessage message{words.substr(0, std::min(at, words.find(" (to close ")))};
    message.words = words;
    message.near = near.starts_with('<') ? end_of_chunk : near.substr(1, near.rfind('\'') - 1);
    if (words.starts_with('\'')) {
        message.expected = words.substr(1, words.find('\'', 1) - 1);
    }
    message.opened = between(words, "(to close '", "'");
    const std::string_view line = between(words, "' at line ", ")");
    std::from_chars(line.data(), line.data() + line.size(), message.opened_line);
    return message;
}

bool is_about_yield(std::string_view message) {
    return message == "attempt to yield across a C-call boundary" ||
           message == "attempt to yield from outside a coroutine";
}

bool is_about_end(std::string_view message) {
    return message.ends_with(end_of_chunk);
}

bool is_about_unfinished_string(std::string_view message) {
    return message.find("unfinished string near") != std::string_view::npos;
}

bool is_about_forbidden_bytecode(std::string_view message) {
    return message.starts_with("attempt to load a binary chunk");
}

bool is_about_foreign_bytecode(std::string_view message) {
    return message.find("bad binary format") != std::string_view::npos;
}

}  // namespace dinal::lua
