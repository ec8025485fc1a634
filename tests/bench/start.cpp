// The program as a process, from its start to its end, by the wall clock.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "items.hpp"

namespace bench {
namespace {

/// A folder with an empty script, which is also the home of the programs started: their history must not become ours.
class Home {
public:
    Home() : path_(std::filesystem::temp_directory_path() / ("dinal-bench-home-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(path_);
        std::ofstream(path_ / "empty.lua").close();
    }
    Home(const Home&) = delete;
    Home& operator=(const Home&) = delete;
    ~Home() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    [[nodiscard]] std::string path() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

const Home& home() {
    static const Home one;
    return one;
}

/// Runs the program with nothing to read and nobody to write to; its exit code, or -1.
int run_program(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), DINAL_PROGRAM);
    std::vector<char*> argv;
    for (std::string& argument : arguments) {
        argv.push_back(argument.data());
    }
    argv.push_back(nullptr);
    std::string home_variable = "HOME=" + home().path();
    std::array<char*, 2> environment = {home_variable.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int fault = posix_spawn(&child, DINAL_PROGRAM, &actions, nullptr, argv.data(), environment.data());
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (fault != 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) {
        return -1;
    }
    return WEXITSTATUS(status);
}

void measure(benchmark::State& state, const std::vector<std::string>& arguments) {
    using Clock = std::chrono::steady_clock;
    for ([[maybe_unused]] auto iteration : state) {
        const auto began = Clock::now();
        const int code = run_program(arguments);
        state.SetIterationTime(std::chrono::duration<double>(Clock::now() - began).count());
        if (code != 0) {
            state.SkipWithError("the program failed");
            break;
        }
    }
}

}  // namespace

void register_start(Results& results) {
    const auto add = [&](std::string_view group, const std::string& name, const std::vector<std::string>& arguments) {
        const Item& item = results.of(std::string(group), name);
        benchmark::RegisterBenchmark((item.group + "/" + name).c_str(), [arguments](benchmark::State& state) {
            measure(state, arguments);
        })->UseManualTime();
    };
    add(plots_group, std::string(report_figures), {DINAL_EXAMPLES "/report/all.lua", home().path()});
    add(start_group, "to the end of -e \"\"", {"-e", ""});
    add(start_group, "to the end of an empty script", {home().path() + "/empty.lua"});
    add(start_group, "to the prompt", {"-i"});  // whose input has ended already: it prompts once and leaves
}

}  // namespace bench
