#include "plots/gnuplot.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "files/file.hpp"

namespace dinal::plots {
namespace {

text::Error failure(const std::string& what) {
    return {"cannot run gnuplot: " + what};
}
text::Error failure(int error) {
    return failure(std::generic_category().message(error));
}

using files::Descriptor;

/// A started program. What is still running when this goes is killed: nobody would read what it writes.
class Child {
public:
    Child() = default;
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        if (id_ > 0) {
            ::kill(id_, SIGKILL);
            wait();
        }
    }
    /// Returns the errno of a failure.
    int start(int input, int output, int errors);
    void limit_memory(std::size_t bytes) const {
        const rlimit limit{bytes, bytes};
        ::prlimit(id_, RLIMIT_AS, &limit, nullptr);
    }
    int wait() {
        int status = 0;
        while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
        }
        id_ = 0;
        return status;
    }

private:
    pid_t id_ = 0;
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

/// To the end; nothing when go_on() says no before.
std::optional<std::string> read_all(int descriptor, const std::function<bool()>& go_on) {
    std::string text;
    std::vector<char> piece(std::size_t{1} << 16U);  // not on the stack, which may be small
    for (;;) {
        constexpr int now_and_then = 50;  // ms; a signal to this thread wakes it up at once
        pollfd readable{descriptor, POLLIN, 0};
        const bool ready = ::poll(&readable, 1, now_and_then) > 0;
        if (go_on && !go_on()) {
            return std::nullopt;
        }
        const ssize_t count = ready ? ::read(descriptor, piece.data(), piece.size()) : 0;
        if (count > 0) {
            text.append(piece.data(), static_cast<std::size_t>(count));
        } else if (ready && (count == 0 || errno != EINTR)) {
            return text;
        }
    }
}

/// Ours, but in the C locale and without what sets gnuplot up (GNUTERM, GNUPLOT_LIB, GDFONTPATH, FIT_LOG ...): a
/// picture must not depend on who draws it.
std::vector<char*> environment() {
    static char locale[] = "LC_ALL=C.UTF-8";
    std::vector<char*> all;
    for (char** entry = environ; *entry != nullptr; ++entry) {
        const std::string_view variable = *entry;
        constexpr std::array<std::string_view, 5> theirs{"LC_ALL=", "GNUTERM", "GNUPLOT_", "GDFONTPATH", "FIT_"};
        if (std::none_of(theirs.begin(), theirs.end(), [=](auto start) { return variable.starts_with(start); })) {
            all.push_back(*entry);
        }
    }
    all.push_back(locale);
    all.push_back(nullptr);
    return all;
}

int Child::start(int input, int output, int errors) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
    static char name[] = "gnuplot", defaults[] = "--default-settings";
    const std::array<char*, 3> arguments{name, defaults, nullptr};
    const int error = ::posix_spawnp(&id_, name, &actions, nullptr, arguments.data(), environment().data());
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

/// The first line in which gnuplot says something of its own, not the command it shows again.
std::string first_complaint(const std::string& text) {
    const std::size_t line = text.find("line 0: ");
    const std::size_t begin = line == std::string::npos ? text.find_first_not_of(" \n") : line + 8;
    return begin == std::string::npos ? "" : text.substr(begin, text.find('\n', begin) - begin);
}

text::Error complaint(int status, int errors) {
    if (WIFSIGNALED(status)) {
        return failure("it was stopped by signal " + std::to_string(WTERMSIG(status)));
    }
    ::lseek(errors, 0, SEEK_SET);
    const std::string words = first_complaint(read_all(errors, {}).value_or(""));
    return failure(words.empty()
                       ? "it ended with exit code " + std::to_string(WEXITSTATUS(status)) + " and drew nothing"
                       : "it says: " + words);
}

}  // namespace

text::Expected<std::string> run_gnuplot(std::string_view commands, const GnuplotLimits& limits) {
    const Descriptor input(nameless_file()), errors(nameless_file());
    std::array<int, 2> ends{-1, -1};
    if (input.number() < 0 || errors.number() < 0 || !write_all(input.number(), commands) ||
        ::pipe2(ends.data(), O_CLOEXEC) != 0) {
        return failure(errno);
    }
    const Descriptor from(ends[0]);
    Descriptor to(ends[1]);
    Child child;
    if (const int error = child.start(input.number(), to.number(), errors.number()); error != 0) {
        return error == ENOENT ? text::Error{"files .svg, .png and .pdf are drawn by gnuplot, which is not installed: "
                                       "install the Debian package gnuplot-nox "
                                       "(plots in the terminal and .gp files need no gnuplot)"}
                               : failure(error);
    }
    if (limits.memory > 0) {
        constexpr std::size_t own_needs = std::size_t{256}
                                          << 20U;  // addresses; libraries and fonts took 150 MB of them
        child.limit_memory(own_needs + std::min(limits.memory, std::size_t{1} << 48U));
    }
    to.close();
    std::optional<std::string> picture = read_all(from.number(), limits.go_on);
    if (!picture) {
        return failure("it was interrupted");
    }
    const int status = child.wait();
    if (status != 0 || picture->empty()) {
        return complaint(status, errors.number());
    }
    return std::move(*picture);
}

}  // namespace dinal::plots
