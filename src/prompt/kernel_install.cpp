#include "prompt/kernel.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "files/file.hpp"

namespace dinal::prompt {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): one thread
    return value == nullptr ? "" : value;
}

/// Empty when there is no home.
fs::path jupyter_folder() {
    if (const std::string own = variable("JUPYTER_DATA_DIR"); !own.empty()) return own;
    if (const std::string data = variable("XDG_DATA_HOME"); !data.empty()) return fs::path(data) / "jupyter";
    const std::string home = variable("HOME");
    return home.empty() ? fs::path() : fs::path(home) / ".local" / "share" / "jupyter";
}

std::optional<text::Error> write(const fs::path& path, const std::string& content) {
    auto file = files::OutputFile::create(path.string());
    if (!file) return file.error();
    auto opened = std::move(file).value();
    opened.write(content);
    const auto written = opened.commit();
    return written ? std::nullopt : std::optional(written.error());
}

}  // namespace

text::Expected<std::string> install_kernel() {
    const fs::path data = jupyter_folder();
    if (data.empty()) return text::Error{"HOME is not set, so there is no folder for the kernel: set JUPYTER_DATA_DIR"};
    const fs::path folder = data / "kernels" / "dinal", script = folder / "dinal_kernel.py";
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) return text::Error{fmt::format("cannot make the folder {}: {}", folder.string(), failed.message())};
    const fs::path program = fs::read_symlink("/proc/self/exe", failed);
    const nlohmann::json kernel{{"argv", {"/usr/bin/python3", script.string(), "-f", "{connection_file}"}},
                                {"display_name", "dinal"},
                                {"language", "lua"},
                                {"interrupt_mode", "signal"},
                                {"env", {{"DINAL", failed ? "dinal" : program.string()}}}};
    for (const auto& [path, content] :
         {std::pair{script, std::string(kernel_script)}, std::pair{folder / "kernel.json", kernel.dump(1) + "\n"}}) {
        if (auto wrong = write(path, content)) return *wrong;
    }
    return fmt::format(
        "the kernel 'dinal' for notebooks is in {}\n"
        "it needs Debian's python3-ipykernel, and a notebook such as the package jupyter-notebook\n",
        folder.string());
}

}  // namespace dinal::prompt
