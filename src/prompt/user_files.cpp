#include "prompt/user_files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

namespace dinal::prompt {
namespace {

std::string absolute_folder(const char* variable) {
    const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): one thread
    return value != nullptr && value[0] == '/' ? value : "";
}

/// dinal's folder inside that of the variable, otherwise inside `in_home` of the home folder; empty if both are unset.
std::string own_folder(const char* variable, const char* in_home) {
    std::string folder = absolute_folder(variable);  // the XDG specification ignores relative paths
    if (folder.empty()) {
        const std::string home = absolute_folder("HOME");
        folder = home.empty() ? "" : home + in_home;
    }
    return folder.empty() ? "" : folder + "/dinal";
}

void make_folders(const std::string& path) {
    for (std::size_t i = path.find('/', 1); i != std::string::npos; i = path.find('/', i + 1)) {
        mkdir(path.substr(0, i).c_str(), S_IRWXU);  // errors show when the file is opened
    }
    mkdir(path.c_str(), S_IRWXU);
}

}  // namespace

std::string state_file(const char* name) {
    const std::string folder = own_folder("XDG_STATE_HOME", "/.local/state");
    if (folder.empty()) {
        return "";
    }
    make_folders(folder);
    std::string file = folder + "/" + name;
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (descriptor < 0) {
        return "";
    }
    close(descriptor);
    return file;
}

std::string init_file() {
    const std::string folder = own_folder("XDG_CONFIG_HOME", "/.config");
    const std::string file = folder.empty() ? "" : folder + "/init.lua";
    return !file.empty() && access(file.c_str(), F_OK) == 0 ? file : "";
}

std::string lab_course_file() {
    const std::string folder = own_folder("XDG_CONFIG_HOME", "/.config");
    return folder.empty() ? "" : folder + "/lab-course.lua";
}

}  // namespace dinal::prompt
