// A file to whose end lines are added, each of them whole, also when several programs do so at once.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "files/file.hpp"

namespace dinal::files {

class Journal {
public:
    /// Makes the file when it is not there. To be opened before files are confined: it may be anywhere.
    static text::Expected<Journal> open(const std::string& path);

    /// One write, so that lines of two programs do not mix. What cannot be written is lost: a script must not fail for
    /// the sake of it.
    void add(std::string_view line) const;

private:
    explicit Journal(int descriptor) : file_(std::make_shared<Descriptor>(descriptor)) {}

    std::shared_ptr<Descriptor> file_;  // shared by copies
};

}  // namespace dinal::files
