#include "model/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace dinal::model {
namespace {

enum class Side { before, at, after };

/// A time step large enough to survive the rounding in the function's own arithmetic (t - delay, t % period), and small
/// against all numbers involved.
double hair(double t, double delay) {
    constexpr double few_ulps = 4 * std::numeric_limits<double>::epsilon();
    constexpr double smallest = 1e-300;  // at t = 0: a normal number, so that sin(w t) / t is exact there
    return std::max(smallest, few_ulps * std::max({std::fabs(t), std::fabs(t - delay), std::fabs(delay)}));
}

double evaluate(const Scripted& s, double t, const State& state, Side side) {
    const double own_time = t - s.delay;
    switch (side) {
        case Side::before:
            return s.function->value(own_time - hair(t, s.delay), state);
        case Side::at:
            return s.function->value(own_time, state);
        case Side::after:
            return s.function->value(own_time + hair(t, s.delay), state);
    }
    return 0;
}

/// The sum of all components. Inactive components (gain 0, outside their window) are not evaluated. A script that fails
/// ends the sum, so that no other script is called after it.
template <Side side>
double sum_of(std::span<const Component> components, double t, const State& state) {
    const double native_t = side == Side::before ? std::nextafter(t, -never) : t, rest = t - native_t;
    double sum = 0;
    for (const Component& c : components) {
        if (c.gain == 0 || native_t < c.from || native_t >= c.to) {
            continue;
        }
        if (const auto* script = std::get_if<Scripted>(&c.term)) {
            const double value = evaluate(*script, t, state, side);
            if (std::isnan(value)) {
                return value;
            }
            sum += c.gain * value;
            continue;
        }
        sum += c.gain * std::visit(
                            [native_t, rest](const auto& term) {
                                if constexpr (terms::NativeTerm<std::decay_t<decltype(term)>>) {
                                    return terms::value_near(term, native_t, rest);
                                } else {
                                    return 0.0;
                                }
                            },
                            c.term);
    }
    return sum;
}

bool is_script(const Component& c) {
    return std::holds_alternative<Scripted>(c.term);
}

/// Returns an error if the term's numbers are invalid.
template <class T>
std::optional<text::Error> complaint(const T& term) {
    if constexpr (requires { term.complaint(); }) {
        if (auto wrong = term.complaint()) {
            return wrong;
        }
    }
    return text::complaint(T::about.call.options, term);
}

}  // namespace

text::Expected<Excitation> Excitation::make(Term term) {
    const auto wrong = std::visit([](const auto& t) { return complaint(t); }, term);
    if (wrong) {
        const char* call = std::visit([](const auto& t) { return t.about.call.name; }, term);
        return text::in_call(call, *wrong);
    }
    if (auto* script = std::get_if<Scripted>(&term)) {
        script->drop_repeated_corner();
    }
    return Excitation(Components({Component{.gain = 1, .term = std::move(term)}}));
}

double Excitation::value(double t, const State& state) const {
    return sum_of<Side::at>(components(), t, state);
}

double Excitation::value_before(double t, const State& state) const {
    return sum_of<Side::before>(components(), t, state);
}

double Excitation::value_after(double t, const State& state) const {
    return sum_of<Side::after>(components(), t, state);
}

double Excitation::next_break(double t) const {
    double first = never;
    for (const Component& c : components()) {
        first = std::min(first, model::next_break(c, t));
    }
    return first;
}

double Excitation::constant_from() const {
    double last = -never;
    for (const Component& c : components()) {
        last = std::max(last, model::constant_from(c));
    }
    return last;
}

double Excitation::most() const {
    double sum = 0;
    for (const Component& c : components()) {
        if (c.gain != 0) sum += std::fabs(c.gain) * std::visit([](const auto& term) { return term.most(); }, c.term);
    }
    return sum;
}

double Excitation::view(double t, double spacing) const {
    double nearest = never;
    for (const Component& c : components()) {
        const auto [from, to, apart] = detail_of(c);
        if (from < to && t < to) {
            nearest = std::min(nearest, std::max(from - t, apart / spacing));
        }
        if (const auto* script = std::get_if<Scripted>(&c.term)) {
            const double own_time = t - script->delay;
            nearest = std::min(nearest, script->function->known_until(own_time) - own_time);
        }
    }
    return nearest;
}

terms::Detail Excitation::finest_detail(double from, double to) const {
    terms::Detail finest;
    for (const Component& c : components()) {
        const terms::Detail found = detail_of(c);
        if (found.apart < finest.apart && found.from < found.to && found.from < to && found.to > from) {
            finest = found;
        }
    }
    return finest;
}

bool Excitation::has_feedback() const {
    return std::any_of(components().begin(), components().end(), [](const Component& c) {
        const auto* script = std::get_if<Scripted>(&c.term);
        return script != nullptr && script->feedback;
    });
}

bool Excitation::has_script() const {
    return std::any_of(components().begin(), components().end(), is_script);
}

bool Excitation::takes_rests() const {
    return std::all_of(components().begin(), components().end(), [](const Component& c) {
        return std::visit(
            [](const auto& term) {
                return requires {
                    term.value(0.0, 0.0);
                };
            },
            c.term);
    });
}

void Excitation::each_function(const std::function<void(UserFunction&)>& call) const {
    for (const Component& c : components()) {
        if (const auto* script = std::get_if<Scripted>(&c.term)) call(*script->function);
    }
}

template <class Change>
Excitation Excitation::changed(Change change) const {
    std::vector<Component> all(components().begin(), components().end());
    for (Component& c : all) {
        change(c);
    }
    std::erase_if(all, [](const Component& c) { return !(c.from < c.to); });
    return Excitation(Components(std::move(all)));
}

Excitation Excitation::scaled(double gain) const {
    return changed([gain](Component& c) { c.gain *= gain; });
}

Excitation Excitation::delayed(double delay) const {
    return changed([delay](Component& c) {
        std::visit([delay](auto& term) { terms::delay(term, delay); }, c.term);
        c.from += delay;
        c.to += delay;
    });
}

Excitation Excitation::windowed(double from, double to) const {
    return changed([from, to](Component& c) {
        c.from = std::max(c.from, from);
        c.to = std::min(c.to, to);
    });
}

Excitation Excitation::with_functions(const FunctionChange& other) const {
    if (!has_script()) return *this;
    return changed([&other](Component& c) {
        auto* script = std::get_if<Scripted>(&c.term);
        if (script == nullptr) return;
        if (script->original == nullptr) script->original = script->function;
        script->function = other(script->function);
    });
}

Excitation operator+(const Excitation& a, const Excitation& b) {
    return Excitation(Components::joined(a.components_, b.components_));
}

namespace {

/// Returns whether `common` is an integer multiple of all periods.
bool is_multiple_of_all(const std::vector<double>& periods, double common) {
    return std::all_of(periods.begin(), periods.end(), [common](double period) {
        const double n = common / period;
        return std::fabs(n - std::round(n)) <= 1e-9 * n;
    });
}

}  // namespace

double period_from(const Excitation& excitation, double t) {
    std::vector<double> periods;
    for (const Component& c : excitation.components()) {
        if (constant_from(c) <= t) continue;
        const double period = std::visit([](const auto& term) { return terms::period_of(term); }, c.term);
        if (!(period > 0) || c.from > t || c.to < never) return 0;
        periods.push_back(period);
    }
    if (periods.empty()) return 0;
    constexpr int most_beats = 60;  // periods of the slowest term; a longer common period is of no use
    const double longest = *std::max_element(periods.begin(), periods.end());
    for (int n = 1; n <= most_beats; ++n) {
        if (is_multiple_of_all(periods, n * longest)) return n * longest;
    }
    return 0;
}

namespace {

/// The time from which a term is constant, and whether it is 0 then.
struct Settled {
    double time;
    bool at_zero;
};
Settled settled(const Component& c) {
    return std::visit(
        [](const auto& term) -> Settled {
            if (term.most() == 0) return {-never, true};
            const double time = term.constant_from();
            if constexpr (terms::NativeTerm<std::decay_t<decltype(term)>>) {
                return {time, time < never && term.value(time) == 0};
            }
            return {time, false};
        },
        c.term);
}

}  // namespace

double next_break(const Component& c, double t) {
    if (c.gain == 0 || t >= c.to) {
        return never;
    }
    if (t < c.from) {
        return c.from;
    }
    return std::min(c.to, std::visit([t](const auto& term) { return term.next_break(t); }, c.term));
}

double constant_from(const Component& c) {
    if (c.gain == 0) {
        return -never;
    }
    const auto [time, at_zero] = settled(c);
    if (c.to < never) {
        return at_zero ? std::min(c.to, time) : c.to;
    }
    return at_zero ? time : std::max(c.from, time);
}

terms::Detail detail_of(const Component& c) {
    if (c.gain == 0) {
        return {};
    }
    const terms::Detail whole = std::visit([](const auto& term) { return terms::detail_of(term); }, c.term);
    return {std::max(c.from, whole.from), std::min(c.to, whole.to), whole.apart};
}

Components::Components(std::shared_ptr<Places> places, std::size_t first, std::size_t count)
    : places_(std::move(places)), stretch_(places_->all.data() + first, count) {}

Components::Components(std::vector<Component> all) {
    const std::size_t count = all.size();
    places_ = std::make_shared<Places>(std::move(all), 0, count);
    stretch_ = places_->all;
}

std::size_t Components::first_place() const {
    return static_cast<std::size_t>(stretch_.data() - places_->all.data());
}

bool Components::claim_after(std::size_t count) const {
    std::size_t last = first_place() + stretch_.size();
    return places_->all.size() - last >= count && places_->last.compare_exchange_strong(last, last + count);
}

bool Components::claim_before(std::size_t count) const {
    std::size_t begin = first_place();
    return begin >= count && places_->first.compare_exchange_strong(begin, begin - count);
}

Components Components::joined(const Components& a, const Components& b) {
    const std::size_t n = a.stretch_.size(), m = b.stretch_.size();
    if (n == 0 || m == 0) {
        return n == 0 ? b : a;
    }
    if (m <= n && a.claim_after(m)) {
        std::copy(b.stretch_.begin(), b.stretch_.end(),
                  a.places_->all.begin() + static_cast<std::ptrdiff_t>(a.first_place() + n));
        return {a.places_, a.first_place(), n + m};
    }
    if (n <= m && b.claim_before(n)) {
        const std::size_t first = b.first_place() - n;
        std::copy(a.stretch_.begin(), a.stretch_.end(), b.places_->all.begin() + static_cast<std::ptrdiff_t>(first));
        return {b.places_, first, n + m};
    }
    // Twice as many places, with free ones on both sides: a sum may grow at either end.
    const std::size_t first = (n + m) / 2;
    const auto places = std::make_shared<Places>(std::vector<Component>(2 * (n + m)), first, first + n + m);
    const auto middle =
        std::copy(a.stretch_.begin(), a.stretch_.end(), places->all.begin() + static_cast<std::ptrdiff_t>(first));
    std::copy(b.stretch_.begin(), b.stretch_.end(), middle);
    return {places, first, n + m};
}

}  // namespace dinal::model
