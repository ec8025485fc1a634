// Keeps all reading and writing of files to the folder where the program was started, for scripts of strangers.
#pragma once

#include <optional>
#include <string>

namespace dinal::files {

/// From now on, for the whole process: OutputFile and read_file refuse what is not a regular file in the current folder
/// or below it. Links are followed first.
void confine_files();

/// One file elsewhere may be read all the same: the script, whose text a file of results may need.
void allow_reading(const std::string& path);

enum class Access { read, write };

/// Why this path cannot be used, or nothing: files are not confined, or it is within.
std::optional<std::string> outside(const std::string& path, Access access);

}  // namespace dinal::files
