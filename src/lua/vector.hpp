// A vector of numbers as Lua sees it: immutable, either a view into something that it keeps alive or its own data.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lua/bind.hpp"
#include "lua/lua_headers.hpp"

namespace dinal::lua {

class Vector {
public:
    explicit Vector(std::vector<double> values) {
        const auto own = std::make_shared<const std::vector<double>>(std::move(values));
        values_ = *own;
        owner_ = own;
    }
    /// A view of numbers that belong to `owner` (a trajectory). Shared, because a column may outlive the run's
    /// variable.
    Vector(std::shared_ptr<const void> owner, const double* data, std::size_t size)
        : owner_(std::move(owner)), values_(data, size) {}

    [[nodiscard]] std::span<const double> values() const { return values_; }
    [[nodiscard]] std::size_t size() const { return values_.size(); }
    [[nodiscard]] const double* begin() const { return values_.data(); }
    [[nodiscard]] const double* end() const { return values_.data() + values_.size(); }

private:
    std::shared_ptr<const void> owner_;
    std::span<const double> values_;
};

/// n zeros. Where memory is limited, garbage makes room for them.
std::vector<double> new_numbers(lua_State* L, std::size_t n);

/// Gives Lua a vector with data of its own, and its garbage collector the news of how much memory that takes;
/// returns 1, as a function with one result.
int push_vector(lua_State* L, std::vector<double> values);

/// "x" or "[2]": a field of the table at `index` besides 1 to #t, which no list has; empty when there is none.
std::string key_beside_list(lua_State* L, int index);

/// The finite numbers of a table or a vector at `index`, which is that option of the call, or all that it takes. They
/// head the sentence when there is something else: "sys:simulate: times".
std::vector<double> numbers_at(lua_State* L, int index, std::string_view call, std::string_view option = "");

// Numbers with gaps: nan where nothing was measured.

/// The numbers of a table or a vector at `index`, which is that option of the call; nan is one, infinity is not.
std::vector<double> numbers_with_gaps_at(lua_State* L, int index, std::string_view call, std::string_view option);

}  // namespace dinal::lua
