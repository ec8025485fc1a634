#include "files/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

namespace dinal::files {

namespace {

constexpr std::size_t largest_file = std::size_t{4} << 30;  // limits devices such as /dev/zero

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

namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 18;  // stays in the second-level cache
constexpr int most_links = 40;                             // as in the kernel

std::string reason(int error) {
    return std::generic_category().message(error);
}

text::Error can_not_write(const std::string& path, const std::string& why) {
    return {.sentence = "cannot write '" + path + "': " + why, .culprit = path};
}

/// Returns whether the name contains a NUL, at which the system would silently cut it.
bool has_nul(const std::string& path) {
    return path.find('\0') != std::string::npos;
}

std::string folder_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? std::string() : path.substr(0, slash + 1);
}

/// Returns the descriptor that the path names, 1 for /dev/stdout; none for other paths. Opening it by name would
/// restart at the beginning of a redirected file.
std::optional<int> open_descriptor(std::string_view path) {
    if (path == "/dev/stdout") {
        return STDOUT_FILENO;
    }
    if (path == "/dev/stderr") {
        return STDERR_FILENO;
    }
    for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
        if (path.starts_with(folder)) {
            int number = 0;
            const char* const end = path.data() + path.size();
            const auto parsed = std::from_chars(path.data() + folder.size(), end, number);
            if (parsed.ec == std::errc() && parsed.ptr == end) {
                return number;
            }
        }
    }
    return std::nullopt;
}

/// Creates a temporary file in the destination's folder. NOTE: open() rather than mkstemp(), so that umask and the
/// folder's default permissions apply.
int create_temporary(const std::string& folder, std::string& name) {
    static std::atomic<unsigned> serial{0};
    for (int attempt = 0; attempt < 100; ++attempt) {
        name = folder + ".dinal-" + std::to_string(::getpid()) + "-" + std::to_string(++serial) + ".tmp";
        note_temporary(name);  // before it exists, as a signal may come at once
        const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            return descriptor;
        }
        const int error = errno;
        forget_temporary(name);
        errno = error;
        if (error != EEXIST) {
            return descriptor;
        }
    }
    return -1;
}

}  // namespace

text::Expected<OutputFile> OutputFile::create(const std::string& path) {
    if (has_nul(path)) {
        return can_not_write(path.substr(0, path.find('\0')), "its name contains a NUL byte");
    }
    if (const auto why = outside(path, Access::write)) {
        return can_not_write(path, *why);
    }
    namespace fs = std::filesystem;
    fs::path place = path;
    std::error_code none;
    for (int link = 0; link < most_links; ++link) {
        if (const std::optional<int> number = open_descriptor(place.native())) {
            // Earlier output must come first.
            if (std::fflush(*number == STDERR_FILENO ? stderr : stdout) != 0) {
                return can_not_write(path, reason(errno));
            }
            return directly(::fcntl(*number, F_DUPFD_CLOEXEC, 3), path);
        }
        if (!fs::is_symlink(place, none)) {
            break;
        }
        place = place.parent_path() / fs::read_symlink(place, none);  // a relative target is relative to the link
    }
    const std::string& target = place.native();
    struct stat status {};
    if (::stat(target.c_str(), &status) != 0) {
        return errno == ENOENT ? beside(target, nullptr, path) : can_not_write(path, reason(errno));
    }
    if (S_ISDIR(status.st_mode)) {
        return can_not_write(path, "it is a folder, not a file");
    }
    if (!S_ISREG(status.st_mode)) {
        return directly(::open(target.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC), path);
    }
    return beside(target, &status, path);
}

text::Expected<OutputFile> OutputFile::directly(int descriptor, const std::string& path) {
    if (descriptor < 0) {
        return can_not_write(path, reason(errno));
    }
    return OutputFile(descriptor, path);
}

text::Expected<OutputFile> OutputFile::beside(const std::string& target, const struct stat* old,
                                              const std::string& path) {
    const std::string folder = folder_of(target);
    if (target.empty() || folder.size() == target.size()) {
        return can_not_write(path, "there is no file name");
    }
    // A rename needs no permission to write the old file, but a write-protected file should stay.
    if (old != nullptr && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) {
        return can_not_write(path, reason(errno));
    }
    std::string temporary;
    const int descriptor = create_temporary(folder, temporary);
    if (descriptor < 0) {
        const int error = errno;
        return can_not_write(
            path, error == ENOENT ? "there is no folder '" + folder.substr(0, folder.rfind('/')) + "'" : reason(error));
    }
    OutputFile file(descriptor, path);
    file.target_ = target;
    file.temporary_ = temporary;
    file.replaces_ = old != nullptr;
    if (old != nullptr) {
        // Only root can change the owner; for others the new file is their own, as with editors.
        [[maybe_unused]] const int owner = ::fchown(descriptor, old->st_uid, old->st_gid);
        if (::fchmod(descriptor, old->st_mode & 0777U) != 0) {
            return can_not_write(path, reason(errno));
        }
    }
    return file;
}

OutputFile::OutputFile(int descriptor, std::string path)
    : descriptor_(descriptor), path_(std::move(path)), buffer_(buffer_size) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      replaces_(other.replaces_),
      buffer_(std::move(other.buffer_)),
      filled_(other.filled_),
      written_(other.written_),
      failure_(other.failure_) {}

OutputFile::~OutputFile() {
    abandon();
}

void OutputFile::abandon() {
    if (descriptor_ >= 0) {
        ::close(std::exchange(descriptor_, -1));
    }
    if (!temporary_.empty()) {
        ::unlink(temporary_.c_str());
        forget_temporary(temporary_);
        temporary_.clear();
    }
}

void OutputFile::write(std::string_view text) {
    while (!text.empty()) {
        char* const place = room(1);
        const std::size_t count = std::min(text.size(), buffer_.size() - filled_);
        used(std::copy_n(text.data(), count, place));
        text.remove_prefix(count);
    }
}

char* OutputFile::room(std::size_t count) {
    if (buffer_.size() - filled_ < count) {
        flush();
        if (buffer_.size() < count) {
            buffer_.resize(count);
        }
    }
    return buffer_.data() + filled_;
}

void OutputFile::used(const char* end) {
    filled_ = static_cast<std::size_t>(end - buffer_.data());
}

void OutputFile::flush() {
    std::size_t done = 0;
    failure_ = failure_ == 0 && shall_stop() ? ECANCELED : failure_;
    // EINTR counts as a failure: it is Ctrl-C while the reader of a pipe sleeps.
    while (failure_ == 0 && done < filled_) {
        const ssize_t count = ::write(descriptor_, buffer_.data() + done, filled_ - done);
        if (count <= 0) {
            failure_ = count == 0 ? EIO : errno;
        } else {
            done += static_cast<std::size_t>(count);
        }
    }
    written_ += done;
    filled_ = 0;
}

text::Expected<Written> OutputFile::commit() {
    flush();
    if (::close(std::exchange(descriptor_, -1)) != 0 && failure_ == 0) {
        failure_ = errno;
    }
    if (failure_ == 0 && !temporary_.empty()) {
        if (::rename(temporary_.c_str(), target_.c_str()) == 0) {
            forget_temporary(temporary_);
            temporary_.clear();
        } else {
            failure_ = errno;
        }
    }
    abandon();
    if (failure_ != 0) {
        return can_not_write(path_, reason(failure_) + (replaces_ ? " (the old file is kept)" : ""));
    }
    return Written{written_};
}

text::Expected<Written> write_file(const std::string& path, std::string_view text) {
    text::Expected<OutputFile> opened = OutputFile::create(path);
    if (!opened) {
        return opened.error();
    }
    OutputFile file = std::move(opened).value();
    file.write(text);
    return file.commit();
}

text::Expected<Journal> Journal::open(const std::string& path) {
    constexpr mode_t readable = 0644;
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, readable);
    if (descriptor < 0) {
        return can_not_write(path, reason(errno));
    }
    return Journal(descriptor, path);
}

std::optional<text::Error> Journal::add(std::string_view line) const {
    const std::string whole = std::string(line) + "\n";
    const ssize_t written = ::write(file_->number(), whole.data(), whole.size());
    if (written == static_cast<ssize_t>(whole.size())) {
        return std::nullopt;
    }
    return can_not_write(path_, reason(written < 0 ? errno : ENOSPC));
}

namespace {

constexpr int slots = 64;  // number of files tracked at once; further ones would be left behind
constexpr std::size_t longest_name = 4096;

enum class Use { free, filling, taken };
static_assert(std::atomic<Use>::is_always_lock_free, "a signal handler may use lock-free atomics only");

struct Slot {
    std::atomic<Use> use = Use::free;
    std::array<char, longest_name> name{};
};
std::array<Slot, slots> noted_names;

extern "C" void end_by_signal(int signal) {
    for (Slot& slot : noted_names) {
        if (slot.use == Use::taken) static_cast<void>(::unlink(slot.name.data()));
    }
    struct sigaction action {};
    action.sa_handler = SIG_DFL;
    sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
    static_cast<void>(::raise(signal));  // takes effect when the handler has returned
}

extern "C" void do_nothing(int) {}

void install(int signal, void (*handler)(int), int flags) {
    struct sigaction action {};
    if (::sigaction(signal, nullptr, &action) != 0 || action.sa_handler != SIG_DFL) return;
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    action.sa_flags = flags;
    ::sigaction(signal, &action, nullptr);
}

}  // namespace

void note_temporary(const std::string& name) {
    if (name.size() >= longest_name) return;
    for (Slot& slot : noted_names) {
        Use free = Use::free;
        if (!slot.use.compare_exchange_strong(free, Use::filling)) continue;
        std::ranges::copy(name, slot.name.begin());
        slot.name[name.size()] = '\0';
        slot.use = Use::taken;
        return;
    }
}

void forget_temporary(const std::string& name) {
    for (Slot& slot : noted_names) {
        if (slot.use == Use::taken && name == slot.name.data()) {
            slot.use = Use::free;
            return;
        }
    }
}

void clean_up_on_signals() {
    for (const int signal : {SIGTERM, SIGHUP, SIGQUIT}) install(signal, end_by_signal, SA_RESTART);
    install(SIGXFSZ, do_nothing, SA_RESTART);  // so that the write fails with EFBIG
}

// Confinement of files to the current folder.

namespace {

namespace fs = std::filesystem;

fs::path root;    // empty: files are not confined
fs::path script;  // empty: none, or not found

/// The path with all links resolved; its last component need not exist. Empty on failure.
fs::path real_path(const fs::path& path) {
    std::error_code error;
    const fs::file_status own = fs::symlink_status(path, error);
    if (fs::exists(own)) {
        const fs::path real = fs::canonical(path, error);  // fails for a dangling link
        return error ? fs::path() : real;
    }
    const fs::path folder = fs::canonical(path.has_parent_path() ? path.parent_path() : fs::path("."), error);
    return error || path.filename() == ".." ? fs::path() : folder / path.filename();
}

bool begins_with(const fs::path& path, const fs::path& beginning) {
    return std::mismatch(beginning.begin(), beginning.end(), path.begin(), path.end()).first == beginning.end();
}

}  // namespace

void confine_files() {
    std::error_code error;
    root = fs::canonical(".", error);
    if (error) {
        root = "/nowhere";  // the folder is gone, so nothing may be accessed
    }
}

void allow_reading(const std::string& path) {
    std::error_code error;
    script = fs::canonical(path, error);
}

std::optional<std::string> outside(const std::string& path, Access access) {
    if (root.empty()) {
        return std::nullopt;
    }
    std::error_code error;
    const fs::path real = real_path(path);
    if (access == Access::read && !real.empty() && real == script) {
        return std::nullopt;
    }
    if (real.empty() || !begins_with(real, root)) {
        return "safe mode allows files in the current folder and below only";
    }
    const fs::file_status status = fs::status(real, error);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        return "it is not a regular file, and safe mode allows only those";
    }
    return std::nullopt;
}

}  // namespace dinal::files
