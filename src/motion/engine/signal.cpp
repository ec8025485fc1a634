#include "motion/engine/signal.hpp"

#include "model/excitation.hpp"

namespace dinal::motion::engine {

bool Piecewise::slide(const Moment& own, const Moment& beyond, std::uint64_t arguments) {
    if (is_friction() || function_->read() == nullptr) return false;
    auto made = std::make_shared<Slide>();
    let_go();
    const auto decide_at = [&](const Moment& at, model::terms::Piece& piece) {
        constexpr std::uint64_t all = ~std::uint64_t{0};
        called(at, argument(at), [&](double t, const model::State& state, std::span<const double> states) {
            function_->decide(piece, t, state, states, all);
        });
    };
    decide_at(own, piece_), decide_at(beyond, made->beyond);
    // Conditions after the first that differs may depend on it.
    const auto& conditions = piece_.conditions;
    while (made->condition < conditions.size()) {
        const auto& [step, further, of] = conditions[made->condition];
        if (made->beyond.decisions[step] == further && (law_ || (of & ~arguments) == 0)) break;
        ++made->condition;
    }
    if (made->condition == conditions.size() || made->beyond.conditions.empty()) return false;
    constexpr std::size_t no_step = std::numeric_limits<std::size_t>::max();
    made->conditions.assign(2, {no_step, 0, 0});
    slide_ = std::move(made);
    return true;
}

void Piecewise::watch_others(const Moment& one_side, const Moment& other_side, double near) {
    // the margin must change across the surface by more than this multiple of its value in the middle
    constexpr double across = 0.1;
    std::vector<double> margins, others;
    for (const auto side : {Slide::Side::own, Slide::Side::beyond}) {
        const model::terms::Piece& piece = side == Slide::Side::own ? piece_ : slide_->beyond;
        model::terms::Piece& apart = slide_->apart[side == Slide::Side::own ? 0 : 1];
        apart = piece;
        apart.conditions.clear();
        (void)on(piece, one_side, &margins), (void)on(piece, other_side, &others);
        for (std::size_t c = 0; c < margins.size(); ++c) {
            const double away = std::fabs(margins[c] + others[c]) / 2;
            if (!(away > near || away > across * std::fabs(margins[c] - others[c]))) continue;
            slide_->others.emplace_back(side, c);
            slide_->conditions.push_back(piece.conditions[c]);
            apart.conditions.push_back(piece.conditions[c]);
        }
    }
}

void Piecewise::leave(std::size_t condition) {
    if (condition == 1) piece_ = slide_->beyond;
    if (condition > 1) piece_ = {};
    slide_ = nullptr;
}

double Piecewise::sliding(const Moment& at) const {
    if (slide_->used == Slide::Side::own) return on(piece_, at, nullptr);
    if (slide_->used == Slide::Side::beyond) return on(slide_->beyond, at, nullptr);
    const double own = on(piece_, at, nullptr), share = slide_->share(at);
    return own + share * (on(slide_->beyond, at, nullptr) - own);
}

void Piecewise::sliding_margins(const Moment& at, std::vector<double>& out) const {
    const double share = slide_->share(at);
    out = {share, 1 - share};
    std::vector<double> own, beyond;
    if (slide_->others.empty()) return;
    (void)on(piece_, at, &own), (void)on(slide_->beyond, at, &beyond);
    for (const auto& [side, c] : slide_->others) out.push_back((side == Slide::Side::own ? own : beyond)[c]);
}

double Piecewise::margin_rate(model::Formula& of, const Moment& at, std::span<const double> rates) const {
    // The angle is the only argument of a spring, and stands in the place of the time.
    if (law_) {
        const double turns = law_->slip({at.t, at.side, rates});
        return turns * of.margin_rate(piece_, slide_->condition, law_->slip(at), {}, {}, {}, {});
    }
    const std::size_t count = of.state_count();
    return of.margin_rate(piece_, slide_->condition, time(at), convention_->state(at.y),
                          convention_->states(at.y).first(count), convention_->state(rates),
                          convention_->states(rates).first(count));
}

std::pair<double, double> Piecewise::margin(const Moment& at, std::span<const double> rates) const {
    std::vector<double> margins;
    (void)on(piece_, at, &margins);
    model::Formula* formula = function_->read();
    if (formula == nullptr) return {0, std::numeric_limits<double>::quiet_NaN()};
    return {margins[slide_->condition], margin_rate(*formula, at, rates)};
}

double Piecewise::margin_bend(const Moment& at, std::span<const double> rates, std::size_t angles,
                              double stretch) const {
    model::Formula* formula = function_->read();
    if (formula == nullptr) return std::numeric_limits<double>::quiet_NaN();
    std::vector<double> y(at.y.begin(), at.y.end()), still(y.size(), 0), moves(y.size(), 0), bends(y.size(), 0);
    for (std::size_t i = 0; i < angles; ++i) moves[i] = rates[i], bends[i] = rates[angles + i];
    const double of_accelerations = margin_rate(*formula, at, bends) - margin_rate(*formula, at, still);
    // The rest is the change of the rate along an even motion; a difference of fourth order loses few digits.
    const auto later = [&](double by) {
        for (std::size_t i = 0; i < angles; ++i) y[i] = at.y[i] + by * rates[i];
        return margin_rate(*formula, {at.t + by, Side::at, y}, moves);
    };
    const double near = later(stretch) - later(-stretch), far = later(2 * stretch) - later(-2 * stretch);
    return of_accelerations + (8 * near - far) / (12 * stretch);
}

bool Piecewise::keeps(std::size_t condition, const Ranges& ranges, bool named) const {
    const model::Formula* read = function_->read();
    if (read == nullptr || slide_) return false;
    const std::size_t step = piece_.conditions[condition].step;
    const model::Op op = read->steps()[step].op;
    if (op != model::Op::less && op != model::Op::less_equal && op != model::Op::abs) return false;
    const auto range = ranges.of(read, &piece_, named, delay_, step);
    return range && (range->lo > 0 || range->hi < 0);
}

Signal::Signal(const model::Excitation& excitation, const CallConvention* convention)
    : excitation_(excitation), convention_(convention), memory_(excitation.components().size()) {
    for (const model::Component& c : excitation_.components()) {
        Part part{.component = &c,
                  .sampled = model::controller_of<model::SampledController>(c),
                  .relay = model::controller_of<model::RelayController>(c),
                  .delayed = model::controller_of<model::DelayedController>(c)};
        const bool controller = part.sampled != nullptr || part.relay != nullptr || part.delayed != nullptr;
        if (!controller) part.function = std::get_if<model::Scripted>(&c.term);
        part.of_motion = part.function != nullptr && part.function->feedback;
        depends_on_motion_ |= part.of_motion;
        const bool switches_by_function = part.relay != nullptr && part.relay->function != nullptr;
        samples_functions_ |= part.function != nullptr || part.delayed != nullptr || switches_by_function;
        changes_in_time_ |= (part.function != nullptr && !part.of_motion) || part.delayed != nullptr;
        if (part.of_motion) {
            const Piecewise made(convention_, part.function->function.get(), part.function->delay);
            if (made.has_pieces()) held_.push_back(parts_.size());
            part.piecewise = made;
        }
        if (part.relay != nullptr) relays_.push_back(parts_.size());
        if (part.delayed != nullptr) delays_.push_back(part.delayed->by);
        const bool holds = part.sampled != nullptr || part.relay != nullptr;
        is_held_ = is_held_ && (part.of_motion || (holds && c.from == -model::never && c.to == model::never));
        of_time_only_ = of_time_only_ && !controller && !part.of_motion;
        parts_.push_back(part);
    }
    if (is_sampled()) sampled_ = std::make_unique<Sampled>();
}

double Signal::value_of(std::size_t i, const Moment& at) const {
    const Part& part = parts_[i];
    if (part.piecewise) return part.piecewise->value(at);
    if (part.function != nullptr) {
        const double t = towards(at.t - part.function->delay, at.side);
        return convention_->evaluate_at(*part.function->function, t, at.y);
    }
    if (part.relay != nullptr) return part.relay->levels[memory_[i].on ? 0 : 1];
    if (part.sampled != nullptr) return memory_[i].output;
    if (part.delayed != nullptr) {
        // A delayed jump returns at a rounded time, so the past is evaluated slightly before or after it.
        const double t = towards(at.t, at.side);
        return convention_->evaluate_at(*part.delayed->function, t, convention_->past(t - part.delayed->by, at.side));
    }
    const double t = at.side == Side::before ? std::nextafter(at.t, -model::never) : at.t;
    return std::visit(
        [t, rest = at.t - t](const auto& term) {
            if constexpr (model::terms::NativeTerm<std::decay_t<decltype(term)>>) {
                return model::terms::value_near(term, t, rest);
            } else {
                return 0.0;
            }
        },
        part.component->term);
}

double Signal::sum(const Moment& at, bool of_motion) const {
    const double t = at.side == Side::before ? std::nextafter(at.t, -model::never) : at.t;
    double sum = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const model::Component& c = *parts_[i].component;
        if (parts_[i].of_motion != of_motion || c.gain == 0 || t < c.from || t >= c.to) continue;
        const double value = value_of(i, at);
        if (std::isnan(value)) return value;
        sum += c.gain * value;
    }
    return sum;
}

void Signal::sample(const NodeTimes& when, Nodes& out) const {
    const auto at_node = [&](std::size_t j) { return of_time({when.times[j], when.side(j), {}}); };
    if (is_held_) return out.fill(at_node(0));
    if (!of_time_only_) {
        for (std::size_t j = 0; j < node_count; ++j) out[j] = at_node(j);
        return;
    }
    std::size_t first = 0, end = node_count;
    if (when.from_break) out[0] = at_node(0), first = 1;
    for (const auto& [t, rest, M] : known_) {
        if (first == 0 && t == when.times[0] && rest == when.rests[0]) out[0] = M, first = 1;
    }
    if (when.to_break) out[--end] = at_node(node_count - 1);
    if (sampled_ != nullptr && !when.from_break && when.times[1] < sampled_->until) {
        const NodeTimes& then = sampled_->when;
        if (first == 0) out[0] = at_node(0), first = 1;
        for (; first < end && when.times[first] < sampled_->until; ++first) {
            const double since = (when.times[first] - then.times[0]) + (when.rests[first] - then.rests[0]);
            out[first] = cheb::value(sampled_->series, since / then.h - 1);
        }
    }
    spread_.first = first;
    spread_.rests = std::span(when.rests).subspan(first, end - first);
    spread_.middle = when.times[node_count / 2], spread_.rest = when.rests[node_count / 2], spread_.half = when.h;
    const std::size_t good = excitation_.fill(std::span(when.times).subspan(first, end - first),
                                              std::span(out).subspan(first, end - first), &spread_);
    std::fill(out.begin() + static_cast<std::ptrdiff_t>(first + good), out.begin() + static_cast<std::ptrdiff_t>(end),
              std::numeric_limits<double>::quiet_NaN());
    if (sampled_ != nullptr) sampled_->values = out;
    known_ = {{{when.from_break ? nowhen : when.times[0], when.rests[0], out[0]},
               {when.to_break ? nowhen : when.times[node_count - 1], when.rests[node_count - 1], out[node_count - 1]}}};
}

void Signal::keep(const NodeTimes& when, double tolerance) const {
    if (sampled_ == nullptr || is_read()) return;
    sampled_->when = when, sampled_->series = cheb::fit(sampled_->values);
    const bool decayed = cheb::tail(sampled_->series) <= tolerance * cheb::size(sampled_->series);
    sampled_->until = decayed ? when.times[node_count - 1] : -model::never;
}

double Signal::next_break(double t) const {
    double first = excitation_.next_break(t);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const auto* sampled = parts_[i].sampled;
        if (sampled == nullptr) continue;
        first = std::min(first, sampled->at + static_cast<double>(memory_[i].instant) * sampled->every);
        if (!memory_[i].pending.empty()) first = std::min(first, memory_[i].pending.front().first);
    }
    return first;
}

void Signal::call_unread(const Moment& at) const {
    const auto is_unread = [](const auto& owner) {
        return owner != nullptr && owner->function != nullptr && owner->function->read() == nullptr;
    };
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (is_unread(parts_[i].function) || is_unread(parts_[i].delayed)) static_cast<void>(value_of(i, at));
    }
    for (std::size_t r = 0; r < relays_.size(); ++r) {
        if (is_unread(parts_[relays_[r]].relay)) static_cast<void>(until_switch(r, at));
    }
}

void Signal::begin(const Moment& at, const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (const auto* sampled = parts_[i].sampled) {
            const double n = std::ceil((at.t - sampled->at) / sampled->every - 1e-9);
            memory_[i].instant = static_cast<std::int64_t>(std::max(n, 0.0));
            if (sampled->at + static_cast<double>(memory_[i].instant) * sampled->every < at.t) ++memory_[i].instant;
            memory_[i].own = sampled->function->new_memory();
        } else if (const auto* relay = parts_[i].relay) {
            using Of = model::RelayController::Of;
            const std::string wanted = relay->of == Of::theta      ? "theta"
                                       : relay->of == Of::velocity ? "velocity"
                                                                   : relay->state;
            const auto found = std::find(names.begin(), names.end(), wanted);
            if (relay->of != Of::function && found != names.end()) {
                memory_[i].place = static_cast<std::size_t>(found - names.begin());
            }
            memory_[i].on = relay->starts_on;
        }
    }
    for (std::size_t r = 0; r < relays_.size(); ++r) {
        if (until_switch(r, at) < 0) toggle(r);
    }
}

bool Signal::update_controllers(const Moment& at) {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const auto* sampled = parts_[i].sampled;
        if (sampled == nullptr) continue;
        Memory& memory = memory_[i];
        const auto take = [&] {
            while (!memory.pending.empty() && memory.pending.front().first <= at.t) {
                memory.output = memory.pending.front().second;
                memory.pending.pop_front();
            }
        };
        const auto instant = [&] { return sampled->at + static_cast<double>(memory.instant) * sampled->every; };
        take();
        while (instant() <= at.t) {
            sampled->function->use(memory.own);
            const double output = convention_->evaluate_at(*sampled->function, at.t, at.y);
            if (!std::isfinite(output)) return false;
            memory.pending.emplace_back(instant() + sampled->delay, output);
            ++memory.instant;
        }
        take();
    }
    return true;
}

Signal::Switching Signal::switching(std::size_t relay) const {
    const std::size_t i = relays_[relay];
    const model::RelayController& own = *parts_[i].relay;
    const double way = own.off > own.on ? 1 : -1;
    return {memory_[i].on ? -way : way, memory_[i].on ? own.off : own.on, memory_[i].place};
}

double Signal::until_switch(std::size_t relay, const Moment& at) const {
    const auto [sign, level, place] = switching(relay);
    const double measured =
        place ? at.y[*place] : convention_->evaluate_at(*parts_[relays_[relay]].relay->function, at.t, at.y);
    return sign * (measured - level);
}

using model::bounds::Interval;

std::optional<Interval> Ranges::of(const model::Formula* formula, const model::terms::Piece* piece, bool named,
                                   double delay, std::optional<std::size_t> condition) const {
    if (formula == nullptr || formula->gave_up()) return {};
    const std::size_t from = named ? 0 : 2;
    if (formula->state_count() != 0 && formula->state_count() != y.size() - from) return {};
    model::bounds::Walk walk;
    walk.begin(*formula, piece, true);
    const auto give = [&walk](std::size_t place, const Interval& range) {
        walk.set(place, {range.lo + (range.hi - range.lo) / 2, (range.hi - range.lo) / 2}, range);
    };
    give(0, {t.lo - delay, t.hi - delay});
    if (formula->takes_motion() && !named) give(1, y[0]), give(2, y[1]);
    for (std::size_t k = 0; k < formula->state_count(); ++k) give(formula->first_state() + k, y[from + k]);
    const Interval range = walk.run(condition).range;
    return range.is_anything() ? std::nullopt : std::optional(range);
}

}  // namespace dinal::motion::engine
