// The state of a session at the prompt, the execution of input, and the prompt itself.
#pragma once

#include <string>
#include <vector>

#include "lua/lua_headers.hpp"
#include "prompt/chunk.hpp"
#include "prompt/line_editor.hpp"
#include "text/expected.hpp"

namespace dinal::prompt {

// The inputs that ran without error, as a script that runs again.

class Record {
public:
    void add(const Chunk& chunk, const Evaluated& result);
    /// Adds a statement equivalent to a command.
    void add_statement(const std::string& statement);
    void clear() { entries_.clear(); }

    /// Writes the whole session to a file.
    text::Expected<bool> save(const std::string& file);

    /// Returns whether the file belongs to this session: a script that loads itself would never end.
    bool writes(const std::string& file) const;

private:
    struct Entry {
        Chunk chunk;
        Evaluated result;
    };
    [[nodiscard]] static bool sets_ans(const Entry& entry);
    std::string script() const;
    bool ans_is_used_after(std::size_t entry) const;

    std::vector<Entry> entries_;
    std::vector<std::string> written_;  // files of this session, which may be overwritten
};

struct Session {
    explicit Session(lua_State* state) : L(state), editor(state) {}

    lua_State* L;
    LineEditor editor;
    Record record;
    lua_CFunction show_values = print_values;
    std::vector<std::string> inputs;  ///< without commands, for :history and :edit
    bool leaving = false;             ///< set by :quit
};

/// Compiles and runs a complete text as at the prompt. Returns false after an error, which has been reported.
bool run_text(Session& session, const std::string& text);

/// Runs the function on the top of the stack, described by `chunk`. Returns false after an error, which has been
/// reported.
bool run_chunk(Session& session, const Chunk& chunk, const std::string& text);

/// The first line of a session.
std::string greeting();

enum class Start { with_init_file, plain };

/// Runs until the end of input. Returns false if Ctrl-C ended it, possible only without a terminal.
bool run_prompt(lua_State* L, Start start);

}  // namespace dinal::prompt
