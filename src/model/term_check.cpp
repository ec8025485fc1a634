// Excitation::make: what a user may say about a term, and the sentences for what he may not.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "model/excitation.hpp"

namespace dinal::model {
namespace {

using Complaint = std::optional<text::Error>;

/// Collects the first complaint about the options of one term.
class Check {
public:
    explicit Check(std::string_view term) : term_(term) {}

    Check& finite(std::string_view option, double x) { return require(std::isfinite(x), option, x, "must be finite"); }
    Check& positive(std::string_view option, double x) { return finite(option, x).positive_or_infinite(option, x); }
    Check& positive_or_infinite(std::string_view option, double x) {
        return require(x > 0, option, x, "must be positive");
    }
    Check& not_negative(std::string_view option, double x) {
        return finite(option, x).require(x >= 0, option, x, "must not be negative");
    }
    Check& require(bool right, std::string_view option, double x, std::string_view limit) {
        if (!right && !complaint_) {
            complaint_ = error(option, fmt::format(" = {} {}", x, limit));
        }
        return *this;
    }
    /// Numbers are counted from 1, as the user does.
    Check& all_finite(std::string_view option, const std::vector<double>& list) {
        for (std::size_t i = 0; i < list.size() && !complaint_; ++i) {
            if (!std::isfinite(list[i])) {
                complaint_ = error(option, fmt::format("[{}] = {} must be finite", i + 1, list[i]));
            }
        }
        return *this;
    }
    Check& increasing(std::string_view option, const std::vector<double>& list) {
        for (std::size_t i = 1; i < list.size() && !complaint_; ++i) {
            if (!(list[i] > list[i - 1])) {
                complaint_ = error(option, fmt::format("[{}] = {} is not after {}[{}] = {}; times must increase", i + 1,
                                                       list[i], option, i, list[i - 1]));
            }
        }
        return *this;
    }
    [[nodiscard]] Complaint complaint() const { return complaint_; }

private:
    [[nodiscard]] text::Error error(std::string_view option, const std::string& what) const {
        return text::in_call(term_, {.sentence = std::string(option) + what, .option = std::string(option)});
    }

    std::string_view term_;
    Complaint complaint_;
};

Complaint check(const Constant& c) {
    return Check("constant").finite("level", c.level).complaint();
}

Complaint check(const Harmonic& h) {
    return Check("harmonic")
        .finite("amplitude", h.amplitude)
        .not_negative("omega", h.omega)
        .finite("phase", h.phase)
        .complaint();
}

Complaint check(const Step& s) {
    return Check("step").finite("level", s.level).finite("at", s.at).complaint();
}

Complaint check(const Pulse& p) {
    return Check("pulse").finite("amplitude", p.amplitude).finite("at", p.at).positive("width", p.width).complaint();
}

Complaint check(const HalfSine& h) {
    return Check("half_sine")
        .finite("amplitude", h.amplitude)
        .finite("at", h.at)
        .positive("width", h.width)
        .complaint();
}

Complaint check(const Ramp& r) {
    return Check("ramp").finite("slope", r.slope).finite("at", r.at).positive_or_infinite("width", r.width).complaint();
}

Complaint check(const Square& s) {
    return Check("square")
        .finite("amplitude", s.amplitude)
        .positive("period", s.period)
        .require(s.duty > 0 && s.duty < 1, "duty", s.duty, "must lie between 0 and 1")
        .finite("at", s.at)
        .complaint();
}

Complaint check(const Sawtooth& s) {
    return Check("sawtooth")
        .finite("amplitude", s.amplitude)
        .positive("period", s.period)
        .finite("at", s.at)
        .complaint();
}

Complaint check(const Triangle& s) {
    return Check("triangle")
        .finite("amplitude", s.amplitude)
        .positive("period", s.period)
        .finite("at", s.at)
        .complaint();
}

Complaint check(const Chirp& c) {
    return Check("chirp")
        .finite("amplitude", c.amplitude)
        .not_negative("from", c.from)
        .not_negative("to", c.to)
        .positive("duration", c.duration)
        .finite("at", c.at)
        .finite("phase", c.phase)
        .complaint();
}

Complaint check(const Exponential& e) {
    return Check("exponential")
        .finite("amplitude", e.amplitude)
        .finite("tau", e.tau)
        .require(e.tau != 0, "tau", e.tau, "must not be zero")
        .finite("at", e.at)
        .complaint();
}

Complaint check(const Polynomial& p) {
    if (p.coefficients.empty()) {
        return text::Error{"polynomial: coefficients is empty; give at least one, as in coefficients = { 1, 0.5 }"};
    }
    return Check("polynomial").all_finite("coefficients", p.coefficients).finite("at", p.at).complaint();
}

Complaint check(const std::shared_ptr<const Samples>& samples) {
    if (!samples || samples->t.empty()) {
        return text::Error{"samples: there are no points; give at least one time and one value"};
    }
    if (samples->t.size() != samples->M.size()) {
        return text::Error{fmt::format("samples: t has {} values and M has {}; they must be equally long",
                                       samples->t.size(), samples->M.size())};
    }
    return Check("samples")
        .all_finite("t", samples->t)
        .all_finite("M", samples->M)
        .increasing("t", samples->t)
        .complaint();
}

Complaint check(const Scripted& s) {
    if (!s.function) {
        return text::Error{"scripted: there is no function"};
    }
    if (Complaint wrong = Check("scripted")
                              .all_finite("breaks", s.breaks)
                              .increasing("breaks", s.breaks)
                              .not_negative("period", s.period)
                              .finite("delay", s.delay)
                              .complaint()) {
        return wrong;
    }
    if (s.period > 0 && !s.breaks.empty() && s.breaks.back() - s.breaks.front() > s.period) {
        return text::Error{
            fmt::format("scripted: breaks from {} to {} span more than the period {}; give those of one period",
                        s.breaks.front(), s.breaks.back(), s.period)};
    }
    return {};
}

/// breaks = {0, 1.5, 3} with period = 3 names the same corner twice; to rounding, it must not count twice.
void drop_repeated_corner(Scripted& s) {
    constexpr double rounding = 1e-12;
    if (s.period > 0 && s.breaks.size() > 1 && s.breaks.back() - s.breaks.front() > s.period * (1 - rounding)) {
        s.breaks.pop_back();
    }
}

}  // namespace

text::Expected<Excitation> Excitation::make(Term term) {
    if (const Complaint wrong = std::visit([](const auto& t) { return check(t); }, term)) {
        return *wrong;
    }
    if (auto* script = std::get_if<Scripted>(&term)) {
        drop_repeated_corner(*script);
    }
    Excitation result;
    result.components_.push_back(Component{.gain = 1, .term = std::move(term)});
    return result;
}

}  // namespace dinal::model
