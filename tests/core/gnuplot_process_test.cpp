#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "plots/gnuplot.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace dinal::gnuplot_process_test {

using namespace dinal::plots;

namespace {

/// With this PATH until the end of the scope.
class Path {
public:
    explicit Path(const std::string& path) : old_(std::getenv("PATH")) { ::setenv("PATH", path.c_str(), 1); }
    Path(const Path&) = delete;
    Path& operator=(const Path&) = delete;
    ~Path() { ::setenv("PATH", old_.c_str(), 1); }

private:
    std::string old_;
};

/// In the place of gnuplot until the end of the scope: a shell script.
class Impostor {
public:
    explicit Impostor(const std::string& script) : path_(folder_.path().string()) {
        const std::string file = folder_.file("gnuplot");
        testing::put_text(file, "#!/bin/sh\n" + script + "\n");
        std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    }

private:
    testing::TemporaryFolder folder_;
    Path path_;
};

}  // namespace

TEST_CASE("without gnuplot one sentence says what to install", "[gnuplot]") {
    const testing::TemporaryFolder empty;
    const Path path(empty.path().string());
    const auto picture = run_gnuplot("plot sin(x)");
    REQUIRE(!picture);
    CHECK(picture.error().sentence.find("install the Debian package gnuplot-nox") != std::string::npos);
}

TEST_CASE("what gnuplot complains about is told", "[gnuplot]") {
    const auto picture = run_gnuplot("set terminal svg\nplot nonsense(x)\n");
    REQUIRE(!picture);
    CHECK(picture.error().sentence.find("undefined function: nonsense") != std::string::npos);
}

TEST_CASE("a gnuplot that ends without a word is told, too", "[gnuplot]") {
    const auto sentence_of = [](const char* script) {
        const Impostor impostor(script);
        const auto picture = run_gnuplot("plot sin(x)");
        REQUIRE(!picture);
        return picture.error().sentence;
    };
    CHECK(sentence_of("kill -9 $$") == "cannot run gnuplot: it was stopped by signal 9");
    CHECK(sentence_of("exit 3") == "cannot run gnuplot: it ended with exit code 3 and drew nothing");
    CHECK(sentence_of("echo '<svg'; exit 3") == "cannot run gnuplot: it ended with exit code 3 and drew nothing");
    CHECK(sentence_of("echo boom >&2") == "cannot run gnuplot: it says: boom");
}

TEST_CASE("gnuplot is killed as soon as it shall not go on", "[gnuplot]") {
    const testing::TemporaryFolder folder;
    const Impostor impostor("echo $$ >" + folder.file("id") + "; echo '<svg'; exec /bin/sleep 60");
    const auto begin = std::chrono::steady_clock::now();
    const auto picture =
        run_gnuplot("plot sin(x)", {.go_on = [&] { return !std::filesystem::exists(folder.file("id")); }});
    REQUIRE(!picture);
    CHECK(picture.error().sentence == "cannot run gnuplot: it was interrupted");
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(30));  // of 60, on a busy machine
    const std::string id = testing::text_of(folder.file("id"));
    if (!id.empty()) {
        CHECK(!std::filesystem::exists("/proc/" + id.substr(0, id.find('\n'))));
    }
}

TEST_CASE("gnuplot gets no more memory than allowed above what it needs itself", "[gnuplot]") {
    constexpr std::size_t little = 16U << 20U;
    CHECK(run_gnuplot("set terminal pdfcairo\nplot sin(x)\n", {.memory = little}));
    CHECK(!run_gnuplot("set terminal pngcairo size 20000,20000\nplot sin(x)\n", {.memory = little}));
}

}  // namespace dinal::gnuplot_process_test
