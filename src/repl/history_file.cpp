#include "repl/history_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

namespace dinal {
namespace {

std::string absolute_folder(const char* variable) {
    const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): one thread
    return value != nullptr && value[0] == '/' ? value : "";
}

std::string state_folder() {
    std::string folder = absolute_folder("XDG_STATE_HOME");  // its specification: ignore it unless absolute
    if (folder.empty()) {
        const std::string home = absolute_folder("HOME");
        folder = home.empty() ? "" : home + "/.local/state";
    }
    return folder.empty() ? "" : folder + "/dinal";
}

void make_folders(const std::string& path) {
    for (std::size_t i = path.find('/', 1); i != std::string::npos; i = path.find('/', i + 1)) {
        mkdir(path.substr(0, i).c_str(), S_IRWXU);  // an error shows when the file is opened
    }
    mkdir(path.c_str(), S_IRWXU);
}

}  // namespace

std::string history_file() {
    const std::string folder = state_folder();
    if (folder.empty()) {
        return "";
    }
    make_folders(folder);
    std::string file = folder + "/history";
    const int descriptor = open(file.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (descriptor < 0) {
        return "";
    }
    close(descriptor);
    return file;
}

}  // namespace dinal
