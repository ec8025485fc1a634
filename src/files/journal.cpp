#include "files/journal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace dinal::files {

namespace {

text::Error cannot_write(const std::string& path, int reason) {
    return {.sentence = "cannot write '" + path + "': " + std::generic_category().message(reason), .culprit = path};
}

}  // namespace

text::Expected<Journal> Journal::open(const std::string& path) {
    constexpr mode_t readable = 0644;
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, readable);
    if (descriptor < 0) {
        return cannot_write(path, errno);
    }
    return Journal(descriptor, path);
}

std::optional<text::Error> Journal::add(std::string_view line) const {
    const std::string whole = std::string(line) + "\n";
    const ssize_t written = ::write(file_->number(), whole.data(), whole.size());
    if (written == static_cast<ssize_t>(whole.size())) {
        return std::nullopt;
    }
    return cannot_write(path_, written < 0 ? errno : ENOSPC);
}

}  // namespace dinal::files
