#include "files/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "files/confinement.hpp"

namespace dinal::files {
namespace {

constexpr std::size_t largest_file = std::size_t{4} << 30;  // /dev/zero never ends

text::Error can_not_read(const std::string& path, const std::string& why) {
    return {.sentence = "cannot read '" + path + "': " + why, .culprit = path};
}

bool (*stop_question)() noexcept = nullptr;

}  // namespace

void Descriptor::close() {
    if (number_ >= 0) {
        ::close(std::exchange(number_, -1));
    }
}

text::Expected<std::string> read_file(const std::string& path) {
    if (path.find('\0') != std::string::npos) {
        return can_not_read(path.substr(0, path.find('\0')), "its name contains a NUL byte");
    }
    if (const auto why = outside(path, Access::read)) {
        return can_not_read(path, *why);
    }
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat status {};
    if (file.number() < 0 || ::fstat(file.number(), &status) != 0) {
        return can_not_read(path, std::generic_category().message(errno));
    }
    if (S_ISDIR(status.st_mode)) {
        return can_not_read(path, "it is a folder, not a file");
    }
    std::string text;
    std::size_t length = 0;
    std::size_t room = std::max<std::size_t>(static_cast<std::size_t>(status.st_size) + 1, 4096);
    for (;;) {
        if (length >= largest_file || room > largest_file + 1) {
            return can_not_read(path, "it is larger than 4 GiB");
        }
        text.resize(room);
        const ssize_t count = ::read(file.number(), text.data() + length, room - length);
        if (count < 0) {
            return can_not_read(path, std::generic_category().message(errno));
        }
        if (count == 0) {
            text.resize(length);
            return text;
        }
        length += static_cast<std::size_t>(count);
        if (length == room) {
            room = std::min(2 * room, largest_file + 1);
        }
    }
}

void set_stop_question(bool (*question)() noexcept) noexcept {
    stop_question = question;
}

bool shall_stop() noexcept {
    return stop_question != nullptr && stop_question();
}

}  // namespace dinal::files
