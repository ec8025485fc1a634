#include "motion/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <span>

#include "model/functions.hpp"
#include "model/laws/tabulated.hpp"
#include "motion/stillness.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::motion {

const std::vector<std::string>& column_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        all.reserve(body_columns.size());
        for (const ColumnKind& kind : body_columns) all.emplace_back(kind.name);
        return all;
    }();
    return names;
}

Rows::Rows(Eigen::MatrixXd values) {
    const auto rows = static_cast<std::size_t>(values.rows()), columns = static_cast<std::size_t>(values.cols());
    auto own = std::make_shared<Eigen::MatrixXd>(std::move(values));
    table_ = Growing<double>(rows, own->data(), columns, own);
}

std::optional<Eigen::Index> Run::find(std::string_view name) const {
    const std::vector<std::string>& all = names();
    const auto it = std::ranges::find(all, name);
    if (it == all.end()) return {};
    return static_cast<Eigen::Index>(it - all.begin());
}

Growing<model::Event> Run::events_once() const {
    const auto first = std::ranges::find_if(events, [](const model::Event& e) { return e.user >= 0; });
    const auto repeats = [&](const model::Event& e) { return e.user >= 0 && e.where != first->where; };
    if (std::none_of(first, events.end(), repeats)) return events;
    std::vector<model::Event> distinct;
    std::copy_if(events.begin(), events.end(), std::back_inserter(distinct), std::not_fn(repeats));
    return Growing<model::Event>(std::move(distinct));
}

text::Expected<model::State> between_rows(const Run& run, double t) {
    const auto time = run.find("t"), theta = run.find("theta"), velocity = run.find("velocity");
    if (!time || !theta || !velocity) return text::Error{"at() needs the columns t, theta and velocity"};
    const auto& rows = run.rows;
    const Eigen::Index n = rows.rows();
    const double* begin = rows.col(*time).data();
    if (n == 0 || !(t >= begin[0]) || !(t <= begin[n - 1])) {
        return text::Error{
            n == 0 ? "at() needs rows and there are none"
                   : fmt::format("t = {:.6g} is outside the rows from {:.6g} to {:.6g}", t, begin[0], begin[n - 1])};
    }
    const Eigen::Index i =
        std::min<Eigen::Index>(std::max<Eigen::Index>(std::upper_bound(begin, begin + n, t) - begin, 1), n - 1);
    if (n == 1 || begin[i - 1] == t) {
        const Eigen::Index row = n == 1 ? 0 : i - 1;
        return model::State{rows(row, *theta), rows(row, *velocity)};
    }
    const double h = begin[i] - begin[i - 1];
    const double s = (t - begin[i - 1]) / h;
    const double y0 = rows(i - 1, *theta), y1 = rows(i, *theta);
    const double v0 = h * rows(i - 1, *velocity), v1 = h * rows(i, *velocity);
    const double c2 = 3 * (y1 - y0) - 2 * v0 - v1, c3 = 2 * (y0 - y1) + v0 + v1;
    return model::State{y0 + s * (v0 + s * (c2 + s * c3)), (v0 + s * (2 * c2 + s * 3 * c3)) / h};
}

namespace {

std::string events_text(std::span<const model::Event> events) {
    if (events.empty()) return "no events";
    std::array<std::size_t, model::event_kind_count> counts{};
    for (const model::Event& event : events) ++counts.at(static_cast<std::size_t>(event.kind));
    const auto add = [&](model::EventKind to, model::EventKind from) {
        counts.at(static_cast<std::size_t>(to)) += counts.at(static_cast<std::size_t>(from));
    };
    add(model::EventKind::stick, model::EventKind::slider_sticks);
    add(model::EventKind::slip, model::EventKind::slider_slips);
    add(model::EventKind::switched, model::EventKind::slide_begins);
    add(model::EventKind::switched, model::EventKind::slide_ends);
    std::string parts;
    for (const model::EventKind kind :
         {model::EventKind::turn, model::EventKind::stick, model::EventKind::slip, model::EventKind::rest,
          model::EventKind::impact, model::EventKind::released, model::EventKind::switched, model::EventKind::opened,
          model::EventKind::closed, model::EventKind::user}) {
        const std::size_t n = counts.at(static_cast<std::size_t>(kind));
        if (n == 0) continue;
        if (!parts.empty()) parts += ", ";
        parts += text::counted(n, model::name(kind));
    }
    return fmt::format("{} ({})", text::counted(events.size(), "event"), parts);
}

}  // namespace

text::Expected<model::State> Run::at(double t) const {
    if (!computed && !course) return between_rows(*this, t);
    if (!(t >= t_start) || !(t <= t_stop)) {
        const std::string why = model::is_whole(outcome) ? "" : "; it ended there: " + outcome_text(*this);
        return text::Error{
            .sentence = fmt::format("t = {} is outside the run from {} to {}{}", t, t_start, t_stop, why),
            .option = "t"};
    }
    if (!course) return text::Error{"the motion between the rows was not kept: run without dense = false"};
    return course->at(t);
}

namespace {

/// Returns whether the law may jump, or be as steep as a jump, above speed 0.
bool may_jump(const model::Friction& law) {
    return model::user_law(law) != nullptr || law.as<model::laws::Tabulated>() != nullptr;
}

/// Says where the run switched endlessly, and the remedy.
std::string chatter_text(const Run& run) {
    if (run.rough) {
        return fmt::format(
            "switched endlessly at one time: {} jumps to and fro and drives it back each time; a steep "
            "line or tanh in its place would not",
            run.rough->who);
    }
    if (!run.events.empty() && run.events.back().t == run.t_stop) {
        if (run.events.back().kind == model::EventKind::user) {
            return "events follow each other endlessly at one time; bounces made by act never come to rest, those of "
                   "walls = {...} do";
        }
        if (run.events.back().kind == model::EventKind::switched) {
            return "a relay switches endlessly at one time: its on and off are too close";
        }
    }
    if (run.course && may_jump(run.course->system().friction()) && !run.on_belt) {
        constexpr double next_to_none = 1e-6;  // part of the greatest speed in the rows that counts as 0
        double fastest = std::fabs(run.initial.velocity);
        for (Eigen::Index i = 0; i < run.size(); ++i) fastest = std::max(fastest, std::fabs(run.rows(i, 2)));
        const double speed = std::fabs(run.state_at_stop.velocity);
        return fmt::format(
            "switched endlessly at one time: it chatters at speed {:.6g}, where the law of friction (or M) jumps or "
            "is too steep; a line over some small range of speeds would not",
            speed > next_to_none * fastest ? speed : 0.0);
    }
    if (run.jumps == 0) {
        return "switched endlessly at one time, where no jump was located: if a function jumps there, a steep line or "
               "tanh would not, nor excitation.sampled or excitation.relay; otherwise try integrator.rk4";
    }
    return "switched endlessly at one time: a jump of M, of a spring, of friction or of the rate of a state chatters; a "
           "steep line or tanh would not, nor excitation.sampled or excitation.relay";
}

/// Says which function is rough, and the remedy: another tolerance or integrator.
std::string rough_text(const Rough& rough) {
    if (!rough.other_integrators) {
        return fmt::format(
            "{} is rough on every scale, by {:.2g}: make it smooth, or hold it between instants by "
            "excitation.sampled",
            rough.who, rough.by);
    }
    constexpr double above = 8;  // margin for other coefficients above the two known
    const int digits = static_cast<int>(std::ceil(std::log10(above * rough.part)));
    std::string text = fmt::format("{} is noisy on every scale (about {:.2g}): try ", rough.who, rough.by);
    if (digits < -2) text += fmt::format("integrator.spectral{{ tolerance = 1e{} }}, or ", digits);
    return text + "rk4";
}

}  // namespace

std::string outcome_text(const Run& run) {
    if (run.contradiction) return model::sentence_with_cure(*run.contradiction);
    if (run.outcome == model::Outcome::chattering) return chatter_text(run);
    if (run.rough) return rough_text(*run.rough);
    std::string text(model::sentence(run.outcome));
    if (run.noise > 0) text += fmt::format(", within the noise of the torques, {:.2g}", run.noise);
    return text;
}

std::string too_few_rows(std::size_t rows, std::size_t events) {
    return rows > 0 && rows < 4 * events ? "; fewer than 4 rows an event" : "";
}

std::string summary(const Run& run) {
    const auto& rows = run.rows;
    std::string text = text::counted(static_cast<std::size_t>(rows.rows()), "row");
    if (!run.computed) {
        for (std::size_t i = 0; i < run.names().size(); ++i)
            text += (i == 0 ? " of " : ", ") + text::displayable(run.names()[i]);
        return text;
    }
    const Growing<model::Event> events = run.events_once();
    text += fmt::format(", t {:.9g} … {:.9g}; {}; ", run.t_start, run.t_stop, events_text(events));
    switch (run.outcome) {
        case model::Outcome::reached_end:
            text += run.find("theta") && stands_at_stop(run) ? "velocity 0 at the end" : "moving at the end";
            break;
        case model::Outcome::chattering:
            text += chatter_text(run);
            break;
        default:
            text += run.contradiction ? model::sentence(*run.contradiction)
                    : run.rough       ? rough_text(*run.rough)
                                      : std::string(model::sentence(run.outcome));
    }
    if (run.noise > 0) text += fmt::format("; noise of the torques {:.2g}", run.noise);
    if (run.jumps_often()) text += fmt::format("; M jumped {} times", run.jumps);
    text += too_few_rows(static_cast<std::size_t>(rows.rows()), events.size());
    if (run.find("theta")) text += fmt::format("; peak |theta| {:.3g}", peak(run));
    return text;
}

}  // namespace dinal::motion
