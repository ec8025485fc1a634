#include "prompt/history.hpp"

#ifdef DINAL_READLINE

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <system_error>

#include "files/file.hpp"
#include "text/words.hpp"

// After <cstdio>: readline.h needs FILE.
#include <readline/history.h>

namespace dinal::prompt {
namespace {

constexpr int longest_history = 5000;  // entries

std::string_view entry_at(int i) {
    const HIST_ENTRY* entry = history_get(history_base + i);
    return entry == nullptr ? std::string_view() : entry->line;
}

/// Appends the text; returns errno or 0. A partial write is undone.
int append(const std::string& file, const std::string& text) {
    const files::Descriptor output(::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
    struct stat before {};
    if (output.number() < 0 || ::fstat(output.number(), &before) != 0) {
        return errno;
    }
    const ssize_t written = ::write(output.number(), text.data(), text.size());
    if (written == static_cast<ssize_t>(text.size())) {
        return 0;
    }
    const int why = written < 0 ? errno : ENOSPC;
    if (S_ISREG(before.st_mode) && ::ftruncate(output.number(), before.st_size) != 0) {
        return errno;
    }
    return why;
}

}  // namespace

void open_history(const std::string& file) {
    // Time stamps let an entry of several lines be read back as one.
    history_comment_char = '#';
    history_write_timestamps = 1;
    stifle_history(longest_history);
    if (!file.empty()) {
        history_truncate_file(file.c_str(), longest_history);
        read_history(file.c_str());
    }
}

std::string add_to_history(const std::string& entry, const std::string& file) {
    static bool complained = false;
    if (entry.find_first_not_of(" \t\n") == std::string::npos ||
        (history_length > 0 && entry_at(history_length - 1) == entry)) {
        return "";
    }
    add_history(entry.c_str());
    if (file.empty()) {
        return "";
    }
    // Immediately: the session may end by a signal or os.exit.
    const int why = append(file, "#" + std::to_string(std::time(nullptr)) + "\n" + entry + "\n");
    const bool first = why != 0 && !complained;
    complained = complained || why != 0;
    return first ? "this input is not in " + file + ": " + std::generic_category().message(why) : "";
}

std::string suggested(std::string_view line) {
    constexpr std::size_t shortest = 2;
    if (line.size() < shortest || line.find_first_not_of(' ') == std::string_view::npos) {
        return "";
    }
    for (int i = history_length - 1; i >= 0; --i) {
        const std::string_view entry = entry_at(i);
        if (entry.size() > line.size() && entry.starts_with(line) && entry.find('\n') == std::string_view::npos) {
            return std::string(entry.substr(line.size()));
        }
    }
    return "";
}

LinesAbove::LinesAbove(std::string_view lines) {
    for (const std::string_view line : text::split(lines, '\n')) {
        if (line.empty()) continue;
        add_history(std::string(line).c_str());
        ++count_;
    }
    using_history();
}

LinesAbove::~LinesAbove() {
    for (; count_ > 0 && history_length > 0; --count_) {
        HIST_ENTRY* const entry = remove_history(history_length - 1);
        std::free(free_history_entry(entry));  // NOLINT: allocated by readline; only the entry's data remain
    }
    using_history();
}

}  // namespace dinal::prompt

#endif
