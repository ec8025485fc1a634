#include "errors/source_text.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "files/file.hpp"
#include "lua/tokens.hpp"
#include "source/function_source.hpp"
#include "text/words.hpp"

namespace dinal::errors {

std::optional<Message> parse_message(std::string_view message) {
    for (std::size_t colon = message.find(':'); colon != std::string_view::npos; colon = message.find(':', colon + 1)) {
        std::size_t end = colon + 1;
        int line = 0;
        while (end < message.size() && text::is_digit(message[end]) && line < 100'000'000) {
            line = 10 * line + (message[end++] - '0');
        }
        if (line > 0 && message.substr(end, 2) == ": ") {
            return Message{message.substr(0, colon), line, message.substr(end + 2)};
        }
        if (message.substr(0, colon).find('\n') != std::string_view::npos) {
            break;
        }
    }
    return std::nullopt;
}

bool find_frame(lua_State* L, const Message& message, lua_Debug& frame) {
    constexpr int deepest = 100;  // in a deep recursion the error is near the top
    for (int level = 0; level < deepest && lua_getstack(L, level, &frame) != 0; ++level) {
        lua_getinfo(L, "Sl", &frame);
        if (frame.currentline == message.line && message.chunk == frame.short_src) {
            return true;
        }
    }
    return false;
}

std::string_view SourceText::line(int number) const {
    const std::vector<std::string_view> lines = text::split(text, '\n');
    const auto place = static_cast<std::size_t>(number - first_line);
    return number < first_line || place >= lines.size() ? std::string_view() : lines[place];
}

std::string_view SourceText::statement(int number) const {
    const std::string_view first = line(number);
    if (first.empty()) {
        return {};
    }
    const auto begin = static_cast<std::size_t>(first.data() - text.data());
    const std::string_view rest = std::string_view(text).substr(begin);
    constexpr std::size_t longest = 10'000;  // bytes
    int depth = 0;
    for (const lua::Token& token : lua::tokens(rest.substr(0, longest))) {
        if (depth <= 0 && token.at > first.size()) {
            return rest.substr(0, std::max(first.size(), token.at - 1));
        }
        depth += token.nesting();
    }
    return rest.substr(0, longest);
}

std::optional<SourceText> source_of_frame(lua_State* L, lua_Debug& frame) {
    lua_getinfo(L, "Sf", &frame);  // pushes the function
    const std::string_view source = frame.source;
    std::optional<SourceText> found;
    if (source.starts_with('@')) {
        found = source_of_file(std::string(source.substr(1)));
    } else if (!source.starts_with('=')) {
        found = SourceText{std::string(source)};  // load("...")
    } else if (frame.what == std::string_view("main")) {
        found = source_kept(L, source.substr(1));
    } else if (const auto text = source::function_source(L, -1)) {
        found = SourceText{*text, frame.linedefined};
    }
    lua_pop(L, 1);
    return found;
}

std::optional<SourceText> source_of_file(const std::string& path) {
    std::error_code wrong;
    if (!std::filesystem::is_regular_file(path, wrong)) return std::nullopt;  // /dev/zero has no end
    auto text = files::read_file(path);
    return text ? std::optional(SourceText{std::move(text).value()}) : std::nullopt;
}

std::optional<SourceText> source_kept(lua_State* L, std::string_view chunk) {
    const auto text = source::last_kept_source(L, "=" + std::string(chunk));
    return text ? std::optional(SourceText{*text}) : std::nullopt;
}

std::optional<SourceText> source_running(lua_State* L, std::string_view chunk) {
    lua_Debug frame{};
    for (int level = 0; level < 100 && lua_getstack(L, level, &frame) != 0; ++level) {
        lua_getinfo(L, "S", &frame);
        if (chunk == frame.short_src && *frame.source == '@') {
            return source_of_file(frame.source + 1);
        }
    }
    return std::nullopt;
}

}  // namespace dinal::errors
