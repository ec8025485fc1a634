// The inputs of this and earlier sessions: in a file, in readline's list, and as suggestions for the present line.
#pragma once

#ifdef DINAL_READLINE

#include <string>
#include <string_view>

#include "text/not_copied.hpp"

namespace dinal::prompt {

/// Loads the inputs of earlier sessions; `file` may be empty.
void open_history(const std::string& file);

/// Adds an entry, possibly of several lines, to the list and the file. Returns the first failure to write, with the
/// file unchanged.
std::string add_to_history(const std::string& entry, const std::string& file);

/// The continuation of the last input that begins with this line; "" without one.
std::string suggested(std::string_view line);

/// While this object lives, the up arrow first visits these lines of an unfinished chunk.
class LinesAbove : text::NotCopied {
public:
    explicit LinesAbove(std::string_view lines);
    ~LinesAbove();

private:
    int count_ = 0;
};

}  // namespace dinal::prompt

#endif
