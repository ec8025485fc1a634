// User functions as C++ lambdas.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <utility>

#include "model/drive.hpp"

namespace dinal::truth {

using Body = std::function<double(double t, const model::State& y, std::span<const double> z)>;

class Written final : public model::UserFunction {
public:
    explicit Written(Body body) : body_(std::move(body)) {}
    double value(double t, const model::State& y) override { return body_(t, y, {}); }
    double value_with(double t, const model::State& y, std::span<const double> z) override { return body_(t, y, z); }

private:
    Body body_;
};

inline std::shared_ptr<model::UserFunction> written(Body body) {
    return std::make_shared<Written>(std::move(body));
}
inline model::Excitation native(model::Term term) {
    return model::Excitation::make(std::move(term)).value();
}

}  // namespace dinal::truth
