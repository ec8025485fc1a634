#include "files/file.hpp"
#include "files/csv.hpp"
#include "support/catch.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "support/temporary_folder.hpp"

namespace dinal::file_test {

using Catch::Matchers::Contains;
using Catch::Matchers::Equals;
using namespace dinal::files;
using namespace dinal::testing;
namespace fs = std::filesystem;

namespace {

mode_t rights(const std::string& path) {
    struct stat status {};
    REQUIRE(::stat(path.c_str(), &status) == 0);
    return status.st_mode & 0777U;
}

/// A disk that is full after `bytes`: the kernel refuses files that grow over the limit.
class FullDisk {
public:
    explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit small{bytes, old_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &small);
    }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;
    ~FullDisk() {
        ::setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, handler_);
    }

private:
    rlimit old_{};
    void (*handler_)(int);
};

}  // namespace

TEST_CASE("a file is read as it is, byte by byte", "[file]") {
    const TemporaryFolder folder;
    const std::string all = std::string("\0\r\n\xEF\xBB\xBF", 6) + std::string(100000, 'x') + "end";
    put_text(folder.file("a"), all);
    put_text(folder.file("empty"), "");
    CHECK(*read_file(folder.file("a")) == all);
    CHECK(read_file(folder.file("empty"))->empty());
}

TEST_CASE("a file of unknown size is read to its end", "[file]") {
    CHECK(read_file("/dev/null")->empty());
    const auto status = read_file("/proc/self/status");
    REQUIRE(status);
    CHECK_THAT(*status, Contains("core_tests") || Contains("Name:"));
}

TEST_CASE("a fifo is read and written through", "[file]") {
    const TemporaryFolder folder;
    const std::string fifo = folder.file("fifo");
    REQUIRE(::mkfifo(fifo.c_str(), 0600) == 0);
    const std::string text(300000, 'y');  // more than a pipe holds
    bool written = false;
    std::thread writer([&] { written = static_cast<bool>(write_file(fifo, text)); });
    const auto back = read_file(fifo);
    writer.join();
    REQUIRE(back);
    CHECK(*back == text);
    CHECK(written);
    CHECK(fs::is_fifo(fifo));
}

TEST_CASE("a file that cannot be read is reported with its name and the reason", "[file]") {
    const TemporaryFolder folder;
    CHECK(read_file(folder.file("none")).error().sentence ==
          "cannot read '" + folder.file("none") + "': No such file or directory");
    CHECK(read_file(folder.path()).error().sentence ==
          "cannot read '" + folder.path().string() + "': it is a folder, not a file");
    CHECK_THAT(read_file("").error().sentence, Equals("cannot read '': No such file or directory"));
    CHECK_THAT(read_file("/proc/self/mem").error().sentence, Contains("Input/output error"));
    CHECK_THAT(read_file(std::string("a\0b", 3)).error().sentence, Contains("'a'") && Contains("NUL"));
    if (::geteuid() != 0) {  // root may read anything
        put_text(folder.file("secret"), "x");
        fs::permissions(folder.file("secret"), fs::perms::none);
        CHECK_THAT(read_file(folder.file("secret")).error().sentence, Contains("Permission denied"));
    }
}

TEST_CASE("a file larger than 4 GiB is refused before it fills the memory", "[file]") {
    const TemporaryFolder folder;
    put_text(folder.file("sparse"), "");
    REQUIRE(::truncate(folder.file("sparse").c_str(), (off_t{4} << 30) + 1) == 0);
    CHECK_THAT(read_file(folder.file("sparse")).error().sentence, Contains("larger than 4 GiB"));
}

TEST_CASE("a written file holds exactly the text, in pieces small and large", "[file]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("out");
    auto file = OutputFile::create(path);
    REQUIRE(file);
    OutputFile out = std::move(file).value();
    std::string expected;
    for (std::size_t length = 0; length < 1500; ++length) {  // over a million bytes: the buffer is flushed on the way
        const std::string piece(length, static_cast<char>('a' + length % 26));
        out.write(piece);
        expected += piece;
    }
    const std::string large(3000000, 'L');
    out.write(large);
    char* const place = out.room(2000000);  // more than the buffer had
    std::fill_n(place, 1999999, 'R');
    out.used(place + 1999999);
    expected += large + std::string(1999999, 'R');
    const auto written = out.commit();
    REQUIRE(written);
    CHECK(written->bytes == expected.size());
    CHECK(text_of(path) == expected);
    CHECK(folder.count() == 1);
}

TEST_CASE("a file is invisible until it is complete", "[file]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("run.csv");
    put_text(path, "old");
    {
        auto file = OutputFile::create(path);
        REQUIRE(file);
        OutputFile out = std::move(file).value();
        out.write(std::string(1000000, 'n'));
        CHECK(text_of(path) == "old");
    }  // given up without commit
    CHECK(text_of(path) == "old");
    CHECK(folder.count() == 1);
}

TEST_CASE("a full disk leaves the old file and no temporary file", "[file]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("run.csv");
    put_text(path, "old");
    const std::string large(1000000, 'n');
    for (const rlim_t limit : {rlim_t{0}, rlim_t{1}, rlim_t{500000}, rlim_t{999999}}) {
        std::string sentence;
        {
            const FullDisk disk(limit);
            const auto written = write_file(path, large);
            sentence = written ? "no failure" : written.error().sentence;
        }
        CHECK(sentence == "cannot write '" + path + "': File too large (the old file is kept)");
        CHECK(text_of(path) == "old");
        CHECK(folder.count() == 1);
    }
    {
        const FullDisk disk(10);
        CHECK_FALSE(write_file(folder.file("new.csv"), large));
    }
    CHECK(folder.count() == 1);
}

TEST_CASE("a device without room is an error, even for a few bytes", "[file]") {
    if (::access("/dev/full", W_OK) != 0) {
        WARN("no /dev/full here");
        return;
    }
    CHECK(write_file("/dev/full", "x").error().sentence == "cannot write '/dev/full': No space left on device");
    CHECK_FALSE(write_file("/dev/full", std::string(1000000, 'x')));
    CHECK(fs::is_character_file("/dev/full"));
}

TEST_CASE("a device is written directly", "[file]") {
    CHECK(write_file("/dev/null", "x")->bytes == 1);
    CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("an open descriptor is written at its current position", "[file]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("redirected");
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT, 0600);
    REQUIRE(descriptor >= 0);
    REQUIRE(::write(descriptor, "before ", 7) == 7);
    CHECK(write_file("/dev/fd/" + std::to_string(descriptor), "between"));
    REQUIRE(::write(descriptor, " after", 6) == 6);
    ::close(descriptor);
    CHECK(text_of(path) == "before between after");
    CHECK_THAT(write_file("/dev/fd/987", "x").error().sentence, Contains("Bad file descriptor"));
}

TEST_CASE("a file that cannot be written is reported at once with its name and the reason", "[file]") {
    const TemporaryFolder folder;
    CHECK(OutputFile::create(folder.path()).error().sentence ==
          "cannot write '" + folder.path().string() + "': it is a folder, not a file");
    CHECK(OutputFile::create(folder.file("no/such/file")).error().sentence ==
          "cannot write '" + folder.file("no/such/file") + "': there is no folder '" + folder.file("no/such") + "'");
    CHECK_THAT(OutputFile::create("").error().sentence, Contains("there is no file name"));
    CHECK_THAT(OutputFile::create(folder.file("new/")).error().sentence, Contains("there is no file name"));
    CHECK_THAT(OutputFile::create(std::string("a\0b", 3)).error().sentence, Contains("NUL"));
    put_text(folder.file("file"), "");
    CHECK_THAT(OutputFile::create(folder.file("file/below")).error().sentence, Contains("Not a directory"));
    CHECK_THAT(OutputFile::create(folder.file(std::string(300, 'n'))).error().sentence, Contains("name too long"));
    CHECK_THAT(OutputFile::create("/proc/none").error().sentence, Contains("cannot write '/proc/none'"));
    CHECK(folder.count() == 1);
}

TEST_CASE("a write-protected file and folder are respected", "[file]") {
    if (::geteuid() == 0) {
        return;  // root may write anything
    }
    const TemporaryFolder folder;
    const std::string path = folder.file("kept");
    put_text(path, "old");
    fs::permissions(path, fs::perms::owner_read);
    CHECK_THAT(write_file(path, "new").error().sentence, Contains("Permission denied"));
    CHECK(text_of(path) == "old");
    fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
    CHECK_THAT(write_file(folder.file("other"), "new").error().sentence, Contains("Permission denied"));
    fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST_CASE("a new file has the rights of the umask, a replaced one keeps its own", "[file]") {
    const TemporaryFolder folder;
    const mode_t old = ::umask(027);
    const auto written = write_file(folder.file("new"), "x");
    ::umask(old);
    REQUIRE(written);
    CHECK(rights(folder.file("new")) == 0640);
    REQUIRE(::chmod(folder.file("new").c_str(), 0604) == 0);
    REQUIRE(write_file(folder.file("new"), "y"));
    CHECK(rights(folder.file("new")) == 0604);
    CHECK(text_of(folder.file("new")) == "y");
}

TEST_CASE("a symbolic link stays a link, and its target is written", "[file]") {
    const TemporaryFolder folder;
    fs::create_directory(folder.file("deep"));
    put_text(folder.file("deep/target"), "old");
    fs::create_symlink("deep/target", folder.file("relative"));
    fs::create_symlink(folder.file("relative"), folder.file("chain"));
    fs::create_symlink("deep/later", folder.file("dangling"));
    fs::create_symlink("loop", folder.file("loop"));
    REQUIRE(write_file(folder.file("chain"), "new"));
    CHECK(fs::is_symlink(folder.file("chain")));
    CHECK(fs::is_symlink(folder.file("relative")));
    CHECK(text_of(folder.file("deep/target")) == "new");
    REQUIRE(write_file(folder.file("dangling"), "first"));
    CHECK(fs::is_symlink(folder.file("dangling")));
    CHECK(text_of(folder.file("deep/later")) == "first");
    CHECK_THAT(write_file(folder.file("loop"), "x").error().sentence, Contains("Too many levels"));
}

TEST_CASE("a file name with blanks, quotes and letters beyond ASCII is only a name", "[file]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("Versuch 'ä' $(x).csv");
    REQUIRE(write_file(path, "x"));
    CHECK(text_of(path) == "x");
}

TEST_CASE("a writer that is told to stop leaves the old file", "[file]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("rows.csv");
    REQUIRE(write_file(path, "old"));
    set_stop_question([]() noexcept { return true; });
    const auto written = write_file(path, std::string(std::size_t{1} << 20U, 'x'));
    set_stop_question(nullptr);
    REQUIRE_FALSE(written);
    CHECK(written.error().sentence.find("the old file is kept") != std::string::npos);
    CHECK(*read_file(path) == "old");
}

TEST_CASE("a reader that is told to stop reads no further", "[file]") {
    std::string text = "t,theta\n";
    for (int i = 0; i < 100'000; ++i) text += "1,2\n";
    int questions = 0;
    static int* asked = &questions;
    set_stop_question([]() noexcept { return ++*asked == 3; });
    const auto table = parse_columns(text, "x.csv");
    set_stop_question(nullptr);
    REQUIRE(table);
    CHECK(table->columns.front().numbers.size() < 20'000);
}

}  // namespace dinal::file_test
