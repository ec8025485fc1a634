// The inputs of this session and of earlier ones: in a file, in the list that the up arrow goes through, and as what a
// line that is being typed may become.
#pragma once

#ifdef DINAL_READLINE

#include <string>
#include <string_view>

namespace dinal::prompt {

/// Reads the inputs of earlier sessions; `file` may be empty.
void open_history(const std::string& file);

/// Adds an entry, which may have several lines, to the list and to the file. Returns why that could not be written the
/// first time it could not; the file is then as it was.
std::string add_to_history(const std::string& entry, const std::string& file);

/// How the last input that began as this line went on; "" when none did.
std::string suggested(std::string_view line);

/// While it lives, the up arrow goes through these lines first: those of a chunk that goes on.
class LinesAbove {
public:
    explicit LinesAbove(std::string_view lines);
    ~LinesAbove();
    LinesAbove(const LinesAbove&) = delete;
    LinesAbove& operator=(const LinesAbove&) = delete;

private:
    int count_ = 0;
};

}  // namespace dinal::prompt

#endif
