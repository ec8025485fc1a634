// Words that are no names of dinal, and that somebody asks help about all the same.
#pragma once

#include <string_view>

namespace dinal::help {

/// A few lines about the topic that has most of the words, whose case does not matter; empty if there is none.
std::string_view topic(std::string_view words);

/// Our word for one of another language, friction for Reibung; else the word itself.
std::string_view in_english(std::string_view word);

}  // namespace dinal::help
