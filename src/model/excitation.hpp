// M(t): a sum of terms, native or scripted. Each term computes its value, its breaks, and whole blocks of values.
//
// Terms are continuous from the right: at a break, value(t) is already the new level.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "model/oscillator.hpp"
#include "model/terms.hpp"
#include "text/expected.hpp"

namespace dinal::model {

/// gain * term for from <= t < to, otherwise 0
struct Component {
    double gain = 1;
    Term term;
    double from = -never, to = never;
};

/// The time from which the component is constant for ever; `never` if unknown.
double constant_from(const Component& component);
/// The first time after t at which the component or a derivative of it jumps; `never` if there is none.
double next_break(const Component& component, double t);
/// The finest detail of the component within its window; empty (from >= to) if there is none.
terms::Detail detail_of(const Component& component);

/// An immutable list. Copies cost nothing; joining two costs the length of the shorter one, amortised over a sum that
/// grows term by term.
// The storage is shared: a list is a range of it. The shorter list is written beside the range of the longer one if
// there is free space, which no other list sees; otherwise both move to larger storage. A place is claimed only once,
// also by concurrent threads, and lives as long as any list that uses the storage.
class Components {
public:
    Components() = default;
    explicit Components(std::vector<Component> all);

    std::span<const Component> all() const { return stretch_; }
    [[nodiscard]] static Components joined(const Components& a, const Components& b);

private:
    struct Places {
        Places(std::vector<Component> places, std::size_t begin, std::size_t end)
            : all(std::move(places)), first(begin), last(end) {}
        std::vector<Component> all;            // all places, free or taken
        std::atomic<std::size_t> first, last;  // the taken range [first, last)
    };
    Components(std::shared_ptr<Places> places, std::size_t first, std::size_t count);

    /// The index of this list's first component in the storage.
    std::size_t first_place() const;
    /// Claim `count` free places behind or before this list; return false if they are taken.
    bool claim_after(std::size_t count) const;
    bool claim_before(std::size_t count) const;

    std::shared_ptr<Places> places_;
    std::span<const Component> stretch_;
};

/// Times with fixed relative positions about a middle, such as the nodes of panels.
struct Spread {
    /// sin and cos of omega times the distances from the middle.
    struct Turn {
        double omega = 0, half = 0;
        std::vector<double> sine{}, cosine{};
    };

    std::span<const double> places;   ///< from -1 to 1, symmetric about 0
    std::size_t first = 0;            ///< index of the first requested time in `places`
    double middle = 0, rest = 0;      ///< time of place 0 and its rounding error
    double half = 0;                  ///< the distance from place 0 to place 1
    std::span<const double> rests{};  ///< rounding errors of the times, for terms that support them
    std::vector<Turn> turns{};        ///< tabulated sines, one entry for each frequency
    std::size_t next_turn = 0;

    const Turn& turn(double omega);
};

class Excitation {
public:
    /// M = 0.
    Excitation() = default;
    /// Fails with a sentence that names the option, its value and its range.
    static text::Expected<Excitation> make(Term term);

    double value(double t, const State& state = {}) const;
    /// The limit from the left: differs from value(t) only where M jumps.
    double value_before(double t, const State& state = {}) const;
    /// The limit from the right: value(t), but scripted functions are evaluated slightly later, since their authors may
    /// have written `t > 0.5` as well as `t >= 0.5`.
    double value_after(double t, const State& state = {}) const;
    /// The first time after t at which M or a derivative of it jumps; `never` if there is none.
    double next_break(double t) const;
    /// The time from which M is constant for ever; `never` if unknown.
    double constant_from() const;
    /// An upper bound of |M|; `never` if unknown.
    double most() const;
    /// The longest step from t over which samples at most `spacing` times the step apart miss no detail of a smooth
    /// term; `never` if no detail lies ahead.
    double view(double t, double spacing) const;
    /// The detail between two times that needs the closest sampling.
    terms::Detail finest_detail(double from, double to) const;
    /// Returns whether M depends on theta or velocity.
    bool has_feedback() const;
    bool has_script() const;
    /// Returns whether all terms can be evaluated at times that lie between two doubles.
    bool takes_rests() const;
    /// out[i] = value(times[i]); not for feedback. Returns how many values were computed: fewer if one is not finite.
    std::size_t fill(std::span<const double> times, std::span<double> out, Spread* spread = nullptr) const;

    void each_function(const std::function<void(UserFunction&)>& call) const;

    Excitation scaled(double gain) const;
    Excitation delayed(double delay) const;
    /// This excitation, but 0 outside from <= t < to.
    Excitation windowed(double from, double to) const;
    /// This excitation with every user function replaced.
    using FunctionChange = std::function<std::shared_ptr<UserFunction>(const std::shared_ptr<UserFunction>&)>;
    Excitation with_functions(const FunctionChange& other) const;
    friend Excitation operator+(const Excitation& a, const Excitation& b);

    std::span<const Component> components() const { return components_.all(); }

private:
    explicit Excitation(Components components) : components_(std::move(components)) {}
    /// This excitation with `change` applied to every component.
    template <class Change>
    Excitation changed(Change change) const;

    Components components_;
};

/// The shortest common period of all terms from time t on; 0 if there is none, it is unknown, or M is constant from t
/// on. A feedback has the period that its user declared.
double period_from(const Excitation& excitation, double t);

}  // namespace dinal::model
