// M(t): a flat sum of small value terms, native or scripted, each knowing its value, its breaks and whole blocks.
//
// Every term is continuous from the right: at a break, value(t) is already the new level.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "model/components.hpp"
#include "model/oscillator.hpp"
#include "text/expected.hpp"

namespace dinal::model {

/// Times that lie about a middle in the same way again and again, as the nodes of panels do.
struct Spread {
    /// What a sine makes of these distances from the middle.
    struct Turn {
        double omega = 0, half = 0;
        std::vector<double> sine{}, cosine{};
    };

    std::span<const double> places;   ///< from -1 to 1, the same on both sides of 0
    std::size_t first = 0;            ///< the place of the first time that is asked for
    double middle = 0, rest = 0;      ///< the time of place 0, and what was rounded off it
    double half = 0;                  ///< from there to place 1
    std::span<const double> rests{};  ///< what was rounded off each time, for the terms that tell such times apart
    std::vector<Turn> turns{};        ///< of each sine in its turn: as a rule those of the times before
    std::size_t next_turn = 0;

    const Turn& turn(double omega);
};

class Excitation {
public:
    /// M = 0.
    Excitation() = default;
    /// Fails with a sentence that names the option, its value and its range.
    static text::Expected<Excitation> make(Term term);

    [[nodiscard]] double value(double t, const State& state = {}) const;
    /// The limit from the left: differs from value(t) only where M jumps.
    [[nodiscard]] double value_before(double t, const State& state = {}) const;
    /// The limit from the right: value(t), but a scripted function is asked a hair later, since its author may have
    /// written `t > 0.5` as well as `t >= 0.5`.
    [[nodiscard]] double value_after(double t, const State& state = {}) const;
    /// The first time after t at which M or a derivative of it jumps; `never` if there is none.
    [[nodiscard]] double next_break(double t) const;
    /// From when on M is known to be constant for ever; `never` when that is not known.
    [[nodiscard]] double constant_from() const;
    /// What |M| never exceeds; `never` when that is not known.
    [[nodiscard]] double most() const;
    /// How far from t one may look at M at times that are at most `spacing` of this length apart, and overlook no
    /// detail of a smooth term; `never` when there is none ahead.
    [[nodiscard]] double view(double t, double spacing) const;
    /// The detail between two times that must be looked at most closely.
    [[nodiscard]] terms::Detail finest_detail(double from, double to) const;
    /// M needs theta and velocity.
    [[nodiscard]] bool has_feedback() const;
    [[nodiscard]] bool has_script() const;
    /// All of it is known at times between two doubles.
    [[nodiscard]] bool tells_rests() const;
    /// out[i] = value(times[i]); not for feedback. Returns how many were filled: fewer when one is not finite.
    std::size_t fill(std::span<const double> times, std::span<double> out, Spread* spread = nullptr) const;

    /// After a value that was not finite: whether the functions in it may be asked again, at other times.
    [[nodiscard]] bool may_go_on() const;
    /// Calls it with each function of the user's.
    void each_function(const std::function<void(UserFunction&)>& call) const;

    [[nodiscard]] Excitation scaled(double gain) const;
    [[nodiscard]] Excitation delayed(double delay) const;
    /// 0 outside from <= t < to.
    [[nodiscard]] Excitation windowed(double from, double to) const;
    /// The same with another in place of every user's function.
    using FunctionChange = std::function<std::shared_ptr<UserFunction>(const std::shared_ptr<UserFunction>&)>;
    [[nodiscard]] Excitation with_functions(const FunctionChange& other) const;
    friend Excitation operator+(const Excitation& a, const Excitation& b);

    [[nodiscard]] std::span<const Component> components() const { return components_.all(); }

private:
    explicit Excitation(Components components) : components_(std::move(components)) {}
    /// The same with every component changed.
    template <class Change>
    [[nodiscard]] Excitation changed(Change change) const;

    Components components_;
};

}  // namespace dinal::model
