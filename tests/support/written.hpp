// User functions as C++ lambdas, and runs with additional features.
#pragma once

#include <functional>
#include <utility>

#include "model/drive.hpp"
#include "support/catch.hpp"
#include "support/measure.hpp"

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
inline model::Excitation feedback(Body body) {
    return native(model::Scripted{.function = written(std::move(body)), .feedback = true});
}

inline motion::Run run_more(const model::Oscillator& system, const model::Drive& drive, double t_end, double dt,
                            motion::MethodView method) {
    auto run = motion::simulate(system, drive, {0, t_end}, motion::Grid::every(dt), method);
    if (!run) FAIL(run.error().sentence);
    return std::move(run).value();
}

}  // namespace dinal::truth
