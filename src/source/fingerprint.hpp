// A number that stands for a Lua value and all that it takes from outside, the same in every process: whether what is
// asked now was asked before.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "lua/lua_headers.hpp"
#include "model/excitation.hpp"

namespace dinal::source {

class Fingerprint {
public:
    /// Adds the object of a class that this room does not know, at that index; false when it is none.
    using AddObject = bool (*)(lua_State* L, int index, Fingerprint& print);

    Fingerprint(lua_State* L, AddObject other_objects) : L_(L), other_objects_(other_objects) {}

    void add(std::string_view bytes);
    void add(double number);
    /// Functions by their code (not by the lines where it stands), their local variables and the globals that they
    /// name; tables whatever the order of their fields; what is there twice or leads back to itself as such.
    void add_value(int index);

    [[nodiscard]] std::uint64_t number() const { return number_; }

private:
    /// A value on the way: one that says all by itself, or a table, function or object whose turn will come.
    struct Piece {
        std::uint64_t digest;
        const void* object = nullptr;
    };

    void join(std::uint64_t digest);
    void libraries();
    Piece piece(int index);
    std::uint64_t reference(const Piece& piece);
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
    int objects_ = 0;                                          // index of a Lua table: identity -> what was met
    std::unordered_map<const void*, std::uint64_t> standard_;  // what is known by its name
    std::unordered_map<const void*, std::uint64_t> numbers_;   // of objects and variables, by when they were met first
    std::vector<const void*> order_;                           // of objects
    std::array<std::unordered_map<const void*, std::uint64_t>, 2> sketches_;  // by depth, from 1
};

}  // namespace dinal::source
