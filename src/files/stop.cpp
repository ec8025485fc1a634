#include "files/stop.hpp"

namespace dinal::files {
namespace {

bool (*stop_question)() noexcept = nullptr;

}  // namespace

void set_stop_question(bool (*question)() noexcept) noexcept {
    stop_question = question;
}

bool shall_stop() noexcept {
    return stop_question != nullptr && stop_question();
}

}  // namespace dinal::files
