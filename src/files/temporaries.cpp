#include "files/temporaries.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>

namespace dinal::files {
namespace {

constexpr int slots = 64;  // as many files may be written at once; of more than that some would be left behind
constexpr std::size_t longest_name = 4096;

enum class Use { free, filling, taken };
static_assert(std::atomic<Use>::is_always_lock_free, "a signal handler may use lock-free atomics only");

struct Slot {
    std::atomic<Use> use = Use::free;
    std::array<char, longest_name> name{};
};
std::array<Slot, slots> noted_names;

extern "C" void end_by_signal(int signal) {
    for (Slot& slot : noted_names) {
        if (slot.use == Use::taken) static_cast<void>(::unlink(slot.name.data()));
    }
    struct sigaction action {};
    action.sa_handler = SIG_DFL;
    sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
    static_cast<void>(::raise(signal));  // when the handler has returned
}

extern "C" void do_nothing(int) {}

void install(int signal, void (*handler)(int), int flags) {
    struct sigaction action {};
    if (::sigaction(signal, nullptr, &action) != 0 || action.sa_handler != SIG_DFL) return;
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    action.sa_flags = flags;
    ::sigaction(signal, &action, nullptr);
}

}  // namespace

void note_temporary(const std::string& name) {
    if (name.size() >= longest_name) return;
    for (Slot& slot : noted_names) {
        Use free = Use::free;
        if (!slot.use.compare_exchange_strong(free, Use::filling)) continue;
        std::copy(name.begin(), name.end(), slot.name.begin());
        slot.name[name.size()] = '\0';
        slot.use = Use::taken;
        return;
    }
}

void forget_temporary(const std::string& name) {
    for (Slot& slot : noted_names) {
        if (slot.use == Use::taken && name == slot.name.data()) {
            slot.use = Use::free;
            return;
        }
    }
}

void clean_up_on_signals() {
    for (const int signal : {SIGTERM, SIGHUP, SIGQUIT}) install(signal, end_by_signal, SA_RESTART);
    install(SIGXFSZ, do_nothing, SA_RESTART);  // and the write fails with EFBIG
}

}  // namespace dinal::files
