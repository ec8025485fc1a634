#include "api/script_report.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "files/file.hpp"
#include "lua/interrupt.hpp"
#include "text/words.hpp"

namespace dinal::api {
namespace {

ScriptReport* picture_taker = nullptr;

/// While it lives, files are read and written to their end although the script was stopped.
class InSpiteOfStop {
public:
    InSpiteOfStop() { files::set_stop_question(nullptr); }
    ~InSpiteOfStop() { files::set_stop_question(lua::interrupt_requested); }
    InSpiteOfStop(const InSpiteOfStop&) = delete;
    InSpiteOfStop& operator=(const InSpiteOfStop&) = delete;
};

std::string stem_of(const std::string& script) {
    const std::string name = script.substr(script.rfind('/') + 1);
    if (name == "-") return "stdin";
    const std::string ending = text::ending_of(name);
    return ending == ".lua" ? name.substr(0, name.size() - ending.size()) : name;
}

}  // namespace

ScriptReport::ScriptReport(std::string script, const std::string& errors)
    : script_(std::move(script)),
      errors_(errors),
      output_(::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1)),
      printed_(::memfd_create("report", MFD_CLOEXEC)) {
    static_cast<void>(std::fflush(stdout));
    ::dup2(printed_, STDOUT_FILENO);
    picture_taker = this;
    static_cast<void>(std::atexit(save_at_exit));  // or a script that calls os.exit has no page
    show_pictures_by([](const Picture& picture, Shown /*where*/) {
        picture_taker->take_printed();
        picture_taker->report_.items.emplace_back(drawn(picture));
    });
    show_animations_by([](const Animation& animation, Shown /*where*/) {
        picture_taker->take_printed();
        picture_taker->report_.items.emplace_back(drawn(animation));
    });
}

ScriptReport::~ScriptReport() {
    give_back();
    ::close(printed_);
}

void ScriptReport::give_back() {
    if (output_ < 0) return;
    static_cast<void>(std::fflush(stdout));
    ::dup2(output_, STDOUT_FILENO);
    ::close(output_);
    output_ = -1;
    picture_taker = nullptr;
    show_pictures_by(nullptr);
    show_animations_by(nullptr);
}

void ScriptReport::take_printed() {
    static_cast<void>(std::fflush(stdout));
    std::string text;
    std::array<char, 1U << 16U> piece{};
    for (;;) {
        const ssize_t count = ::pread(printed_, piece.data(), piece.size(), static_cast<off_t>(taken_));
        if (count <= 0) break;
        text.append(piece.data(), static_cast<std::size_t>(count));
        taken_ += static_cast<std::size_t>(count);
    }
    if (text.ends_with('\n')) text.pop_back();
    if (!text.empty()) report_.items.emplace_back(ReportLines{std::move(text)});
}

void ScriptReport::save_at_exit() {
    if (picture_taker == nullptr) return;
    ScriptReport& report = *picture_taker;
    const auto saved = report.save();
    static_cast<void>(std::fputs(report.errors_.c_str(), stderr));
    static_cast<void>(saved ? std::fprintf(stdout, "%s\n", saved.value().c_str())
                            : std::fprintf(stderr, "dinal: %s\n", saved.error().message().c_str()));
}

text::Expected<std::string> ScriptReport::save() {
    const InSpiteOfStop going_on;
    take_printed();
    give_back();
    const std::string stem = stem_of(script_);
    report_.title = stem;
    if (!errors_.empty()) report_.items.emplace_back(ReportLines{errors_, "It ended with an error"});
    if (auto source = files::read_file(script_)) {
        report_.items.emplace_back(ReportLines{std::move(source).value(), "The script"});
    }
    std::string name = stem + ".html";
    if (const auto written = files::write_file(name, html_of(report_)); !written) return written.error();
    return name;
}

}  // namespace dinal::api
