// Native excitations at any scale: systems and sums of terms whose numbers are all that a double can be between 1e-30
// and 1e30, run by every engine that takes them. Rows and events are finite, in order and within the run, and the same
// motion in other units of torque or angle, a power of two away, is the same to the last bit.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "motion/exact/exact.hpp"
#include "motion/simulate.hpp"
#include "motion/spectral/spectral.hpp"

namespace {

using namespace dinal;

/// Numbers from the bytes of a case; 0 where there are none left.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : left_(data, size) {}
    int of(int n) { return byte() % n; }
    bool once_in(int n) { return of(n) == 0; }
    /// 1e-30 ... 1e30; half of them of the order of 1.
    double size() {
        const double digits = 1 + word() / 65536.0;
        const int kind = of(4), places = of(61) - 30;
        return digits * std::pow(10.0, kind < 2 ? 0 : kind == 2 ? places / 10 : places);
    }
    double number() { return once_in(8) ? 0 : (once_in(2) ? -1 : 1) * size(); }
    [[nodiscard]] bool empty() const { return left_.empty(); }

private:
    std::uint8_t byte() {
        if (left_.empty()) return 0;
        const std::uint8_t first = left_.front();
        left_ = left_.subspan(1);
        return first;
    }
    double word() { return byte() + 256.0 * byte(); }

    std::span<const std::uint8_t> left_;
};

/// By how much the units of a case are greater than those that it was written in.
struct Scale {
    double torque = 1, angle = 1;
};

model::Term term_of(Bytes& bytes, double torque) {
    const double a = torque * bytes.number(), at = bytes.number(), width = bytes.size();
    switch (bytes.of(13)) {
        case 0:
            return model::Constant{a};
        case 1:
            return model::Harmonic{a, bytes.size(), bytes.number()};
        case 2:
            return model::Step{a, at};
        case 3:
            return model::Pulse{a, at, width};
        case 4:
            return model::HalfSine{a, at, width};
        case 5:
            return model::Gaussian{a, at, width};
        case 6:
            return model::Ramp{a, at, width};
        case 7:
            return model::Square{a, width, 1 / (1 + bytes.size()), at};
        case 8:
            return model::Sawtooth{a, width, at};
        case 9:
            return model::Triangle{a, width, at};
        case 10:
            return model::Chirp{a, bytes.size(), bytes.size(), width, at, bytes.number()};
        case 11:
            return model::Exponential{a, bytes.once_in(3) ? -width : width, at};
        default:
            break;
    }
    if (bytes.once_in(2)) {
        std::vector<double> c;
        for (int n = 1 + bytes.of(5); n > 0; --n) c.push_back(torque * bytes.number());
        return model::Polynomial{c, at};
    }
    model::Samples points;
    points.interpolation = bytes.once_in(2) ? model::Interpolation::linear : model::Interpolation::cubic;
    double t = at;
    for (int n = 1 + bytes.of(12); n > 0; --n) {
        points.t.push_back(t);
        points.M.push_back(torque * bytes.number());
        t = std::max(t + bytes.size(), std::nextafter(t, HUGE_VAL));
    }
    if (bytes.once_in(3)) points.period = t - points.t.front();
    return std::make_shared<const model::Samples>(points);
}

struct Case {
    model::Oscillator system;
    model::Excitation M;
    model::State initial;
    motion::Window window;
    double dt;
};

/// None where the numbers are none of a system, a term or a run.
std::optional<Case> case_of(const std::uint8_t* data, std::size_t size, const Scale& scale) {
    Bytes bytes(data, size);
    model::OscillatorParameters p;
    const double per_angle = scale.torque / scale.angle;
    p.inertia = per_angle * bytes.size();
    p.stiffness = per_angle * (bytes.once_in(10) ? 0 : bytes.size());
    p.damping = per_angle * std::fabs(bytes.number());
    const double Rd = std::fabs(bytes.number());
    p.kinetic_friction = scale.torque * Rd;
    p.breakaway = scale.torque * (bytes.once_in(2) ? Rd : Rd + std::fabs(bytes.number()));
    const auto system = model::Oscillator::make(p);
    if (!system) return {};
    const model::State initial{scale.angle * bytes.number(), scale.angle * bytes.number()};
    const double start = bytes.once_in(3) ? bytes.number() : 0;
    const double period = p.stiffness > 0 ? std::sqrt(p.inertia / p.stiffness) : 1;
    const double length = (bytes.once_in(6) ? 1 : period) * bytes.size();
    model::Excitation M;
    for (int n = 1 + bytes.of(3); n > 0 && !bytes.empty(); --n) {
        const auto term = model::Excitation::make(term_of(bytes, scale.torque));
        if (!term) return {};
        model::Excitation more = term->scaled(bytes.once_in(4) ? bytes.number() : 1);
        if (bytes.once_in(6)) more = more.delayed(bytes.number());
        if (bytes.once_in(6)) {
            const double from = bytes.number();
            more = more.windowed(from, from + bytes.size());
        }
        M = M + more;
    }
    return Case{*system, M, initial, {start, start + length}, length / 16};
}

/// The present case, as somebody would write it down.
void print(const Case& c) {
    const model::Friction& friction = c.system.friction();
    std::fprintf(stderr, "I = %.17g, k = %.17g, C = %.17g, Rd = %.17g, Re = %.17g\n", c.system.inertia(),
                 c.system.stiffness(), c.system.damping(), friction.sliding(model::Motion::forward, 0),
                 friction.holding(model::Motion::forward));
    std::fprintf(stderr, "theta0 = %.17g, velocity0 = %.17g, t_start = %.17g, t_end = %.17g, dt = %.17g\n",
                 c.initial.theta, c.initial.velocity, c.window.start, c.window.end, c.dt);
    for (const model::Component& each : c.M.components()) {
        const auto formula = [&](const auto& term) {
            if constexpr (requires { term.formula(each.gain); }) {
                return term.formula(each.gain);
            } else {
                return std::string();
            }
        };
        std::fprintf(stderr, "%s from %.17g to %.17g\n", std::visit(formula, each.term).c_str(), each.from, each.to);
    }
}

[[noreturn]] void wrong(const char* what) {
    std::fprintf(stderr, "%s\n", what);
    std::abort();
}

std::optional<motion::Run> run(const Case& c, motion::MethodView method) {
    if (std::getenv("DINAL_FUZZ_PRINT") != nullptr) print(c);
    int looks = 0;
    auto run = motion::simulate(c.system, {c.M, c.initial}, c.window, motion::Grid::every(c.dt), method,
                                [&looks](double) { return ++looks < 5; });
    if (!run) {
        if (run.error().sentence.empty()) wrong("a run refused without a sentence");
        return {};
    }
    const auto& rows = run->rows;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        for (Eigen::Index k = 0; k < rows.cols(); ++k) {
            if (!std::isfinite(rows(i, k))) wrong("a row that is not finite");
        }
        if (i > 0 && !(rows(i, 0) > rows(i - 1, 0))) wrong("rows out of order");
    }
    double before = c.window.start;
    for (const model::Event& event : run->events) {
        if (!(event.t >= before && event.t <= run->t_stop)) wrong("events out of order");
        before = event.t;
    }
    if (!(run->t_stop >= c.window.start && run->t_stop <= c.window.end)) wrong("a run beyond its end");
    return *run;
}

/// Far from where numbers end, where rounding is the same at every scale.
constexpr double least = 1e-120, most = 1e120;
bool ordinary(const motion::Run& run) {
    const auto fits = [](double x) { return x == 0 || (std::fabs(x) > least && std::fabs(x) < most); };
    for (Eigen::Index i = 0; i < run.rows.rows(); ++i) {
        for (Eigen::Index k = 1; k < run.rows.cols(); ++k) {
            if (!fits(run.rows(i, k))) return false;
        }
    }
    return model::is_whole(run.outcome);
}

void compare(const motion::Run& a, const motion::Run& b, const Scale& scale) {
    if (a.outcome != b.outcome || a.rows.rows() != b.rows.rows()) wrong("another end in other units");
    for (Eigen::Index i = 0; i < a.rows.rows(); ++i) {
        for (Eigen::Index k = 1; k < a.rows.cols(); ++k) {
            const double there = a.rows(i, k) * (k < 3 ? scale.angle : scale.torque), here = b.rows(i, k);
            // A 0 may be what underflowed, and something of 1e-322 in other units.
            if (there != here && !(there == 0 && std::fabs(here) < least)) wrong("another motion in other units");
        }
    }
    if (a.events.size() != b.events.size()) wrong("other events in other units");
    for (std::size_t i = 0; i < a.events.size(); ++i) {
        if (a.events[i].t != b.events[i].t || a.events[i].kind != b.events[i].kind)
            wrong("another event in other units");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto written = case_of(data, size, {});
    if (!written) return 0;
    const motion::exact::Exact exact{};
    const motion::spectral::Spectral spectral{};
    for (const motion::MethodView method : {motion::MethodView(exact), motion::MethodView(spectral)}) {
        const auto there = run(*written, method);
        if (!there || !ordinary(*there)) continue;
        for (const Scale& scale : {Scale{0x1p20, 1}, Scale{1, 0x1p-15}}) {
            const auto other = case_of(data, size, scale);
            if (const auto here = other ? run(*other, method) : std::nullopt) compare(*there, *here, scale);
        }
    }
    return 0;
}
