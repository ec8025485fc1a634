// What one session at the prompt remembers, and what it does with a text that was typed.
#pragma once

#include <string>
#include <vector>

#include "lua/lua_headers.hpp"
#include "prompt/chunk.hpp"
#include "prompt/line_editor.hpp"
#include "text/expected.hpp"

namespace dinal::prompt {

// What was typed in a session and ran without error, as a script that runs again.

class Record {
public:
    void add(const Chunk& chunk, const Evaluated& result);
    /// A statement that stands for a command.
    void add_statement(const std::string& statement);
    void clear();

    /// From now on the file is kept up to date. What is recorded so far is left out.
    text::Expected<bool> begin(const std::string& file);
    /// All of the session so far, into this file.
    text::Expected<bool> save(const std::string& file);

    [[nodiscard]] const std::string& file() const { return file_; }
    /// The file is one of this session: a script that loads itself would never end.
    [[nodiscard]] bool writes(const std::string& file) const;
    /// Why the file is no longer up to date; empty when it is.
    [[nodiscard]] const std::string& problem() const { return problem_; }

private:
    struct Entry {
        Chunk chunk;
        Evaluated result;
    };
    [[nodiscard]] static bool sets_ans(const Entry& entry);
    [[nodiscard]] std::string script(std::size_t first) const;
    [[nodiscard]] bool ans_is_used_after(std::size_t entry) const;
    [[nodiscard]] text::Expected<bool> may_write(const std::string& file) const;
    void update();

    std::vector<Entry> entries_;
    std::string file_;
    std::string problem_;
    std::size_t begin_ = 0;             // the first entry of the file
    std::vector<std::string> written_;  // files of this session: they may be written again
};

struct Session {
    explicit Session(lua_State* state) : L(state), editor(state) {}

    lua_State* L;
    LineEditor editor;
    Record record;
    lua_CFunction show_values = print_values;
    std::vector<std::string> inputs;  ///< what was typed, commands left out: for :history and :edit
    bool leaving = false;             ///< :quit
};

/// Compiles and runs a text that is all there is to come, as at the prompt. False after an error, which was told.
bool run_text(Session& session, const std::string& text);

/// Runs the function on the top of the stack, which `chunk` describes. False after an error, which was told.
bool run_chunk(Session& session, const Chunk& chunk, const std::string& text);

}  // namespace dinal::prompt
