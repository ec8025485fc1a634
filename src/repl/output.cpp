#include "repl/output.hpp"

#include <cstdio>

namespace dinal {

void say(std::string_view text) {
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stdout));
}

void flush_output() {
    static_cast<void>(std::fflush(stdout));
}

void say_error(std::string_view text) {
    flush_output();
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
    static_cast<void>(std::fputc('\n', stderr));
}

}  // namespace dinal
