// Builds text from sentences.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

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
    /// Continues the last sentence.
    template <class... Values>
    void add(fmt::format_string<Values...> format, Values&&... values) {
        sentences_ += fmt::format(format, std::forward<Values>(values)...);
    }
    void end_paragraph() {
        if (sentences_.empty()) return;
        text_ += (text_.empty() ? "" : "\n") + text::wrapped(sentences_);
        sentences_.clear();
    }

    std::string text_, sentences_;  // finished paragraphs, and the present one
};

}  // namespace dinal::analysis
