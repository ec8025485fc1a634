#include "source/bytecode.hpp"

#include <cstddef>

#include "lua/prototype.hpp"

namespace dinal::source {
namespace {

constexpr std::uint32_t get_upvalue = 9, get_global = 11, set_global = 15;  // OP_GETUPVAL, OP_GETTABUP, OP_SETTABUP
constexpr int no_environment = -1;

/// The upvalue of an inner function that is this function's table of globals.
int environment_within(const lua::Prototype& inner, int environment) {
    int found = no_environment;
    for (std::size_t i = 0; i < inner.variables.size(); ++i) {
        const std::string_view about = inner.variables[i];
        if (about[0] == 0 && static_cast<std::uint8_t>(about[1]) == environment) found = static_cast<int>(i);
    }
    return found;
}

void note_names(const lua::Prototype& function, int environment, CodeFacts& facts) {
    if (environment == no_environment) return;
    constexpr std::size_t most_indexed = 255;  // names of later constants are passed in a register
    const auto& texts = function.constants;
    bool hidden = texts.size() > most_indexed;
    for (std::size_t at = 0; at < function.size(); ++at) {
        const std::uint32_t instruction = function.instruction(at), operation = instruction & 0x7fU;
        const std::uint32_t a = instruction >> 7U & 0xffU, b = instruction >> 16U & 0xffU, c = instruction >> 24U;
        const auto own = static_cast<std::uint32_t>(environment);
        if (operation == get_global && b == own && c < texts.size()) facts.globals.emplace_back(texts[c].text);
        if (operation == set_global && a == own && b < texts.size()) facts.globals.emplace_back(texts[b].text);
        hidden = hidden || (operation == get_upvalue && b == own) ||
                 (operation == get_global && b == own && c < texts.size() && texts[c].text == "_G");
    }
    if (!hidden) return;
    for (const auto& constant : texts) facts.perhaps.emplace_back(constant.text);
}

void note(const lua::Prototype& function, int environment, CodeFacts& facts) {
    const auto digest = [&facts](std::string_view bytes) { facts.digest = digest_of(bytes, facts.digest); };
    digest(function.frame);
    digest(function.code);
    for (const auto& constant : function.constants) {
        digest({reinterpret_cast<const char*>(&constant.type), 1});
        digest(constant.number);
        const bool is_text = constant.type == lua::Prototype::short_text || constant.type == lua::Prototype::long_text;
        if (is_text) digest(constant.text), digest({"\0", 1});
    }
    for (const std::string_view variable : function.variables) digest(variable);
    note_names(function, environment, facts);
    for (const lua::Prototype& inner : function.inner) note(inner, environment_within(inner, environment), facts);
}

}  // namespace

std::optional<CodeFacts> facts_of_code(std::string_view dumped, int environment) {
    const auto function = lua::prototype_in(dumped);
    if (!function) return std::nullopt;
    CodeFacts facts;
    facts.digest = digest_start;
    note(*function, environment, facts);
    return facts;
}

std::uint64_t digest_of(std::string_view bytes, std::uint64_t before) {
    constexpr std::uint64_t prime = 0x100000001b3U;
    for (const char c : bytes) before = (before ^ static_cast<std::uint8_t>(c)) * prime;
    return before;
}

}  // namespace dinal::source
