// Abbreviations for tests of excitations.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "model/excitation.hpp"
#include "support/catch.hpp"

namespace dinal::excitations {

inline constexpr double pi = std::numbers::pi;

// The formulas are evaluated as written, so the tolerance allows a few roundings of numbers of order one.
inline const auto near = [](double x) { return Approx(x).margin(1e-14).epsilon(1e-14); };

inline model::Excitation made(model::Term term) {
    auto result = model::Excitation::make(std::move(term));
    INFO((result ? "" : result.error().sentence));
    REQUIRE(result);
    return *result;
}

inline std::string complaint(model::Term term) {
    auto result = model::Excitation::make(std::move(term));
    return result ? "" : result.error().sentence;
}

inline double just_before(double t) {
    return std::nextafter(t, -model::never);
}

inline std::shared_ptr<const model::Samples> table(std::vector<double> t, std::vector<double> M) {
    return std::make_shared<const model::Samples>(model::Samples{std::move(t), std::move(M)});
}

/// A user's function for tests, which counts its calls and records the last time.
class Probe : public model::UserFunction {
public:
    explicit Probe(std::function<double(double, const model::State&)> f) : f_(std::move(f)) {}
    double value(double t, const model::State& state) override {
        ++calls;
        last = t;
        return f_(t, state);
    }
    int calls = 0;
    double last = 0;

private:
    std::function<double(double, const model::State&)> f_;
};

inline std::shared_ptr<Probe> probe(std::function<double(double)> f) {
    return std::make_shared<Probe>([f](double t, const model::State&) { return f(t); });
}

inline std::vector<model::Excitation> one_of_each() {
    return {made(model::Constant{2}),
            made(model::Harmonic{1.5, 3, 0.2}),
            made(model::Step{2, 0.3}),
            made(model::Pulse{2, 0.1, 0.7}),
            made(model::HalfSine{2, 0.1, 0.7}),
            made(model::Gaussian{2, 0.4, 0.1}),
            made(model::Ramp{2, 0.1, 0.7}),
            made(model::Square{2, 0.3, 0.3, 0.1}),
            made(model::Sawtooth{2, 0.3, 0.1}),
            made(model::Triangle{2, 0.3, 0.1}),
            made(model::Chirp{2, 0.5, 3, 2, 0.1, 0.4}),
            made(model::Exponential{2, 0.8, 0.1}),
            made(model::Polynomial{{1, -2, 0.5}, 0.1}),
            made(table({0.1, 0.3, 0.35, 1.2}, {1, -2, 4, 0.5})),
            made(model::Scripted{
                .function = probe([](double t) { return std::cos(t); }), .breaks = {0.1, 0.2}, .period = 0.7})};
}

inline std::vector<double> breaks_of(const model::Excitation& M, double from, double to) {
    std::vector<double> found;
    for (double t = M.next_break(from); t <= to; t = M.next_break(t)) {
        found.push_back(t);
    }
    return found;
}

}  // namespace dinal::excitations
