#include "files/share.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <string_view>

namespace dinal::files {
namespace {

struct Launcher {
    const char* rank;
    const char* size;
    bool needs_size = true;       ///< otherwise a rank without a size is ignored
    const char* first = nullptr;  ///< the rank that counts as 0; 0 without it
    const char* last = nullptr;   ///< the greatest one
};

constexpr std::array<Launcher, 5> launchers{{
    {"DINAL_RANK", "DINAL_SIZE"},
    {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
    {"PMI_RANK", "PMI_SIZE"},
    // Slurm sets a rank and SLURM_NTASKS in the shell of every batch job; only srun starts several processes.
    {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS", false},
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", true, "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX"},
}};

std::string_view setting(const char* name) {
    const char* text = name == nullptr ? nullptr : std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody sets any
    return text == nullptr ? std::string_view() : std::string_view(text);
}

std::optional<long long> whole_number(std::string_view text) {
    long long number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

text::Expected<std::optional<Share>> share_of(const Launcher& launcher) {
    const std::string_view rank_text = setting(launcher.rank);
    const std::string_view size_text = setting(launcher.size);
    if (size_text.empty()) {
        return text::Error{
            fmt::format("{} = {} says that this is one of several processes, but {} does not say of how "
                        "many: set it, or unset {}",
                        launcher.rank, rank_text, launcher.size, launcher.rank)};
    }
    const auto rank = whole_number(rank_text), size = whole_number(size_text);
    const long long first = whole_number(setting(launcher.first)).value_or(0);
    const auto last = whole_number(setting(launcher.last));
    const long long step =
        size && last && *size > 1 ? std::max((*last - first) / (*size - 1), 1LL) : 1;  // --array=0-90:10
    if (!rank || !size || *size < 1 || *rank < first || (*rank - first) / step >= *size ||
        (*rank - first) % step != 0) {
        return text::Error{
            fmt::format("{} = {} and {} = {} name no share: the first must be a whole number from 0 to one "
                        "less than the second",
                        launcher.rank, rank_text, launcher.size, size_text)};
    }
    return std::optional(Share{(*rank - first) / step, *size});
}

}  // namespace

text::Expected<std::optional<Share>> share_of_launcher() {
    for (const Launcher& launcher : launchers) {
        if (setting(launcher.rank).empty() || (!launcher.needs_size && setting(launcher.size).empty())) continue;
        auto share = share_of(launcher);
        // A step of one task in a job array: the array counts.
        if (share && (*share)->size == 1 && &launcher != &launchers.back()) continue;
        return share;
    }
    return std::optional<Share>();
}

}  // namespace dinal::files
