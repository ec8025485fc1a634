// The points of a sweep: every combination of the values of its parameters, the last parameter changing fastest.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "api/data.hpp"

namespace dinal::api {

class SweepGrid {
public:
    /// Each column is a parameter with at least one value.
    explicit SweepGrid(std::vector<DataColumn> parameters);

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] const std::vector<DataColumn>& parameters() const { return parameters_; }
    /// Which value of the parameter this point has.
    [[nodiscard]] std::size_t place(std::size_t parameter, std::size_t point) const {
        return point / strides_[parameter] % parameters_[parameter].size();
    }
    /// "r = 0.5, g = 1"
    [[nodiscard]] std::string text(std::size_t point) const;
    /// Sets the table on the top of the stack to the parameters of this point.
    void set_fields(lua_State* L, std::size_t point) const;
    /// The parameters as columns with a row for each of these points.
    [[nodiscard]] std::vector<DataColumn> columns(const std::vector<std::size_t>& points) const;

private:
    std::vector<DataColumn> parameters_;
    std::vector<std::size_t> strides_;
    std::size_t size_ = 1;
};

}  // namespace dinal::api
