// A hash of a Lua value and everything it refers to, the same in every process; it detects that a computation is
// repeated.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "lua/lua_headers.hpp"
#include "model/excitation.hpp"

namespace dinal::source {

class Fingerprint {
public:
    /// Adds an object of a class that this room does not know. Returns false if the value is not such an object.
    using AddObject = bool (*)(lua_State* L, int index, Fingerprint& print);

    Fingerprint(lua_State* L, AddObject other_objects) : L_(L), other_objects_(other_objects) {}

    void add(std::string_view bytes);
    void add(double number);
    /// Functions count by their code (not their lines), their upvalues and the globals they name; tables count
    /// regardless of the order of fields, and shared or cyclic references by identity.
    void add_value(int index);

    std::uint64_t number() const { return number_; }

private:
    /// A visited value: a complete digest, or a table, function or object to be visited later.
    struct Visited {
        std::uint64_t digest;
        const void* object = nullptr;
    };

    void join(std::uint64_t digest);
    void libraries();
    Visited piece(int index);
    std::uint64_t reference(const Visited& piece);
    std::uint64_t reference(int index) { return reference(piece(index)); }
    std::uint64_t sketch(int index, int depth);

    void content(int index);
    void table(int index);
    void function(int index);
    void object(int index);
    std::string printed(int index);
    void excitation(const model::Excitation& excitation);
    void user_function(const model::terms::UserFunction& function);
    void global(const std::string& name);

    lua_State* L_;
    AddObject other_objects_;
    std::uint64_t number_ = 0xcbf29ce484222325U;
    int objects_ = 0;                                          // index of a Lua table: identity -> known object
    std::unordered_map<const void*, std::uint64_t> standard_;  // values known by name
    std::unordered_map<const void*, std::uint64_t> numbers_;   // numbers of objects and variables by first visit
    std::vector<const void*> order_;                           // objects in the order of visits
    std::array<std::unordered_map<const void*, std::uint64_t>, 2> sketches_;  // digests by depth, from 1
};

struct CodeFacts {
    std::vector<std::string> globals;  ///< names that the function, or an inner one, reads or sets in its environment
    std::vector<std::string> perhaps;  ///< texts that may be such names, used in a way that cannot be traced
    std::uint64_t digest = 0;          ///< hash of instructions and constants
};

/// Analyses the output of lua_dump with debug information; `environment` is the upvalue (from 0) that is the table of
/// globals, -1 for none. None if the format is not that of Lua 5.4.
std::optional<CodeFacts> facts_of_code(std::string_view dumped, int environment);

/// FNV-1a, 64 bits: continues the hash `before` with `bytes`.
constexpr std::uint64_t digest_start = 0xcbf29ce484222325U;
std::uint64_t digest_of(std::string_view bytes, std::uint64_t before = digest_start);

}  // namespace dinal::source
