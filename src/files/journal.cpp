#include "files/journal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace dinal::files {

text::Expected<Journal> Journal::open(const std::string& path) {
    constexpr mode_t readable = 0644;
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, readable);
    if (descriptor < 0) {
        return text::Error{.sentence = "cannot write '" + path + "': " + std::generic_category().message(errno),
                           .culprit = path};
    }
    return Journal(descriptor);
}

void Journal::add(std::string_view line) const {
    const std::string whole = std::string(line) + "\n";
    static_cast<void>(!::write(file_->number(), whole.data(), whole.size()));
}

}  // namespace dinal::files
