// A number that stands for a Lua value and all that it takes from outside, the same in every process: whether what is
// asked now was asked before.
#pragma once

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
    explicit Fingerprint(lua_State* L) : L_(L) {}

    void add(std::string_view bytes);
    void add(double number);
    /// Functions by their code (not by the lines where it stands), their local variables and the globals that they
    /// name; tables whatever the order of their fields.
    void add_value(int index);

    [[nodiscard]] std::uint64_t number() const { return number_; }
    /// 16 digits.
    [[nodiscard]] std::string text() const;

private:
    std::uint64_t of_value(int index);
    std::uint64_t of_table(int index);
    std::uint64_t of_function(int index);
    std::uint64_t of_object(int index);
    std::uint64_t of_excitation(const model::Excitation& excitation);
    std::uint64_t of_user_function(const model::terms::UserFunction& function);
    std::uint64_t of_global(const std::string& name);

    lua_State* L_;
    std::uint64_t number_ = 0xcbf29ce484222325U;
    std::unordered_map<const void*, std::uint64_t> known_;  // what is being looked at has a number of its own
};

}  // namespace dinal::source
