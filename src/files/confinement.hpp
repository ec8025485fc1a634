// Confines all reading and writing of files to the start folder, for scripts of strangers.
#pragma once

#include <optional>
#include <string>

namespace dinal::files {

/// Confines the whole process: OutputFile and read_file refuse anything but regular files in the current folder or
/// below. Links are resolved first.
void confine_files();

/// Allows one file elsewhere to be read: the script, whose text a file of results may need.
void allow_reading(const std::string& path);

enum class Access { read, write };

/// Returns the reason why this path cannot be used; none if it is allowed.
std::optional<std::string> outside(const std::string& path, Access access);

}  // namespace dinal::files
