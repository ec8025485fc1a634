#include "repl/printer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "lua/interrupt.hpp"
#include "repl/quoted.hpp"
#include "repl/table_items.hpp"

namespace dinal {
namespace {

constexpr std::size_t deepest = 3;            // tables within tables; further ones are {...}
constexpr std::size_t most_lines = 24;        // of one value,
constexpr std::size_t most_joined_lines = 6;  // of a long list of numbers
constexpr std::size_t longest_string = 1000;
constexpr std::size_t width_of_line = 80;   // a longer string of several lines is a text, as from run:explain(),
constexpr std::size_t longest_text = 4000;  // up to this
constexpr std::size_t longest_inner_string = 60;

std::string text_of(lua_State* L, int index) {
    std::size_t size = 0;
    const char* text = lua_tolstring(L, index, &size);
    return {text, size};
}

int to_text(lua_State* L) {
    luaL_tolstring(L, 1, nullptr);
    return 1;
}

/// What tostring says, or that it failed. Ctrl-C ends the whole display.
std::string told(lua_State* L, int index) {
    lua_pushvalue(L, index);
    lua_pushcfunction(L, to_text);
    lua_insert(L, -2);
    const bool fine = lua_pcall(L, 1, 1, 0) == LUA_OK;
    if (!fine && interrupt_requested()) {
        raise_interrupted(L);
    }
    std::string text = lua_isstring(L, -1) != 0 ? text_of(L, -1) : std::string(luaL_typename(L, -1));
    lua_pop(L, 1);
    return fine ? text : fmt::format("<error in __tostring: {}>", text);
}

bool has_tostring(lua_State* L, int index) {
    if (luaL_getmetafield(L, index, "__tostring") == LUA_TNIL) {
        return false;
    }
    lua_pop(L, 1);
    return true;
}

bool is_name(std::string_view text) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    const auto fits = [letter](char c) { return letter(c) || (c >= '0' && c <= '9'); };
    return !text.empty() && letter(text[0]) && std::all_of(text.begin(), text.end(), fits);
}

/// One value, but tables only when they speak for themselves.
std::string scalar(lua_State* L, int index, bool inside) {
    switch (lua_type(L, index)) {
        case LUA_TNUMBER:
            return std::isnan(lua_tonumber(L, index)) ? "nan" : told(L, index);
        case LUA_TSTRING: {
            std::string text = text_of(L, index);
            if (!inside && text.size() > width_of_line && text.size() <= longest_text && is_lines(text)) {
                return text;
            }
            const std::size_t limit = inside ? longest_inner_string : longest_string;
            return quoted(text, limit) +
                   (!inside && text.size() > limit ? fmt::format(" ({} bytes)", text.size()) : "");
        }
        case LUA_TFUNCTION:
            return inside ? "function" : told(L, index);
        default:
            break;
    }
    std::string text = told(L, index);
    const std::size_t end = text.find('\n');
    return inside && end != std::string::npos ? text.substr(0, end) + "..." : text;
}

struct Piece {
    std::string text;
    bool whole = true;  // nothing was left out for lack of room
};

class Printer {
public:
    Printer(lua_State* L, std::size_t width) : L_(L), width_(std::max<std::size_t>(width, 20)) {}

    std::string value(int index) {
        if (!is_plain_table(index)) {
            return scalar(L_, index, false);
        }
        const Piece line = table_line(index, width_);
        return line.whole ? line.text : table_lines(index);
    }

private:
    bool is_plain_table(int index) const { return lua_istable(L_, index) && !has_tostring(L_, index); }

    bool is_fraction(int index) const {
        const double number = lua_type(L_, index) == LUA_TNUMBER ? lua_tonumber(L_, index) : 0;
        return std::isfinite(number) && number != std::floor(number);
    }

    /// A value inside a table, in `room` columns if it can be cut.
    Piece inner(int index, std::size_t room) {
        if (!is_plain_table(index)) {
            return {brief_ && is_fraction(index) ? fmt::format("{:.6g}", lua_tonumber(L_, index))
                                                 : scalar(L_, index, true)};
        }
        const void* address = lua_topointer(L_, index);
        if (std::find(open_.begin(), open_.end(), address) != open_.end()) {
            return {"<cycle>"};
        }
        return open_.size() >= deepest ? Piece{"{...}"} : table_line(index, room);
    }

    /// The items that fit, on one line.
    Piece table_line(int index, std::size_t room) {
        luaL_checkstack(L_, 8, "tables are nested too deep");
        const int top = lua_gettop(L_);
        open_.push_back(lua_topointer(L_, index));
        const TableItems items(L_, index);
        Piece line{"{"};
        std::size_t used = 3;  // the braces and a space
        for (std::size_t i = 0; i < items.size(); ++i) {
            const std::size_t left = room > used + 2 ? room - used - 2 : 0;
            Piece item = left > 0 && i < items.shown() ? next_item(items, i, left) : Piece{"", false};
            if (i >= items.shown() || columns(item.text) > left || left == 0) {
                line.text += fmt::format("{}... {} more", i == 0 ? " " : ", ", items.size() - i);
                line.whole = false;
                break;
            }
            line.whole = line.whole && item.whole;
            line.text.append(i == 0 ? " " : ", ").append(item.text);
            used += columns(item.text) + 2;
        }
        open_.pop_back();
        lua_settop(L_, top);
        line.text += line.text.size() == 1 ? "}" : " }";
        return line;
    }

    std::string key_text(int index) const {
        std::string text = is_plain_table(index) ? "{...}" : scalar(L_, index, true);
        const bool name = lua_type(L_, index) == LUA_TSTRING && is_name(text_of(L_, index));
        return name ? text_of(L_, index) : "[" + text + "]";
    }

    /// "name = value", or only the value for an item of the list.
    Piece next_item(const TableItems& items, std::size_t i, std::size_t room) {
        items.push(i);
        const std::string head = items.in_list(i) ? "" : key_text(lua_gettop(L_) - 1) + " = ";
        const std::size_t left = room > columns(head) ? room - columns(head) : 1;
        Piece value = inner(lua_gettop(L_), left);
        lua_pop(L_, 2);
        return {head + value.text, value.whole};
    }

    /// An item on a line of its own: with short numbers when all of it does not fit otherwise.
    Piece line_item(const TableItems& items, std::size_t i) {
        Piece item = next_item(items, i, width_ - 3);
        if (!item.whole) {
            brief_ = true;
            item = next_item(items, i, width_ - 3);
            brief_ = false;
        }
        return item;
    }

    /// A line for each item, but items that are no tables share lines while they fit.
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
            const bool joins = joinable && simple && columns(lines.back()) + columns(item.text) + 4 <= width_;
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
    std::size_t width_;
    bool brief_ = false;             // numbers with six digits
    std::vector<const void*> open_;  // the tables that are being shown, outermost first
};

}  // namespace

std::string show(lua_State* L, int index, std::size_t width) {
    return Printer(L, width).value(lua_absindex(L, index));
}

}  // namespace dinal
