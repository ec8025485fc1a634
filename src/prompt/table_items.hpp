// The items of a Lua table in the order in which they are shown.
#pragma once

#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::prompt {

/// 1, 2, ... n, then other numbers, the time t (events have one), other names, and the rest.
// NOTE: the keys that are not 1 to n stand in a Lua table that this leaves on the stack. No destructor may take it off:
// while a Lua error unwinds, its message is what is on the top.
class TableItems {
public:
    TableItems(lua_State* L, int index);

    [[nodiscard]] std::size_t size() const { return listed_ + others_; }
    /// Of a huge table not all can be shown.
    [[nodiscard]] std::size_t shown() const { return listed_ + order_.size(); }
    /// Item i is one of 1, 2, ... n.
    [[nodiscard]] bool in_list(std::size_t i) const { return i < listed_; }

    /// Pushes the key and the value of item i.
    void push(std::size_t i) const;

private:
    using Key = std::tuple<int, double, std::string, lua_Integer>;  // rank, number, name, place in the table of keys

    void collect();
    void add_key();
    [[nodiscard]] bool key_is_listed() const;

    lua_State* L_;
    int table_;
    int keys_ = 0;
    std::size_t listed_;
    std::size_t others_ = 0;
    std::vector<Key> order_;
};

}  // namespace dinal::prompt
