#include "api/sweep_grid.hpp"

#include <algorithm>

namespace dinal::api {

SweepGrid::SweepGrid(std::vector<DataColumn> parameters)
    : parameters_(std::move(parameters)), strides_(parameters_.size()) {
    for (std::size_t i = parameters_.size(); i-- > 0;) {
        strides_[i] = size_;
        size_ *= parameters_[i].size();
    }
}

std::string SweepGrid::text(std::size_t point) const {
    std::string text;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        text += (i == 0 ? "" : ", ") + parameters_[i].name + " = " + parameters_[i].text(place(i, point));
    }
    return text;
}

void SweepGrid::set_fields(lua_State* L, std::size_t point) const {
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        const DataColumn& parameter = parameters_[i];
        lua::push_text(L, parameter.name);
        if (const lua::Vector* numbers = parameter.numbers()) {
            lua_pushnumber(L, numbers->begin()[place(i, point)]);
        } else {
            lua::push_text(L, (*std::get<Words>(parameter.values))[place(i, point)]);
        }
        lua_rawset(L, -3);
    }
}

std::vector<DataColumn> SweepGrid::columns(const std::vector<std::size_t>& points) const {
    std::vector<DataColumn> columns;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        const DataColumn& parameter = parameters_[i];
        if (const lua::Vector* numbers = parameter.numbers()) {
            std::vector<double> values(points.size());
            std::transform(points.begin(), points.end(), values.begin(),
                           [&](std::size_t point) { return numbers->begin()[place(i, point)]; });
            columns.push_back(column_of(parameter.name, std::move(values)));
        } else {
            const std::vector<std::string>& words = *std::get<Words>(parameter.values);
            std::vector<std::string> values(points.size());
            std::transform(points.begin(), points.end(), values.begin(),
                           [&](std::size_t point) { return words[place(i, point)]; });
            columns.push_back(column_of(parameter.name, std::move(values)));
        }
    }
    return columns;
}

}  // namespace dinal::api
