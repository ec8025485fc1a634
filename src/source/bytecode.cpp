#include "source/bytecode.hpp"

#include <cstddef>

namespace dinal::source {
namespace {

// lundump.c, lobject.h and lopcodes.h of Lua 5.4
constexpr std::size_t header_size = 31;
constexpr std::string_view header_start("\x1bLua\x54\x00\x19\x93\r\n\x1a\n\x04\x08\x08", 15);
constexpr std::uint8_t short_string = 4, long_string = 20, integer_number = 3, float_number = 19;
constexpr std::uint32_t get_upvalue = 9, get_global = 11, set_global = 15;  // OP_GETUPVAL, OP_GETTABUP, OP_SETTABUP
constexpr int no_environment = -1;

int append_piece(lua_State* /*L*/, const void* piece, std::size_t size, void* text) {
    static_cast<std::string*>(text)->append(static_cast<const char*>(piece), size);
    return 0;
}

class CodeReader {
public:
    explicit CodeReader(std::string_view dumped) : rest_(dumped) {}

    std::optional<CodeFacts> read(int environment) {
        if (rest_.size() <= header_size + 1 || !rest_.starts_with(header_start)) return std::nullopt;
        take(header_size + 1);
        facts_.digest = digest_start;
        function(environment, Level::outermost);
        if (broken_ || !rest_.empty()) return std::nullopt;
        return std::move(facts_);
    }

private:
    enum class Level { outermost, within };

    std::string_view take(std::size_t count) {
        if (count > rest_.size()) {
            broken_ = true;
            rest_ = {};
            return {};
        }
        const std::string_view taken = rest_.substr(0, count);
        rest_.remove_prefix(count);
        return taken;
    }
    std::uint8_t byte() {
        const std::string_view one = take(1);
        return one.empty() ? std::uint8_t{0} : static_cast<std::uint8_t>(one.front());
    }
    /// Seven bits a byte, the highest first; the last byte is marked.
    std::size_t size() {
        std::size_t value = 0;
        while (!broken_) {
            const std::uint8_t next = byte();
            value = value << 7U | (next & 0x7fU);
            if ((next & 0x80U) != 0) return value;
        }
        return 0;
    }
    std::string_view string() {
        const std::size_t length = size();
        return length == 0 ? std::string_view() : take(length - 1);
    }
    void digest(std::string_view bytes) { facts_.digest = digest_of(bytes, facts_.digest); }
    template <class Read>
    void each(Read read) {
        for (std::size_t left = size(); left > 0 && !broken_; --left) read();
    }

    /// `environment` says which upvalue is the table of globals: of this function, or of the one around it.
    void function(int environment, Level level) {
        string();  // the name of its source
        size();    // and its lines
        size();
        digest(take(3));
        const std::string_view code = take(4 * size());
        digest(code);
        std::vector<std::string_view> texts;
        each([&] { texts.push_back(constant()); });
        int own = level == Level::outermost ? environment : no_environment;
        int place = 0;
        each([&] {
            const std::string_view about = take(3);
            digest(about);
            const bool of_outer = !broken_ && about[0] == 0;
            if (level == Level::within && of_outer && static_cast<std::uint8_t>(about[1]) == environment) own = place;
            ++place;
        });
        note_names(code, texts, own);
        each([&] { function(own, Level::within); });
        skip_debug_information();
    }

    std::string_view constant() {
        const std::uint8_t type = byte();
        digest({reinterpret_cast<const char*>(&type), 1});
        if (type == integer_number || type == float_number) {
            digest(take(8));
        } else if (type == short_string || type == long_string) {
            const std::string_view text = string();
            digest(text);
            digest({"\0", 1});
            return text;
        }
        return {};
    }

    void note_names(std::string_view code, const std::vector<std::string_view>& texts, int environment) {
        if (environment == no_environment) return;
        constexpr std::size_t most_indexed = 255;  // the name of a later constant comes to the table in a register
        bool hidden = texts.size() > most_indexed;
        for (std::size_t at = 0; at + 4 <= code.size(); at += 4) {
            std::uint32_t instruction = 0;
            for (std::size_t i = 0; i < 4; ++i) {
                instruction |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(code[at + i])) << (8 * i);
            }
            const std::uint32_t operation = instruction & 0x7fU;
            const std::uint32_t a = instruction >> 7U & 0xffU, b = instruction >> 16U & 0xffU, c = instruction >> 24U;
            const auto own = static_cast<std::uint32_t>(environment);
            if (operation == get_global && b == own && c < texts.size()) facts_.globals.emplace_back(texts[c]);
            if (operation == set_global && a == own && b < texts.size()) facts_.globals.emplace_back(texts[b]);
            hidden = hidden || (operation == get_upvalue && b == own) ||
                     (operation == get_global && b == own && c < texts.size() && texts[c] == "_G");
        }
        if (hidden) facts_.perhaps.insert(facts_.perhaps.end(), texts.begin(), texts.end());
    }

    void skip_debug_information() {
        take(size());
        each([&] { size(), size(); });
        each([&] { string(), size(), size(); });
        each([&] { string(); });
    }

    std::string_view rest_;
    bool broken_ = false;
    CodeFacts facts_;
};

}  // namespace

std::string dumped_function(lua_State* L, int index) {
    std::string dumped;
    lua_pushvalue(L, index);
    lua_dump(L, append_piece, &dumped, 0);
    lua_pop(L, 1);
    return dumped;
}

std::optional<CodeFacts> facts_of_code(std::string_view dumped, int environment) {
    return CodeReader(dumped).read(environment);
}

std::uint64_t digest_of(std::string_view bytes, std::uint64_t before) {
    constexpr std::uint64_t prime = 0x100000001b3U;
    for (const char c : bytes) before = (before ^ static_cast<std::uint8_t>(c)) * prime;
    return before;
}

}  // namespace dinal::source
