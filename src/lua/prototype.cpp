#include "lua/prototype.hpp"

namespace dinal::lua {
namespace {

// lundump.c, lobject.h and lopcodes.h of Lua 5.4
constexpr std::size_t header_size = 31;
constexpr std::string_view header_start("\x1bLua\x54\x00\x19\x93\r\n\x1a\n\x04\x08\x08", 15);

int append_piece(lua_State* /*L*/, const void* piece, std::size_t size, void* text) {
    static_cast<std::string*>(text)->append(static_cast<const char*>(piece), size);
    return 0;
}

/// Reads the output of lua_dump; with the right header it is complete.
class DumpReader {
public:
    explicit DumpReader(std::string_view dumped) : rest_(dumped) {}

    std::optional<Prototype> read() {
        if (rest_.size() <= header_size + 1 || !rest_.starts_with(header_start)) return std::nullopt;
        take(header_size + 1);
        return function();
    }

private:
    std::string_view take(std::size_t count) {
        const std::string_view piece = rest_.substr(0, count);
        rest_.remove_prefix(count);
        return piece;
    }
    std::uint8_t byte() { return static_cast<std::uint8_t>(take(1).front()); }
    /// Reads a number of seven bits per byte, the highest first; the last byte is marked.
    std::size_t size() {
        std::size_t value = 0;
        for (;;) {
            const std::uint8_t next = byte();
            value = value << 7U | (next & 0x7fU);
            if ((next & 0x80U) != 0) return value;
        }
    }
    std::string_view string() {
        const std::size_t length = size();
        return length == 0 ? std::string_view() : take(length - 1);
    }
    template <class Read>
    void each(Read read) {
        for (std::size_t left = size(); left > 0; --left) read();
    }

    Prototype function() {
        Prototype made;
        string();  // the name of its source
        const std::size_t first_line = size();
        size();  // the last line
        made.frame = take(3);
        made.code = take(4 * size());
        each([&] { made.constants.push_back(constant()); });
        each([&] { made.variables.push_back(take(3)); });
        each([&] { made.inner.push_back(function()); });
        lines(made, first_line);
        each([&] { string(), size(), size(); });
        each([&] { made.names.push_back(string()); });
        return made;
    }

    Prototype::Constant constant() {
        Prototype::Constant made{byte(), {}, {}};
        if (made.type == Prototype::integer_number || made.type == Prototype::float_number) made.number = take(8);
        if (made.type == Prototype::short_text || made.type == Prototype::long_text) made.text = string();
        return made;
    }

    /// Reads line steps between instructions, and absolute lines for larger steps.
    void lines(Prototype& made, std::size_t first_line) {
        constexpr signed char too_far = -128;
        const std::string_view steps = take(size());
        std::vector<std::size_t> jumps;
        each([&] { size(), jumps.push_back(size()); });
        std::size_t line = first_line, jump = 0;
        for (const char step : steps) {
            const bool far = static_cast<signed char>(step) == too_far && jump < jumps.size();
            line = far ? jumps[jump++] : line + static_cast<std::size_t>(static_cast<signed char>(step));
            made.lines.push_back(static_cast<int>(line));
        }
    }

    std::string_view rest_;
};

}  // namespace

std::uint32_t Prototype::instruction(std::size_t at) const {
    std::uint32_t read = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        read |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(code[4 * at + i])) << (8 * i);
    }
    return read;
}

std::string dumped_function(lua_State* L, int index, bool stripped) {
    std::string dumped;
    lua_pushvalue(L, index);
    lua_dump(L, append_piece, &dumped, stripped ? 1 : 0);
    lua_pop(L, 1);
    return dumped;
}

std::optional<Prototype> prototype_in(std::string_view dumped) {
    return DumpReader(dumped).read();
}

}  // namespace dinal::lua
