// A file to whose end lines are added, each of them whole, also when several programs do so at once.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "files/file.hpp"

namespace dinal::files {

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

}  // namespace dinal::files
