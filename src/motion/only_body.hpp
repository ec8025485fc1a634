// The functions of the only body of a system, for a method that knows no names of bodies.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <utility>

#include "model/drive.hpp"

namespace dinal::motion {

/// A function of the motion of bodies with names, asked as that of one body without a name.
class OnlyBody final : public model::UserFunction {
public:
    explicit OnlyBody(std::shared_ptr<model::UserFunction> function) : function_(std::move(function)) {}

    double value(double t, const model::State& state) override {
        const std::array<double, 2> motion{state.theta, state.velocity};
        return function_->value_with(t, state, motion);
    }
    double next_break(double t) override { return function_->next_break(t); }
    bool may_go_on() override { return function_->may_go_on(); }
    void forget_failure() override { function_->forget_failure(); }

    /// The drive with the functions of M asked so. Controllers stay: no such method takes them.
    [[nodiscard]] static model::Drive drive(model::Drive drive) {
        const auto asked = [](const std::shared_ptr<model::UserFunction>& function) {
            const bool controls = dynamic_cast<const model::Controller*>(function.get()) != nullptr;
            return controls ? function : std::make_shared<OnlyBody>(function);
        };
        if (drive.M().has_feedback()) drive.loads.front() = drive.M().with_functions(asked);
        return drive;
    }

private:
    std::shared_ptr<model::UserFunction> function_;
};

}  // namespace dinal::motion
