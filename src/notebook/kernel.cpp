#include "notebook/kernel.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "api/animate.hpp"
#include "api/data.hpp"
#include "api/picture.hpp"
#include "files/file.hpp"
#include "lua/bind.hpp"
#include "lua/lua_headers.hpp"
#include "prompt/commands.hpp"
#include "prompt/completion.hpp"
#include "prompt/output.hpp"
#include "prompt/script.hpp"
#include "prompt/session.hpp"
#include "terminal/progress.hpp"
#include "text/not_copied.hpp"
#include "text/words.hpp"

namespace dinal::notebook {
namespace {

// ---- A cell has no keyboard: reading from it raises an error instead of returning nothing.

void refuse_keyboard(lua_State* L, const char* call) {
    lua::raise(L, {.sentence = std::string(call) +
                               ": a notebook has no keyboard to read from; put the value into a variable, as in x = 3",
                   .call = call});
}

/// Calls Lua's original function. Upvalues of all replacements: that function, io.stdin, its name, io.input.
int original_with_arguments(lua_State* L) {
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
    return lua_gettop(L);
}

/// io.read and io.lines: refuse the keyboard unless another file is set.
int read_input(lua_State* L) {
    const char* name = lua_tostring(L, lua_upvalueindex(3));
    const bool names_file = std::string_view(name) == "io.lines" && !lua_isnoneornil(L, 1);
    if (!names_file) {
        lua_pushvalue(L, lua_upvalueindex(4));
        lua_call(L, 0, 1);
        const bool keyboard = lua_rawequal(L, -1, lua_upvalueindex(2)) != 0;
        lua_pop(L, 1);
        if (keyboard) refuse_keyboard(L, name);
    }
    return original_with_arguments(L);
}

/// file:read and file:lines
int read_file_handle(lua_State* L) {
    if (lua_rawequal(L, 1, lua_upvalueindex(2)) != 0) refuse_keyboard(L, lua_tostring(L, lua_upvalueindex(3)));
    return original_with_arguments(L);
}

/// Replaces a function in the table on the top of the stack; `io` is the index of that table.
void replace_function(lua_State* L, int io, const char* key, const char* name, lua_CFunction ours) {
    if (lua_getfield(L, -1, key) != LUA_TFUNCTION) {
        lua_pop(L, 1);
        return;
    }
    lua_getfield(L, io, "stdin");
    lua_pushstring(L, name);
    lua_getfield(L, io, "input");
    lua_pushcclosure(L, ours, 4);
    lua_setfield(L, -2, key);
}

/// Makes io.read(), io.lines() and methods of io.stdin raise errors; other files are unaffected.
void take_keyboard_away(lua_State* L) {
    const int top = lua_gettop(L);
    if (lua_getglobal(L, "io") == LUA_TTABLE && lua_getfield(L, -1, "stdin") == LUA_TUSERDATA) {
        lua_pop(L, 1);
        const int io = lua_gettop(L);
        replace_function(L, io, "read", "io.read", lua::guarded<read_input>);
        replace_function(L, io, "lines", "io.lines", lua::guarded<read_input>);
        if (luaL_getmetatable(L, LUA_FILEHANDLE) == LUA_TTABLE && lua_getfield(L, -1, "__index") == LUA_TTABLE) {
            replace_function(L, io, "read", "io.stdin:read", lua::guarded<read_file_handle>);
            replace_function(L, io, "lines", "io.stdin:lines", lua::guarded<read_file_handle>);
        }
    }
    lua_settop(L, top);
}

namespace fs = std::filesystem;
using Json = nlohmann::json;

int answers_descriptor = -1;

constexpr std::size_t longest_request = std::size_t{16} << 20;

/// Writes a complete line of JSON; invalid UTF-8 becomes U+FFFD.
void answer(const Json& message) {
    const std::string line = message.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    prompt::flush_output();
    std::string_view rest = line;
    while (!rest.empty()) {
        const ssize_t written = ::write(answers_descriptor, rest.data(), rest.size());
        if (written < 0 && errno != EINTR) {
            return;  // the client has gone
        }
        rest.remove_prefix(written > 0 ? static_cast<std::size_t>(written) : 0);
    }
}

/// Lines of standard input, hidden from scripts: programs that they start read an empty input.
class Requests : text::NotCopied {
public:
    Requests() : input_(::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1)) {
        const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
        ::dup2(nothing, STDIN_FILENO);
        ::close(nothing);
    }
    ~Requests() { ::close(input_); }

    std::optional<std::string> next() {
        for (std::size_t searched = 0;;) {
            if (const std::size_t end = read_.find('\n', searched); end != std::string::npos) {
                std::string line = read_.substr(0, end);
                read_.erase(0, end + 1);
                if (end > longest_request) line.clear();  // too long: refused later
                return line;
            }
            if (read_.size() > longest_request) read_.resize(longest_request + 1);
            searched = read_.size();
            std::array<char, 1U << 14U> piece{};
            const ssize_t count = ::read(input_, piece.data(), piece.size());
            if (count > 0) {
                read_.append(piece.data(), static_cast<std::size_t>(count));
            } else if (count == 0 || errno != EINTR) {
                return std::nullopt;
            }
        }
    }

private:
    int input_;
    std::string read_;
};

/// A picture as SVG, and as text for other viewers.
Json shown_picture(const api::Picture& picture) {
    Json forms{{"text/plain", api::text_of_picture(picture)}};
    if (auto svg = api::svg_of(picture)) {
        forms["image/svg+xml"] = std::move(svg).value();
    } else {
        forms["text/plain"] = forms["text/plain"].get<std::string>() + "\n(" + svg.error().message() + ")";
    }
    return forms;
}

void show_picture(const api::Picture& picture, api::Shown where) {
    if (where == api::Shown::in_file) return;
    answer({{"show", shown_picture(picture)}});
}

void show_animation(const api::Animation& animation, api::Shown where) {
    if (where == api::Shown::in_file) return;
    answer({{"show", {{"text/plain", animation.title}, {"image/svg+xml", animation.svg}}}});
}

void show_progress(const std::string& line) {
    answer({{"progress", line}});
}

int show_values_as_json(lua_State* L) {
    constexpr std::size_t rows_shown = 50;
    Json forms{{"text/plain", prompt::values_text(L)}};
    if (lua_gettop(L) == 1) {
        if (const auto* picture = lua::test<api::Picture>(L, 1)) {
            forms = shown_picture(*picture);
        } else if (const auto* data = lua::test<api::DataHandle>(L, 1)) {
            forms["text/html"] = api::html_of(**data, rows_shown);
        }
    }
    answer({{"value", forms}});
    return 0;
}

Json execute(prompt::Session& session, const std::string& code) {
    std::string errors;
    bool fine = true;
    {
        const prompt::ErrorsInto collected(errors);
        if (prompt::is_command(code)) {
            prompt::run_command(session, code);
        } else {
            fine = prompt::run_text(session, code);
        }
    }
    if (!errors.empty()) errors.pop_back();
    return fine ? Json{{"ok", true}, {"notice", errors}} : Json{{"ok", false}, {"error", errors}};
}

std::size_t word_begin(std::string_view before) {
    std::size_t begin = before.size();
    while (begin > 0 && text::is_name_char(before[begin - 1])) --begin;
    return begin;
}

Json completed(lua_State* L, const std::string& before) {
    const bool command = prompt::is_command(before) && before.starts_with(':');
    const prompt::Completion completion = command ? prompt::complete_command(L, before) : prompt::complete(L, before);
    return {{"names", completion.names}, {"word", before.size() - word_begin(before)}};
}

/// The name around the cursor: sys.omega0, run:at.
std::string name_at(std::string_view before, std::string_view after) {
    const auto belongs = [](char c) { return text::is_name_char(c) || c == '.' || c == ':'; };
    std::size_t begin = before.size(), end = 0;
    while (begin > 0 && belongs(before[begin - 1])) --begin;
    while (end < after.size() && text::is_name_char(after[end])) ++end;
    return std::string(before.substr(begin)) + std::string(after.substr(0, end));
}

Json explained(lua_State* L, const std::string& before, const std::string& after) {
    const std::string name = name_at(before, after);
    if (name.empty() || prompt::TypedText(before).cursor() == prompt::Cursor::option) {
        return {{"text", prompt::signature_hint(L, before)}};
    }
    std::string text = prompt::answer_to(L, name);
    return {{"text", text.starts_with("nothing about ") ? "" : std::move(text)}};
}

const char* completeness(lua_State* L, const std::string& code) {
    const prompt::Compiled result =
        prompt::is_command(code) ? prompt::Compiled::ready : prompt::compile(L, code).result;
    lua_settop(L, 0);
    return result == prompt::Compiled::ready        ? "complete"
           : result == prompt::Compiled::incomplete ? "incomplete"
                                                    : "invalid";
}

std::string words_of(const Json& request, const char* name) {
    const auto found = request.find(name);
    return found != request.end() && found->is_string() ? found->get<std::string>() : "";
}

Json answer_to_request(prompt::Session& session, const Json& request) {
    const std::string what = words_of(request, "do");
    if (what == "execute") return execute(session, words_of(request, "code"));
    if (what == "complete") return completed(session.L, words_of(request, "before"));
    if (what == "inspect") return explained(session.L, words_of(request, "before"), words_of(request, "after"));
    if (what == "check") return {{"state", completeness(session.L, words_of(request, "code"))}};
    return {{"wrong", "a request does execute, complete, inspect or check, not '" + what + "'"}};
}

// ---- Jupyter's folders

std::string variable(const char* name) {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): one thread
    return value == nullptr ? "" : value;
}

/// Jupyter's data folder; empty without a home folder.
fs::path jupyter_folder() {
    if (const std::string own = variable("JUPYTER_DATA_DIR"); !own.empty()) return own;
    if (const std::string data = variable("XDG_DATA_HOME"); !data.empty()) return fs::path(data) / "jupyter";
    const std::string home = variable("HOME");
    return home.empty() ? fs::path() : fs::path(home) / ".local" / "share" / "jupyter";
}

}  // namespace

bool run_kernel(lua_State* L, int answers) {
    if (answers <= STDERR_FILENO || ::fcntl(answers, F_SETFD, FD_CLOEXEC) < 0) {
        prompt::complain(fmt::format(
            "--kernel={} is not an open descriptor; this option is for notebooks: run dinal --jupyter-install "
            "(docs/notebook.md)",
            answers));
        return false;
    }
    answers_descriptor = answers;
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // terminates this process when the notebook's ends
    Requests requests;
    prompt::Session session(L);
    session.show_values = lua::guarded<show_values_as_json>;
    take_keyboard_away(L);
    api::show_pictures_by(show_picture);
    api::show_animations_by(show_animation);
    terminal::show_progress_by(show_progress);
    while (!session.leaving) {
        const auto line = requests.next();
        if (!line) break;
        const Json request = Json::parse(*line, nullptr, false);
        const auto id = request.find("id");
        // Accept only a primitive id: copying and writing recurse into nested values.
        const bool plain = request.is_object() && (id == request.end() || id->is_primitive());
        Json answered = plain ? answer_to_request(session, request)
                              : Json{{"wrong",
                                      "a request is an object of JSON in one line of at most 16 MiB, and its id is a "
                                      "number or a string"}};
        answered["done"] = plain && id != request.end() ? *id : Json();
        lua_settop(L, 0);
        answer(answered);
    }
    api::show_pictures_by(nullptr);
    api::show_animations_by(nullptr);
    terminal::show_progress_by(nullptr);
    return true;
}

text::Expected<std::string> install_kernel() {
    const fs::path data = jupyter_folder();
    if (data.empty()) return text::Error{"HOME is not set, so there is no folder for the kernel: set JUPYTER_DATA_DIR"};
    std::error_code failed;
    const fs::path program = fs::read_symlink("/proc/self/exe", failed);
    for (const auto& [name, shown, options] :
         {std::tuple{"dinal", "dinal", ""}, std::tuple{"dinal-safe", "dinal (safe)", "--safe"}}) {
        const fs::path folder = data / "kernels" / name, script = folder / "dinal_kernel.py";
        std::error_code unmade;
        fs::create_directories(folder, unmade);
        if (unmade) return text::error("cannot make the folder {}: {}", folder.string(), unmade.message());
        const Json kernel{{"argv", {"/usr/bin/python3", script.string(), "-f", "{connection_file}"}},
                          {"display_name", shown},
                          {"language", "lua"},
                          {"interrupt_mode", "signal"},
                          {"env", {{"DINAL", failed ? "dinal" : program.string()}, {"DINAL_KERNEL_OPTIONS", options}}}};
        for (const auto& [path, content] : {std::pair{script, std::string(kernel_script)},
                                            std::pair{folder / "kernel.json", kernel.dump(1) + "\n"}}) {
            if (const auto written = files::write_file(path.string(), content); !written) return written.error();
        }
    }
    return fmt::format(
        "the kernels 'dinal' and 'dinal (safe)' for notebooks are in {}\n"
        "they need Debian's python3-ipykernel, and a notebook such as the package jupyter-notebook\n",
        (data / "kernels").string());
}

}  // namespace dinal::notebook
