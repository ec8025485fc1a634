// Whether what writes or reads a file shall stop: how Ctrl-C and the limits reach long files. Nobody asks by itself.
#pragma once

namespace dinal::files {

/// From now on `question` decides, for the whole process. It is asked often.
void set_stop_question(bool (*question)() noexcept) noexcept;

[[nodiscard]] bool shall_stop() noexcept;

}  // namespace dinal::files
