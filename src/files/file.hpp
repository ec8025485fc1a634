// Whole files: read at once into memory, and written so that a failure neither leaves half a file nor loses the old
// one.
#pragma once

#include <sys/stat.h>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "text/expected.hpp"
#include "text/not_copied.hpp"

namespace dinal::files {

/// A file descriptor that closes itself.
class Descriptor : text::NotCopied {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() { close(); }
    void close();
    int number() const { return number_; }

private:
    int number_;
};

/// Returns the bytes of a file, pipe or device. Fails for a folder, a missing or unreadable file, or more than 4 GiB.
text::Expected<std::string> read_file(const std::string& path);

/// The size of a finished file.
struct Written {
    std::uintmax_t bytes = 0;
};

/// A file being written. Text goes to a temporary file in the same folder, which commit() renames; without a successful
/// commit() it is removed and an old file stays unchanged. Symbolic links are followed. Existing non-regular files
/// (/dev/stdout, a pipe, a device) are written directly.
// NOTE: no fsync: it would cost more than everything else, and matters only in a power failure.
class OutputFile {
public:
    /// Fails if the place cannot be written; call before a long computation.
    static text::Expected<OutputFile> create(const std::string& path);

    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    /// Stores a failure for commit(), so that writers need not check every call.
    void write(std::string_view text);

    /// For formatting in place: at least `count` bytes, to be filled from the front and ended by used(end of text).
    char* room(std::size_t count);
    void used(const char* end);

    /// Returns whether writing has failed, so that further output is useless.
    bool failed() const { return failure_ != 0; }

    /// Writes the rest and replaces the old file. Call once.
    text::Expected<Written> commit();

private:
    OutputFile(int descriptor, std::string path);
    static text::Expected<OutputFile> directly(int descriptor, const std::string& path);
    static text::Expected<OutputFile> beside(const std::string& target, const struct stat* old,
                                             const std::string& path);
    void flush();
    void abandon();

    int descriptor_;
    std::string path_;       // as the user wrote it, for errors
    std::string target_;     // with links resolved
    std::string temporary_;  // empty if written directly, and after the rename
    bool replaces_ = false;
    std::vector<char> buffer_;
    std::size_t filled_ = 0;
    std::uintmax_t written_ = 0;
    int failure_ = 0;  // errno of the first failure
};

/// Writes `text` as one file through OutputFile.
text::Expected<Written> write_file(const std::string& path, std::string_view text);

/// Sets the function that decides, for the whole process, whether reading and writing stops, as for Ctrl-C and limits.
/// It is called often.
void set_stop_question(bool (*question)() noexcept) noexcept;
[[nodiscard]] bool shall_stop() noexcept;

/// A file to which lines are appended atomically, also by several programs at once.
class Journal {
public:
    /// Creates the file if missing. Open it before files are confined, as it may be anywhere.
    static text::Expected<Journal> open(const std::string& path);

    /// Appends with one write, so that lines of two programs do not mix. Returns an error if that fails.
    [[nodiscard]] std::optional<text::Error> add(std::string_view line) const;

private:
    Journal(int descriptor, std::string path)
        : file_(std::make_shared<Descriptor>(descriptor)), path_(std::move(path)) {}

    std::shared_ptr<Descriptor> file_;  // shared by copies
    std::string path_;
};

// Temporary files, which are removed if a signal ends the program.

/// Registers a file to be removed if SIGTERM, SIGHUP or SIGQUIT ends the program, until it is forgotten.
void note_temporary(const std::string& name);
void forget_temporary(const std::string& name);

/// Installs the handlers. An ignored signal (nohup) stays ignored. SIGXFSZ becomes an error of the file that is too
/// large.
void clean_up_on_signals();

/// Confines the whole process: OutputFile and read_file refuse anything but regular files in the current folder or
/// below. Links are resolved first.
void confine_files();

/// Allows one file elsewhere to be read: the script, whose text a file of results may need.
void allow_reading(const std::string& path);

enum class Access { read, write };

/// Returns the reason why this path cannot be used; none if it is allowed.
std::optional<std::string> outside(const std::string& path, Access access);

}  // namespace dinal::files
