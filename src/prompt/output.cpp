#include "prompt/output.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "help/library.hpp"
#include "lua/bind.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_headers.hpp"
#include "lua/lua_text.hpp"
#include "lua/safe_mode.hpp"
#include "source/function_source.hpp"
#include "terminal/display.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::prompt {

namespace {

std::string* collected_errors = nullptr;

}  // namespace

ErrorsInto::ErrorsInto(std::string& text) {
    collected_errors = &text;
}
ErrorsInto::~ErrorsInto() {
    collected_errors = nullptr;
}

void say(std::string_view text) {
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stdout));
}

void say_value(std::string_view text) {
    say(terminal::display_of(STDOUT_FILENO).terminal ? text::harmless(text) : std::string(text));
}

void flush_output() {
    static_cast<void>(std::fflush(stdout));
}

void say_error(std::string_view text) {
    if (collected_errors != nullptr) {
        collected_errors->append(text).append("\n");
        return;
    }
    flush_output();
    const terminal::Display screen = terminal::display_of(STDERR_FILENO);
    const std::string fitting = screen.terminal ? text::wrapped(text::harmless(text), screen.width - 1) : "";
    text = screen.terminal ? fitting : text;
    if (!lua::reached_limit().empty()) {
        lua::write_error_in_time(std::string(text) + "\n");
        return;
    }
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
    static_cast<void>(std::fputc('\n', stderr));
}

namespace {

// ---- A value other than a plain table, as the prompt shows it.

/// A value alone may take several lines; inside a table it has a short form on one line.
enum class Place { alone, inside };

constexpr std::size_t longest_string = 1000;
constexpr std::size_t longest_inner_string = 60;
constexpr std::size_t longest_text = 4000;  // a longer text of several lines is shown as a quoted string
constexpr int most_source_lines = 12;       // lines of a function

int by_tostring(lua_State* L) {
    luaL_tolstring(L, 1, nullptr);
    return 1;
}

/// The result of tostring, or its failure.
std::string tostring_text(lua_State* L, int index) {
    lua_pushvalue(L, index);
    lua_pushcfunction(L, by_tostring);
    lua_insert(L, -2);
    const bool fine = lua_pcall(L, 1, 1, 0) == LUA_OK;
    if (!fine && lua::interrupt_requested()) {
        lua::raise_interrupted(L);
    }
    const std::string text(lua_isstring(L, -1) != 0 ? lua::text_at(L, -1) : luaL_typename(L, -1));
    lua_pop(L, 1);
    return fine ? text : fmt::format("<error in __tostring: {}>", text);
}

/// Returns whether it is a text of several printable lines, too long for quotes.
bool is_text(std::string_view text, const terminal::Display& screen) {
    const bool is_long = text.find('\n') != std::string_view::npos && text.size() > screen.width;
    return is_long && text.size() <= longest_text && text::is_printable(text);
}

std::string string_text(lua_State* L, int index, Place place, const terminal::Display& screen) {
    const std::string_view string = lua::text_at(L, index);
    if (place == Place::alone && is_text(string, screen)) {
        return text::wrapped(terminal::spelled(string, screen), screen.width - 1);
    }
    const std::size_t limit = place == Place::inside ? longest_inner_string : longest_string;
    std::string text = text::quoted(string, limit, screen.unicode);
    return place == Place::alone && string.size() > limit ? fmt::format("{} ({} bytes)", text, string.size()) : text;
}

/// A short function as its source, otherwise its definition's position; a function of dinal by its signature.
std::string function_text(lua_State* L, int index, const terminal::Display& screen) {
    if (const lua::Documented found = lua::documented(L, index); found.member != nullptr) {
        return text::wrapped(fmt::format("function {}", help::signature(found.member->doc)), screen.width - 1);
    }
    const auto source = source::function_source(L, index);
    if (lua_iscfunction(L, index) != 0) {
        return source ? fmt::format("function {} of Lua", *source) : "function written in C";
    }
    lua_Debug about{};
    lua_pushvalue(L, index);
    lua_getinfo(L, ">S", &about);
    if (source && std::ranges::count(*source, '\n') < most_source_lines) {
        return *source;
    }
    return fmt::format("function at {}:{}", about.short_src, about.linedefined);
}

std::string in_one_line(const std::string& text) {
    const std::size_t end = text.find('\n');
    return end == std::string::npos ? text : text.substr(0, end) + "...";
}

/// Returns whether it is a table without __tostring, which is shown item by item.
bool is_plain_table(lua_State* L, int index) {
    if (!lua_istable(L, index)) {
        return false;
    }
    if (luaL_getmetafield(L, index, "__tostring") == LUA_TNIL) {
        return true;
    }
    lua_pop(L, 1);
    return false;
}

/// The text for the value at `index`. Errors of __tostring become part of it; Ctrl-C is a Lua error.
std::string scalar_text(lua_State* L, int index, Place place, const terminal::Display& screen) {
    switch (lua_type(L, index)) {
        case LUA_TNUMBER:
            return std::isnan(lua_tonumber(L, index)) ? "nan" : tostring_text(L, index);
        case LUA_TSTRING:
            return string_text(L, index, place, screen);
        case LUA_TFUNCTION:
            return place == Place::inside ? "function" : function_text(L, index, screen);
        default:
            break;
    }
    const lua::Documented found = lua::documented(L, index);
    if (place == Place::inside) {
        return terminal::spelled(in_one_line(tostring_text(L, index)), screen);
    }
    if (found.owner != nullptr && found.owner->card != nullptr) {
        return found.owner->card(L, lua_absindex(L, index), screen);
    }
    std::string text = tostring_text(L, index);
    return found.owner != nullptr ? text::wrapped(terminal::spelled(text, screen), screen.width - 1) : text;
}

// ---- The items of a table in the order of display.

constexpr std::size_t most_sorted_keys = 500;  // beyond, the first in Lua's order are shown

/// The length of the list 1, 2, ... NOTE: not rawlen's border, which may lie behind holes.
std::size_t list_length(lua_State* L, int index) {
    const auto border = static_cast<lua_Integer>(lua_rawlen(L, index));
    for (lua_Integer n = 0; n < border; ++n) {
        const bool hole = lua_rawgeti(L, index, n + 1) == LUA_TNIL;
        lua_pop(L, 1);
        if (hole) {
            return static_cast<std::size_t>(n);
        }
    }
    return static_cast<std::size_t>(border);
}

/// The items in the order 1, 2, ... n, other numbers, the time t (as in events), other names, the rest.
// NOTE: the keys other than 1 to n are in a Lua table left on the stack. No destructor may remove it: while a Lua error
// unwinds, its message is on the top.
class TableItems {
public:
    TableItems(lua_State* L, int index) : L_(L), table_(index), listed_(list_length(L, index)) {
        lua_newtable(L_);
        keys_ = lua_gettop(L_);
        collect();
        std::ranges::sort(order_);
    }

    std::size_t size() const { return listed_ + others_; }
    /// The number of items shown, which is limited.
    std::size_t shown() const { return listed_ + order_.size(); }
    /// Returns whether item i is one of 1, 2, ... n.
    bool in_list(std::size_t i) const { return i < listed_; }

    /// Pushes the key and the value of item i.
    void push(std::size_t i) const {
        if (in_list(i)) {
            lua_pushinteger(L_, static_cast<lua_Integer>(i) + 1);
        } else {
            lua_rawgeti(L_, keys_, std::get<lua_Integer>(order_[i - listed_]));
        }
        lua_pushvalue(L_, -1);
        lua_rawget(L_, table_);
    }

private:
    using Key = std::tuple<int, double, std::string, lua_Integer>;  // rank, number, name, index in the table of keys

    void collect() {
        lua_pushnil(L_);
        while (lua_next(L_, table_) != 0) {
            if (!key_is_listed()) {
                ++others_;
                if (others_ <= most_sorted_keys) {
                    add_key();
                }
            }
            lua_pop(L_, 1);
        }
    }

    void add_key() {
        const auto place = static_cast<lua_Integer>(others_);
        lua_pushvalue(L_, -2);
        if (lua_type(L_, -1) == LUA_TNUMBER) {
            order_.emplace_back(0, lua_tonumber(L_, -1), "", place);
        } else if (lua_type(L_, -1) == LUA_TSTRING) {
            const std::string_view name = lua::text_at(L_, -1);
            order_.emplace_back(name == "t" ? 1 : 2, 0, std::string(name), place);
        } else {
            order_.emplace_back(3, 0, "", place);
        }
        lua_rawseti(L_, keys_, place);
    }

    bool key_is_listed() const {
        const lua_Integer i = lua_isinteger(L_, -2) != 0 ? lua_tointeger(L_, -2) : 0;
        return i >= 1 && static_cast<std::size_t>(i) <= listed_;
    }

    lua_State* L_;
    int table_;
    int keys_ = 0;
    std::size_t listed_;
    std::size_t others_ = 0;
    std::vector<Key> order_;
};

constexpr std::size_t deepest = 3;            // nesting of tables; deeper ones are {...}
constexpr std::size_t most_lines = 24;        // lines of a value,
constexpr std::size_t most_joined_lines = 6;  // and of a long list of numbers

bool is_fraction(lua_State* L, int index) {
    const double number = lua_type(L, index) == LUA_TNUMBER ? lua_tonumber(L, index) : 0;
    return std::isfinite(number) && number != std::floor(number);
}

/// The beginning of a text, followed by three dots.
std::string shortened(std::string_view text, std::size_t width) {
    return std::string(text::cut_to_columns(text, width > 3 ? width - 3 : 0)) + "...";
}

struct Piece {
    std::string text;
    bool whole = true;  // whether nothing was omitted
};

class Printer {
public:
    Printer(lua_State* L, const terminal::Display& screen) : L_(L), screen_(screen), width_(screen.width - 1) {}

    std::string value(int index) {
        if (!is_plain_table(L_, index)) {
            return scalar_text(L_, index, Place::alone, screen_);
        }
        const Piece line = table_line(index, width_);
        return line.whole ? line.text : table_lines(index);
    }

    std::string line(int index, std::size_t width) {
        std::string text = is_plain_table(L_, index) ? table_line(index, width).text : scalar(index);
        return text::columns(text) > width ? shortened(text, width) : text;
    }

private:
    std::string scalar(int index) const { return scalar_text(L_, index, Place::inside, screen_); }

    /// A value inside a table, in `room` columns if it can be cut.
    Piece inner(int index, std::size_t room) {
        if (!is_plain_table(L_, index)) {
            const bool short_number = brief_ && is_fraction(L_, index);
            Piece item{short_number ? fmt::format("{:.6g}", lua_tonumber(L_, index)) : scalar(index)};
            if (lua_isuserdata(L_, index) != 0 &&
                text::columns(item.text) > room) {  // the beginning of dinal's objects is enough
                item = {shortened(item.text, room), false};
            }
            return item;
        }
        const void* address = lua_topointer(L_, index);
        if (text::contains(open_, address)) {
            return {"<cycle>"};
        }
        return open_.size() >= deepest ? Piece{"{...}"} : table_line(index, room);
    }

    /// The items that fit on one line.
    Piece table_line(int index, std::size_t room) {
        luaL_checkstack(L_, 8, "tables are nested too deep");
        const int top = lua_gettop(L_);
        open_.push_back(lua_topointer(L_, index));
        const TableItems items(L_, index);
        Piece line{"{"};
        std::size_t used = 3;  // braces and a space
        for (std::size_t i = 0; i < items.size(); ++i) {
            const std::size_t left = room > used + 2 ? room - used - 2 : 0;
            Piece item = left > 0 && i < items.shown() ? next_item(items, i, left) : Piece{"", false};
            if (i >= items.shown() || text::columns(item.text) > left || left == 0) {
                line.text += fmt::format("{}... {} more", i == 0 ? " " : ", ", items.size() - i);
                line.whole = false;
                break;
            }
            line.whole = line.whole && item.whole;
            line.text.append(i == 0 ? " " : ", ").append(item.text);
            used += text::columns(item.text) + 2;
        }
        open_.pop_back();
        lua_settop(L_, top);
        line.text += line.text.size() == 1 ? "}" : " }";
        return line;
    }

    std::string key_text(int index) const {
        if (lua_type(L_, index) == LUA_TSTRING && lua::is_name(lua::text_at(L_, index))) {
            return std::string(lua::text_at(L_, index));
        }
        return "[" + (is_plain_table(L_, index) ? "{...}" : scalar(index)) + "]";
    }

    /// "name = value", or only the value for a list item.
    Piece next_item(const TableItems& items, std::size_t i, std::size_t room) {
        items.push(i);
        const std::string head = items.in_list(i) ? "" : key_text(lua_gettop(L_) - 1) + " = ";
        const std::size_t left = room > text::columns(head) ? room - text::columns(head) : 1;
        Piece value = inner(lua_gettop(L_), left);
        lua_pop(L_, 2);
        return {head + value.text, value.whole};
    }

    /// An item on its own line, with shorter numbers if it would not fit otherwise.
    Piece line_item(const TableItems& items, std::size_t i) {
        Piece item = next_item(items, i, width_ - 3);
        if (!item.whole) {
            brief_ = true;
            item = next_item(items, i, width_ - 3);
            brief_ = false;
        }
        return item;
    }

    /// A line for each item; items that are not tables share lines.
    std::string table_lines(int index) {
        const int top = lua_gettop(L_);
        open_.push_back(lua_topointer(L_, index));
        const TableItems items(L_, index);
        std::vector<std::string> lines;
        std::size_t i = 0;
        bool joinable = false;
        for (; i < items.shown(); ++i) {
            const Piece item = line_item(items, i);
            const bool simple = item.text.empty() || item.text.back() != '}';
            const bool joins =
                joinable && simple && text::columns(lines.back()) + text::columns(item.text) + 4 <= width_;
            if (!joins && lines.size() == (joinable && simple && items.in_list(i) ? most_joined_lines : most_lines)) {
                break;
            }
            if (joins) {
                lines.back() += ", " + item.text;
            } else {
                lines.push_back("  " + item.text);
            }
            joinable = simple;
        }
        open_.pop_back();
        lua_settop(L_, top);
        if (i < items.size()) {
            lines.push_back(fmt::format("  ... {} more", items.size() - i));
        }
        return fmt::format("{{\n{}\n}}", joined(lines));
    }

    static std::string joined(const std::vector<std::string>& lines) {
        std::string text;
        for (const std::string& line : lines) {
            text.append(text.empty() ? "" : ",\n").append(line);
        }
        return text;
    }

    lua_State* L_;
    terminal::Display screen_;
    std::size_t width_;
    bool brief_ = false;             // numbers with six digits
    std::vector<const void*> open_;  // the tables in progress, outermost first
};

}  // namespace

std::string show(lua_State* L, int index, const terminal::Display& screen) {
    return Printer(L, screen).value(lua_absindex(L, index));
}

std::string show_line(lua_State* L, int index, const terminal::Display& screen, std::size_t width) {
    return Printer(L, screen).line(lua_absindex(L, index), std::max<std::size_t>(width, 8));
}

}  // namespace dinal::prompt
