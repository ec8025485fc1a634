// Whole files: read at once into memory; written so that a failure never leaves half a file or loses the old one.
#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "text/expected.hpp"

namespace dinal::files {

/// A descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { close(); }
    void close();
    [[nodiscard]] int number() const { return number_; }

private:
    int number_;
};

/// The bytes of a file, a pipe or a device. Fails for a folder, and for what is missing, unreadable or over 4 GiB.
text::Expected<std::string> read_file(const std::string& path);

/// What a finished file holds.
struct Written {
    std::uintmax_t bytes = 0;
};

/// A file being written. Until commit() the text goes to a temporary file in the same folder, which commit() renames;
/// without a successful commit() the temporary is removed and an old file stays as it was. Symbolic links are followed.
/// What exists and is no regular file (/dev/stdout, a pipe, a device) cannot be renamed to and is written directly.
// NOTE: there is no fsync: it would cost more than all the rest, and only a power cut could tell the difference.
class OutputFile {
public:
    /// Fails when the place cannot be written: better said before a long computation than after it.
    static text::Expected<OutputFile> create(const std::string& path);

    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&&) = delete;
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile();

    /// A failure is remembered and told by commit(), so that writers need not ask after every piece.
    void write(std::string_view text);

    /// For formatting in place: at least `count` bytes to be filled from the front, then closed by used(end of text).
    char* room(std::size_t count);
    void used(const char* end);

    /// What is still to be written is of no use any more.
    [[nodiscard]] bool failed() const { return failure_ != 0; }

    /// Writes what is left and makes it the file; only now the old file is gone. To be called once.
    text::Expected<Written> commit();

private:
    OutputFile(int descriptor, std::string path);
    static text::Expected<OutputFile> directly(int descriptor, const std::string& path);
    static text::Expected<OutputFile> beside(const std::string& target, const struct stat* old,
                                             const std::string& path);
    void flush();
    void abandon();

    int descriptor_;
    std::string path_;       // as the user wrote it, for the sentence
    std::string target_;     // with links followed
    std::string temporary_;  // empty when written directly, and after the rename
    bool replaces_ = false;
    std::vector<char> buffer_;
    std::size_t filled_ = 0;
    std::uintmax_t written_ = 0;
    int failure_ = 0;  // the errno of the first failure
};

/// All of `text` as one file, in the way of OutputFile.
text::Expected<Written> write_file(const std::string& path, std::string_view text);

/// How Ctrl-C and the limits reach long files: from now on `question` decides, for the whole process, whether what
/// reads or writes one shall stop. It is asked often.
void set_stop_question(bool (*question)() noexcept) noexcept;
[[nodiscard]] bool shall_stop() noexcept;

// A file to whose end lines are added, each of them whole, also when several programs do so at once.

class Journal {
public:
    /// Makes the file when it is not there. To be opened before files are confined: it may be anywhere.
    static text::Expected<Journal> open(const std::string& path);

    /// One write, so that lines of two programs do not mix. Says why it cannot be written, if so.
    [[nodiscard]] std::optional<text::Error> add(std::string_view line) const;

private:
    Journal(int descriptor, std::string path)
        : file_(std::make_shared<Descriptor>(descriptor)), path_(std::move(path)) {}

    std::shared_ptr<Descriptor> file_;  // shared by copies
    std::string path_;
};

// The files that wait under another name until they are whole, so that a signal which ends the program can take them
// along.

/// The file of that name is removed when SIGTERM, SIGHUP or SIGQUIT ends the program, until it is forgotten.
void note_temporary(const std::string& name);
void forget_temporary(const std::string& name);

/// From now on. A signal that is ignored (nohup) stays so. SIGXFSZ becomes an error of the file that is too large.
void clean_up_on_signals();

}  // namespace dinal::files
