#include "help/help_text.hpp"

#include <fmt/format.h>

#include <unistd.h>
#include <algorithm>

#include "help/library.hpp"
#include "help/lua_words.hpp"
#include "help/signature.hpp"
#include "help/tour.hpp"
#include "lua/bind.hpp"
#include "lua/standard_globals.hpp"
#include "lua/tokens.hpp"
#include "terminal/pager.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::help {

namespace {

std::size_t text_width(const terminal::Display& screen) {
    return std::min(screen.width - 1, text::readable_width);
}

std::string first_sentence(std::string_view summary) {
    const std::size_t stop = summary.find(". ");
    return std::string(stop == std::string_view::npos ? summary : summary.substr(0, stop + 1));
}

/// A line of Lua in rows of `width`: broken before -->, otherwise between tokens.
std::string code_in_rows(std::string_view line, std::size_t width) {
    constexpr std::size_t indent = 4;
    std::string rows;
    for (std::size_t room = width; text::columns(line) > room; room = width - indent) {
        const std::size_t arrow = line.find("-->");
        std::size_t cut = arrow != std::string_view::npos && arrow > 0 ? arrow : 0;
        if (cut == 0 || cut > room) {
            cut = 0;
            for (const lua::Token& token : lua::tokens(line)) {
                const bool fits = token.end() <= room && token.end() < line.size() && line[token.end()] == ' ';
                cut = fits ? token.end() : cut;
            }
        }
        if (cut == 0) {
            break;
        }
        const std::size_t end = line.find_last_not_of(' ', cut - 1) + 1;
        rows.append(line.substr(0, end)).append("\n").append(indent, ' ');
        line.remove_prefix(std::min(line.find_first_not_of(' ', cut), line.size()));
    }
    return rows.append(line);
}

std::string indented(std::string_view text, std::size_t width) {
    constexpr std::string_view margin = "    ";
    std::string result;
    for (const std::string_view line : text::split(text, '\n')) {
        const std::string rows = code_in_rows(line, width - margin.size());
        result.append(result.empty() ? "" : "\n").append(margin).append(text::indented(rows, margin.size()));
    }
    return result;
}

/// A name and its text: in two columns, or one below the other on a narrow screen.
std::string two_columns(std::string_view name, std::string_view about, std::size_t indent,
                        const terminal::Display& screen) {
    const std::size_t width = text_width(screen);
    const bool narrow = width < indent + 24;
    const bool below = narrow || name.size() + 3 > indent;
    const std::size_t margin = narrow ? 4 : indent;
    const std::string text = text::indented(text::wrapped(about, width - margin), margin);
    return below ? fmt::format("  {}\n{:{}}{}\n", name, "", margin, text)
                 : fmt::format("  {:<{}} {}\n", name, indent - 3, text);
}

std::string options_text(const lua::Doc& doc, const terminal::Display& screen) {
    constexpr std::size_t widest_name = 24;
    std::string text;
    for (const text::Call* call : calls_of(doc)) {
        const std::vector<OptionLine> lines = option_lines(call->options);
        std::size_t indent = 0;
        for (const OptionLine& line : lines) indent = std::max(indent, std::min(line.name.size(), widest_name) + 4);
        if (!lines.empty()) text += "\n";
        for (const OptionLine& line : lines) text += two_columns(line.name, line.meaning, indent, screen);
    }
    return text;
}

std::string doc_text(const lua::Doc& doc, const terminal::Display& screen) {
    const std::size_t width = text_width(screen);
    return terminal::spelled(
        fmt::format("{}\n\n{}\n{}\n{}\n", text::wrapped(signature(doc), width), text::wrapped(doc.summary, width),
                    options_text(doc, screen), indented(doc.example, width)),
        screen);
}

/// Returns whether the text contains the name as a whole name.
bool mentions(std::string_view text, std::string_view name) {
    for (std::size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
        const std::size_t end = at + name.size();
        const bool begins =
            at == 0 || (!text::is_name_char(text[at - 1]) && text[at - 1] != '.' && text[at - 1] != ':');
        if (begins && (end == text.size() || !text::is_name_char(text[end]))) {
            return true;
        }
    }
    return false;
}

class Names {
public:
    void add(const std::string& name) {
        constexpr std::size_t most = 5;
        if (list.size() < most && std::ranges::find(list, name) == list.end()) {
            list.push_back(name);
        }
    }
    std::vector<std::string> list;
};

/// Returns whether a name is specific enough for a mention to count: not a single plain word such as "system" or "v".
bool telling(std::string_view name) {
    return name.find_first_of(".:") != std::string_view::npos;
}

}  // namespace

std::string written_name(const Section& section, const lua::Member& member) {
    const std::string_view prefix = section.prefix;
    const std::string_view separator = prefix.empty() ? "" : member.kind == lua::Kind::method ? ":" : ".";
    return fmt::format("{}{}{}", prefix, separator, member.name);
}

std::string listed_name(const Section& section, const lua::Member& member) {
    if (member.kind == lua::Kind::metamethod) {
        const std::string_view signature = member.doc.signature;
        return std::string(signature.substr(0, signature.find(" ->")));
    }
    return written_name(section, member);
}

// Names that the entry mentions, its result's class, entries that mention it, and its neighbours; derived, so that no
// list needs maintenance.
std::vector<std::string> see_also(const Section& section, const lua::Member& member) {
    Names names;
    const std::string own = written_name(section, member);
    std::vector<std::string> mentioning;
    std::vector<std::string> alike;  // members after this one, followed by those before it
    std::size_t before = 0;
    for (const Section& other_section : sections()) {
        for (const lua::Member& other : other_section.description->members) {
            const std::string name = written_name(other_section, other);
            if (other.kind == lua::Kind::metamethod || name == own) {
                continue;
            }
            if (telling(name) && mentions(member.doc.summary, name)) {
                names.add(name);
            } else if (telling(own) && mentions(other.doc.summary, own)) {
                mentioning.push_back(name);
            } else if (&section == &other_section && other.kind == member.kind) {
                alike.push_back(name);
                before += &other < &member ? 1U : 0U;
            }
        }
    }
    const Section* result = section_of_result(member.doc.signature);
    if (result != nullptr && result->description != section.description) {
        names.add(result->description->name);
    }
    std::for_each(mentioning.begin(), mentioning.end(), [&names](const std::string& name) { names.add(name); });
    std::rotate(alike.begin(), alike.begin() + static_cast<std::ptrdiff_t>(before), alike.end());
    constexpr std::size_t enough = 3;
    for (std::size_t i = 0; i < alike.size() && names.list.size() < enough; ++i) {
        names.add(alike[i]);
    }
    return names.list;
}

std::string member_text(const Section& section, const lua::Member& member, const terminal::Display& screen) {
    std::string text = doc_text(member.doc, screen);
    if (const auto names = see_also(section, member); !names.empty()) {
        text += "\n" + text::wrapped(fmt::format("See also: {}", fmt::join(names, ", ")), text_width(screen)) + "\n";
    }
    return text;
}

std::string line_about(std::string_view name, std::string_view summary, const terminal::Display& screen) {
    return terminal::spelled(two_columns(name, first_sentence(summary), 28, screen), screen);
}

std::string class_text(const Section& section, const terminal::Display& screen) {
    std::string text = doc_text(section.description->doc, screen) + "\n";
    for (const lua::Member& member : section.description->members) {
        text += line_about(listed_name(section, member), member.doc.summary, screen);
    }
    return text;
}

namespace {

std::string text_about(const lua::Documented& found, const terminal::Display& screen) {
    std::string text;
    for (const Section& section : sections()) {
        if (section.description == found.owner) {
            text += found.member != nullptr ? member_text(section, *found.member, screen) : class_text(section, screen);
        }
    }
    return text;
}

std::string text_about_page(lua_State* L) {
    const lua_Integer page = lua_tointeger(L, 1);
    const auto last = static_cast<lua_Integer>(tour_pages());
    return page >= 1 && page <= last ? tour_page(static_cast<std::size_t>(page))
                                     : "the tour has pages 1 to " + std::to_string(last) + "\n";
}

/// "math.sin" for that Lua function, "" for other values.
std::string name_in_lua(lua_State* L, int index) {
    for (const std::string_view word : lua_words()) {
        const int top = lua_gettop(L);
        const std::size_t dot = word.find('.');
        lua_pushglobaltable(L);
        lua_pushlstring(L, word.data(), std::min(dot, word.size()));
        lua_rawget(L, -2);
        if (dot != std::string_view::npos && lua_istable(L, -1)) {
            lua_pushlstring(L, word.data() + dot + 1, word.size() - dot - 1);
            lua_rawget(L, -2);
        }
        const bool same = !lua_isnil(L, -1) && lua_rawequal(L, index, -1) != 0;
        lua_settop(L, top);
        if (same) return std::string(word);
    }
    return "";
}

std::string text_about_value(lua_State* L, const terminal::Display& screen) {
    if (lua_isnone(L, 1)) {
        return tour_page(1);
    }
    if (lua_isnil(L, 1)) {
        // help(undefined_name) also arrives here.
        return "nil has no help; put the name in quotes: help \"simulate\"\n";
    }
    if (lua_type(L, 1) == LUA_TSTRING) {
        const std::string_view words = lua_tostring(L, 1);
        return words.find_first_not_of(' ') == std::string_view::npos ? tour_page(1) : help_about(words, screen);
    }
    if (lua_isinteger(L, 1) != 0) {
        return text_about_page(L);
    }
    lua::push_dinal_table(L);
    const bool is_library = lua_rawequal(L, 1, -1) != 0;
    lua_pop(L, 1);
    if (is_library) {
        return help_about("contents", screen);
    }
    if (const lua::Documented found = lua::documented(L, 1); found.owner != nullptr) {
        return text_about(found, screen);
    }
    if (const std::string name = name_in_lua(L, 1); !lua_word(name).empty()) {
        return lua_word(name);
    }
    return lua::describe(L, 1) + " has no help of its own; put the name in quotes: help \"omega0\"\n";
}

int help(lua_State* L) {
    const std::string text = text_about_value(L, terminal::display_of(STDOUT_FILENO));
    terminal::show_in_pages(text);
    return 0;
}

constexpr lua::Member functions[] = {
    {lua::a_function<help>,
     {"help(x) or help \"words\"",
      "Explains a function, method, module or object, or a name in quotes. Other words are searched for in all "
      "names and descriptions. help() starts a tour.",
      "help(excitation.step)\nhelp \"dead zone\""}},
};

}  // namespace

const lua::Class help_functions = {
    "help", {"help(x) or help \"words\"", "The manual at the prompt.", "help \"dead zone\""}, functions};

void register_help(lua_State* L) {
    lua::add_functions(L, help_functions);
}

}  // namespace dinal::help
