#include "io/gnuplot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace dinal {
namespace {

Error failure(const std::string& what) {
    return {"can not run gnuplot: " + what};
}
Error failure(int error) {
    return failure(std::generic_category().message(error));
}

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { close(); }
    void close() {
        if (number_ >= 0) {
            ::close(std::exchange(number_, -1));
        }
    }
    [[nodiscard]] int number() const { return number_; }

private:
    int number_;
};

/// A file without a name, in memory. With one for the input and one for the errors there is only one pipe to read, and
/// nobody can wait for anybody.
int nameless_file() {
    return ::memfd_create("dinal", MFD_CLOEXEC);
}

bool write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t count = ::write(descriptor, text.data(), text.size());
        if (count < 0 && errno != EINTR) {
            return false;
        }
        text.remove_prefix(count > 0 ? static_cast<std::size_t>(count) : 0);
    }
    return ::lseek(descriptor, 0, SEEK_SET) == 0;
}

std::string read_all(int descriptor) {
    std::string text;
    std::array<char, 1U << 16U> piece{};
    for (;;) {
        const ssize_t count = ::read(descriptor, piece.data(), piece.size());
        if (count > 0) {
            text.append(piece.data(), static_cast<std::size_t>(count));
        } else if (count == 0 || errno != EINTR) {
            return text;
        }
    }
}

/// Ours, but in the C locale: a picture must not depend on who draws it.
std::vector<char*> environment() {
    static char locale[] = "LC_ALL=C.UTF-8";
    std::vector<char*> all;
    for (char** entry = environ; *entry != nullptr; ++entry) {
        if (std::string_view(*entry).substr(0, 7) != "LC_ALL=") {
            all.push_back(*entry);
        }
    }
    all.push_back(locale);
    all.push_back(nullptr);
    return all;
}

int start(pid_t& child, int input, int output, int errors) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
    static char name[] = "gnuplot", defaults[] = "--default-settings";
    const std::array<char*, 3> arguments{name, defaults, nullptr};
    const int error = ::posix_spawnp(&child, name, &actions, nullptr, arguments.data(), environment().data());
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

/// The first line in which gnuplot says something of its own, not the command it shows again.
std::string first_complaint(const std::string& text) {
    const std::size_t line = text.find("line 0: ");
    const std::size_t begin = line == std::string::npos ? text.find_first_not_of(" \n") : line + 8;
    return begin == std::string::npos ? "" : text.substr(begin, text.find('\n', begin) - begin);
}

}  // namespace

Expected<std::string> run_gnuplot(std::string_view commands) {
    const Descriptor input(nameless_file()), errors(nameless_file());
    std::array<int, 2> ends{-1, -1};
    if (input.number() < 0 || errors.number() < 0 || !write_all(input.number(), commands) ||
        ::pipe2(ends.data(), O_CLOEXEC) != 0) {
        return failure(errno);
    }
    const Descriptor from(ends[0]);
    Descriptor to(ends[1]);
    pid_t child = 0;
    if (const int error = start(child, input.number(), to.number(), errors.number()); error != 0) {
        return error == ENOENT ? Error{"files .svg, .png and .pdf are drawn by gnuplot, which is not installed: install "
                                       "the Debian package gnuplot-nox (plots in the terminal and .gp files need no "
                                       "gnuplot)"}
                               : failure(error);
    }
    to.close();
    std::string picture = read_all(from.number());
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFSIGNALED(status)) {
        return failure("it was stopped by signal " + std::to_string(WTERMSIG(status)));
    }
    if (WEXITSTATUS(status) != 0 || picture.empty()) {
        ::lseek(errors.number(), 0, SEEK_SET);
        return failure("it says: " + first_complaint(read_all(errors.number())));
    }
    return picture;
}

}  // namespace dinal
