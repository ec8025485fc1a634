// Vectors of numbers for Lua: immutable, either a view that keeps its owner alive or with their own data.
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
    /// A view of numbers owned by `owner` (a run), which it keeps alive.
    Vector(std::shared_ptr<const void> owner, const double* data, std::size_t size)
        : owner_(std::move(owner)), values_(data, size) {}

    std::span<const double> values() const { return values_; }
    std::size_t size() const { return values_.size(); }
    const double* begin() const { return values_.data(); }
    const double* end() const { return values_.data() + values_.size(); }

private:
    std::shared_ptr<const void> owner_;
    std::span<const double> values_;
};

/// n zeros. With a memory limit, garbage is collected to make room.
std::vector<double> new_numbers(lua_State* L, std::size_t n);

/// Pushes a vector with its own data and reports its size to the garbage collector; returns 1, the number of results.
int push_vector(lua_State* L, std::vector<double> values);

/// A key of the table at `index` other than 1 to #t, as "x" or "[2]"; empty for a proper list.
std::string key_beside_list(lua_State* L, int index);

/// The finite numbers of a table or vector at `index`, the value of an option, or the only argument. Errors begin with
/// the call and the option: "sys:simulate: times".
std::vector<double> numbers_at(lua_State* L, int index, std::string_view call, std::string_view option = "");

// Numbers with gaps: nan marks a missing measurement.

/// Like numbers_at(), but accepts nan; not infinity.
std::vector<double> numbers_with_gaps_at(lua_State* L, int index, std::string_view call, std::string_view option);

}  // namespace dinal::lua
