#include "files/confinement.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace dinal::files {
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
