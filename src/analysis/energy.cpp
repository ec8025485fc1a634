#include "analysis/energy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "analysis/recurrence.hpp"
#include "model/lowered.hpp"
#include "motion/clock.hpp"

namespace dinal::analysis {

namespace {

constexpr std::array works{&Work::input, &Work::viscous, &Work::dry,     &Work::belt,
                           &Work::base,  &Work::acts,    &Work::impacts, &Work::kept};

class WorkSum {
public:
    void add(const Work& work) {
        for (std::size_t i = 0; i < works.size(); ++i) sums_[i].add(work.*works[i]);
    }
    Work value() const {
        Work work;
        for (std::size_t i = 0; i < works.size(); ++i) work.*works[i] = sums_[i].value();
        return work;
    }

private:
    std::array<motion::AccurateSum, works.size()> sums_;
};

Work operator+(Work a, const Work& b) {
    for (const auto work : works) a.*work += b.*work;
    return a;
}

Work operator-(Work a, const Work& b) {
    for (const auto work : works) a.*work -= b.*work;
    return a;
}

Stored operator+(const Stored& a, const Stored& b) {
    return {a.kinetic + b.kinetic, a.spring + b.spring};
}

/// The stored energy of a joint; a link has no inertia.
class Store {
public:
    Store(const model::Oscillator& oscillator, Whose whose)
        : system_(oscillator), inertia_(whose == Whose::link ? 0 : system_.inertia()) {}

    Stored at(const model::State& y) const {
        return {inertia_ * y.velocity * y.velocity / 2,
                system_.stiffness() * y.theta * y.theta / 2 + system_.spring_energy(y.theta)};
    }
    Stored change(const model::State& from, const model::State& to) const {
        // Products, as the difference of two large energies would keep their rounding.
        return {inertia_ * ((to.velocity - from.velocity) * (to.velocity + from.velocity)) / 2,
                system_.stiffness() * ((to.theta - from.theta) * (to.theta + from.theta)) / 2 +
                    (system_.spring_energy(to.theta) - system_.spring_energy(from.theta))};
    }

private:
    model::Lowered system_;
    double inertia_;
};

/// Sums legs into half cycles, delimited by the stretches of the run.
class Bookkeeper {
public:
    Bookkeeper(const Store& store, const std::vector<Stretch>& stretches)
        : store_(store), stretch_(stretches.begin()), last_(stretches.end() - 1) {}

    void add(const motion::Leg& leg) {
        Work done;
        // Without friction a turn may lie inside the leg; otherwise stretches end with legs, to rounding.
        while (stretch_ != last_ && ends_within(leg)) {
            const Work here = leg.work(leg.since_start(stretch_->to));
            present_.add(here - done);
            done = here;
            close();
        }
        present_.add(leg.work(leg.length()) - done);
    }
    Energy finish(const model::State& initial) {
        while (stretch_ != last_) close();
        close();
        energy_.total.work = total_.value();
        energy_.start = store_.at(initial);
        energy_.flow = flow_.value();
        return std::move(energy_);
    }

private:
    /// Returns whether the stretch ends inside the leg. An end at the next leg's beginning does not count: an impact
    /// lies between, and belongs to the stretch it ended.
    bool ends_within(const motion::Leg& leg) const {
        const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::fabs(stretch_->to);
        return leg.since_start(stretch_->to) + rounding < leg.length();
    }
    void close() {
        const Work work = present_.value();
        total_.add(work);
        present_ = {};
        if (!stretch_->stuck && stretch_->lasts() > 0) {
            // The end state is behind an impact, as the work includes its loss.
            const model::State &begin = stretch_->begin,
                               &end = stretch_ != last_ ? (stretch_ + 1)->begin : stretch_->end;
            const EnergyBalance balance{work, store_.change(begin, end)};
            energy_.half_cycles.push_back({stretch_->from, stretch_->to, begin.theta, end.theta, balance});
            // Passing theta = 0, the spring releases all of its energy.
            const bool through = (begin.theta < 0) != (end.theta < 0);
            const double spring = through ? store_.at(begin).spring : std::max(-balance.change.spring, 0.0);
            for (const double given : {work.input, spring, -balance.change.kinetic, work.belt, work.base, work.acts}) {
                flow_.add(std::max(given, 0.0));
            }
        }
        ++stretch_;
    }

    const Store& store_;
    std::vector<Stretch>::const_iterator stretch_, last_;
    WorkSum present_, total_;
    motion::AccurateSum flow_;
    Energy energy_;
};

}  // namespace

double Energy::closure() const {
    return flow > 0 ? std::fabs(total.error()) / flow : 0;
}

text::Expected<Energy> energy_of(const motion::Run& run, Whose whose) {
    if (!run.computed && whose != Whose::link) {
        return text::Error{
            "a run that was read from a file has no motion to integrate over: simulate the system again"};
    }
    const double whole_until = run.course ? run.course->whole_until() : -model::never;
    if (whole_until == -model::never) {
        return text::Error{
            "the energy is integrated over the motion that integrator.exact and integrator.spectral keep: simulate "
            "with "
            "one of them and without dense = false"};
    }
    if (whole_until < model::never) {
        return text::error(
            "the motion was kept only up to t = {:.6g}, for lack of memory: simulate in parts of at most that length",
            whole_until);
    }
    if (!(run.t_stop > run.t_start)) {
        return text::Error{"there is no motion to integrate over: the run ended where it started"};
    }
    const Store store(run.course->system(), whose);
    const std::vector<Stretch> cut = half_cycles(run);
    Bookkeeper books(store, cut);
    run.course->legs([&books](const motion::Leg& leg) { books.add(leg); });
    Energy energy = books.finish(run.initial);
    energy.t_start = run.t_start;
    energy.t_end = run.t_stop;
    energy.finish = store.at(cut.back().end);
    energy.finish.spring += energy.total.work.kept;
    energy.total = {energy.total.work, store.change(run.initial, cut.back().end)};
    energy.whose = whose;
    if (!std::isfinite(energy.flow) || !std::isfinite(energy.total.error())) {
        return text::Error{
            "the energies of this run are beyond the range of numbers: choose larger units of torque or angle"};
    }
    return energy;
}

Energy sum_of(std::vector<Energy> joints) {
    Energy sum = std::move(joints.front());
    sum.whose = Whose::all;
    if (joints.size() > 1) sum.half_cycles.clear();
    for (std::size_t j = 1; j < joints.size(); ++j) {
        const Energy& own = joints[j];
        sum.start = sum.start + own.start, sum.finish = sum.finish + own.finish;
        sum.total.work = sum.total.work + own.total.work, sum.total.change = sum.total.change + own.total.change;
        sum.flow += own.flow;
    }
    return sum;
}

Eigen::MatrixXd energy_columns(const motion::Run& run, Whose whose) {
    const Store store(run.course->system(), whose);
    const auto t = run.column(motion::Column::t), theta = run.column(motion::Column::theta),
               velocity = run.column(motion::Column::velocity);
    Eigen::MatrixXd columns(run.size(), energy_column_count);
    Eigen::Index row = 0;
    const auto put = [&](WorkSum sum, const Work& last) {
        sum.add(last);
        const model::State y{theta[row], velocity[row]};
        const Stored s = store.at(y);
        const EnergyBalance balance{sum.value(), store.change(run.initial, y)};
        columns.row(row++) << balance.work.input, s.kinetic, s.spring + balance.work.kept, balance.work.viscous,
            balance.work.dry, balance.error(), balance.work.belt, balance.work.base, balance.work.acts,
            balance.work.impacts;
    };
    WorkSum before;
    run.course->legs([&](const motion::Leg& leg) {
        while (row < run.size() && leg.since_start(t[row]) < leg.length()) {
            put(before, leg.work(leg.since_start(t[row])));
        }
        before.add(leg.work(leg.length()));
    });
    while (row < run.size()) put(before, {});
    return columns;
}

std::string text(const Energy& energy, const model::Units& units) {
    const auto& [work, change] = energy.total;
    // Values below the rounding of the whole are shown as 0.
    const auto shown = [&](double x) { return std::fabs(x) <= 1e-15 * energy.flow ? 0.0 : x; };
    const auto stored_line = [&](const char* name, double difference, double start, double finish) {
        return fmt::format("  {:<8}{:>13.6g}   from {:.6g} to {:.6g}\n", name, shown(difference), shown(start),
                           shown(finish));
    };
    std::string text = fmt::format("energy{}, t {:.9g} … {}: input = kinetic + spring + viscous + dry\n",
                                   units.M.empty() ? "" : " in " + units.energy(), energy.t_start,
                                   model::with_unit(fmt::format("{:.9g}", energy.t_end), units.t));
    text += fmt::format("  {:<8}{:>13.6g}   work of M on the mass\n", "input", shown(work.input));
    const auto given_line = [&](const char* name, double given, const char* meaning) {
        return given == 0 ? "" : fmt::format("  {:<8}{:>13.6g}   {}\n", name, shown(given), meaning);
    };
    text += given_line("belt", work.belt, "work of the moving surface on the mass");
    text += given_line("base", work.base, "work of the shaking support on the mass");
    text += given_line("acts", work.acts, "work of acts at events");
    text += stored_line("kinetic", change.kinetic, energy.start.kinetic, energy.finish.kinetic);
    text += stored_line("spring", change.spring, energy.start.spring, energy.finish.spring);
    text += fmt::format("  {:<8}{:>13.6g}   lost to viscous damping\n", "viscous", shown(work.viscous));
    text += fmt::format("  {:<8}{:>13.6g}   lost to dry friction\n", "dry", shown(work.dry));
    if (work.impacts != 0)
        text += fmt::format("  {:<8}{:>13.6g}   lost at the walls\n", "impacts", shown(work.impacts));
    if (energy.whose != Whose::all) {
        return text + fmt::format("  {:<8}{:>13.6g}   work of {} on it", "others", shown(-energy.total.error()),
                                  energy.whose == Whose::link ? "its bodies" : "its links");
    }
    text += fmt::format("  {:<8}{:>13.2g}   {:.1g} of {:.6g} that flowed in {} half cycle{}", "error",
                        energy.total.error(), energy.closure(), energy.flow, energy.half_cycles.size(),
                        energy.half_cycles.size() == 1 ? "" : "s");
    return text;
}

}  // namespace dinal::analysis
