#include "prompt/printer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lua/lua_text.hpp"
#include "prompt/scalar_text.hpp"
#include "prompt/table_items.hpp"
#include "text/characters.hpp"

namespace dinal::prompt {
namespace {

constexpr std::size_t deepest = 3;            // tables within tables; further ones are {...}
constexpr std::size_t most_lines = 24;        // of one value,
constexpr std::size_t most_joined_lines = 6;  // of a long list of numbers

bool is_fraction(lua_State* L, int index) {
    const double number = lua_type(L, index) == LUA_TNUMBER ? lua_tonumber(L, index) : 0;
    return std::isfinite(number) && number != std::floor(number);
}

/// The first columns of a text, and three dots.
std::string shortened(std::string_view text, std::size_t width) {
    return std::string(text::cut_to_columns(text, width > 3 ? width - 3 : 0)) + "...";
}

struct Piece {
    std::string text;
    bool whole = true;  // nothing was left out for lack of room
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
    [[nodiscard]] std::string scalar(int index) const { return scalar_text(L_, index, Place::inside, screen_); }

    /// A value inside a table, in `room` columns if it can be cut.
    Piece inner(int index, std::size_t room) {
        if (!is_plain_table(L_, index)) {
            const bool short_number = brief_ && is_fraction(L_, index);
            Piece item{short_number ? fmt::format("{:.6g}", lua_tonumber(L_, index)) : scalar(index)};
            if (lua_isuserdata(L_, index) != 0 &&
                text::columns(item.text) > room) {  // of our objects the beginning will do
                item = {shortened(item.text, room), false};
            }
            return item;
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

    /// "name = value", or only the value for an item of the list.
    Piece next_item(const TableItems& items, std::size_t i, std::size_t room) {
        items.push(i);
        const std::string head = items.in_list(i) ? "" : key_text(lua_gettop(L_) - 1) + " = ";
        const std::size_t left = room > text::columns(head) ? room - text::columns(head) : 1;
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
    std::vector<const void*> open_;  // the tables that are being shown, outermost first
};

}  // namespace

std::string show(lua_State* L, int index, const terminal::Display& screen) {
    return Printer(L, screen).value(lua_absindex(L, index));
}

std::string show_line(lua_State* L, int index, const terminal::Display& screen, std::size_t width) {
    return Printer(L, screen).line(lua_absindex(L, index), std::max<std::size_t>(width, 8));
}

}  // namespace dinal::prompt
