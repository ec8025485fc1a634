// Text made sentence by sentence, and the sentences that steady motions of one body and of several share.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "analysis/steady.hpp"
#include "text/characters.hpp"
#include "text/sentences.hpp"

namespace dinal::analysis {

class Prose {
protected:
    template <class... Values>
    void say(fmt::format_string<Values...> format, Values&&... values) {
        sentences_ += sentences_.empty() ? "" : " ";
        add(format, std::forward<Values>(values)...);
    }
    /// Goes on with the last sentence.
    template <class... Values>
    void add(fmt::format_string<Values...> format, Values&&... values) {
        sentences_ += fmt::format(format, std::forward<Values>(values)...);
    }
    void end_paragraph() {
        if (sentences_.empty()) return;
        text_ += (text_.empty() ? "" : "\n") + text::wrapped(sentences_);
        sentences_.clear();
    }

    std::string text_, sentences_;  // whole paragraphs, and the present one
};

class SteadyProse : protected Prose {
protected:
    void tell_period(const SteadyMotion& motion, bool timeless) {
        if (timeless) {
            say("The motion is a limit cycle of period {:.6g}.", motion.period);
        } else {
            say("The motion repeats itself every {:.6g}, {} of M.", motion.period,
                motion.periods == 1 ? "the period" : fmt::format("{} periods", motion.periods));
        }
    }
    void tell_unbounded() { say("There is no steady motion: the amplitude grows without bound."); }
    void tell_none(const SteadyMotion& motion, bool timeless) {
        if (timeless) {
            say("No limit cycle was found: the motion is irregular, or it settles very slowly.");
        } else {
            say("No motion of up to 32 periods of M was found within {} periods: the motion is irregular, or it "
                "settles very slowly.",
                motion.maps);
        }
    }
    void tell_stability(const SteadyMotion& motion) {
        if (!motion.differentiable) return;
        double largest = 0;
        for (const std::complex<double>& value : motion.multipliers) largest = std::max(largest, std::abs(value));
        if (!motion.stable) {
            say("It is unstable: a disturbance grows by a factor of {:.6g} in a period, so no run stays on it.",
                largest);
        } else if (largest > 1 - 1e-6) {
            say("It is marginally stable: a disturbance neither grows nor decays.");
        } else if (largest < 1e-12) {
            say("It is stable: a disturbance is gone after one period.");
        } else {
            say("It is stable: {} of a disturbance remains after a period.", text::percent(largest));
        }
    }
};

}  // namespace dinal::analysis
