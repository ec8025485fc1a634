#include "prompt/record.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>

#include "files/file.hpp"
#include "lua/safe_mode.hpp"
#include "lua/tokens.hpp"
#include "text/version.hpp"
#include "text/words.hpp"

namespace dinal::prompt {
namespace {

bool has(const std::string& text, std::string_view word) {
    const std::vector<lua::Token> all = lua::tokens(text);
    return std::any_of(all.begin(), all.end(), [word](const lua::Token& token) {
        return (token.kind == lua::TokenKind::name || token.kind == lua::TokenKind::keyword || token.is("::")) &&
               token.text == word;
    });
}

/// It must not reach the inputs that follow: its local variables and labels ended with it.
bool needs_block(const std::string& statements) {
    return has(statements, "local") || has(statements, "::");
}

/// The expression between two brackets; a comment at its end must not swallow the second.
std::string in_call(std::string_view function, const std::string& expression) {
    const std::vector<lua::Token> all = lua::tokens(expression);
    const bool comment = !all.empty() && all.back().kind == lua::TokenKind::comment;
    return fmt::format("{}({}{})", function, expression, comment ? "\n" : "");
}

/// A call is a statement on its own.
bool is_call(const std::string& expression) {
    const std::vector<lua::Token> all = lua::tokens(expression);
    const auto last =
        std::find_if(all.rbegin(), all.rend(), [](const lua::Token& t) { return t.kind != lua::TokenKind::comment; });
    return last != all.rend() && (last->is(")") || last->is("}") || last->kind == lua::TokenKind::string) &&
           all.size() > 1 && all.front().kind == lua::TokenKind::name;
}

}  // namespace

void Record::add(const Chunk& chunk, const Evaluated& result) {
    if (text::trimmed(chunk.statements + chunk.expression).empty()) {
        return;
    }
    entries_.push_back({chunk, result});
    update();
}

void Record::add_statement(const std::string& statement) {
    add(Chunk{Compiled::ready, statement, "", false}, Evaluated{true, 0, false});
}

void Record::clear() {
    entries_.clear();
    begin_ = 0;
    update();
}

bool Record::writes(const std::string& file) const {
    return std::find(written_.begin(), written_.end(), file) != written_.end();
}

text::Expected<bool> Record::may_write(const std::string& file) const {
    if (lua::safe_mode() && !file.ends_with(".lua")) {
        return text::Error{fmt::format("{} does not end in .lua, and safe mode writes no other scripts", file)};
    }
    if (!writes(file) && access(file.c_str(), F_OK) == 0) {
        return text::Error{fmt::format("{} is there already, and not of this session; choose another name", file)};
    }
    return true;
}

text::Expected<bool> Record::begin(const std::string& file) {
    if (auto allowed = may_write(file); !allowed) {
        return allowed;
    }
    begin_ = entries_.size();
    file_ = file;
    problem_.clear();
    update();
    if (!problem_.empty()) {
        file_.clear();
        return text::Error{problem_};
    }
    written_.push_back(file);
    return true;
}

text::Expected<bool> Record::save(const std::string& file) {
    if (auto allowed = may_write(file); !allowed) {
        return allowed;
    }
    if (auto written = files::write_file(file, script(0)); !written) {
        return written.error();
    }
    written_.push_back(file);
    return true;
}

void Record::update() {
    if (file_.empty()) {
        return;
    }
    const auto written = files::write_file(file_, script(begin_));
    problem_ = written ? "" : written.error().sentence;
}

bool Record::sets_ans(const Entry& entry) {
    return entry.result.values > 0 && !entry.result.first_nil && !only_looks(entry.chunk);
}

/// Before another input sets it.
bool Record::ans_is_used_after(std::size_t entry) const {
    for (std::size_t i = entry + 1; i < entries_.size(); ++i) {
        if (has(entries_[i].chunk.statements, "ans") || has(entries_[i].chunk.expression, "ans")) {
            return true;
        }
        if (sets_ans(entries_[i])) {
            return false;
        }
    }
    return false;
}

std::string Record::script(std::size_t first) const {
    std::string text = "-- typed at the prompt of dinal " DINAL_VERSION "\n";
    for (std::size_t i = first; i < entries_.size(); ++i) {
        const auto& [chunk, result] = entries_[i];
        std::string lines(text::trimmed(chunk.statements));
        const std::string expression(text::trimmed(chunk.expression));
        if (!expression.empty()) {
            lines += lines.empty() ? "" : "\n";
            const bool becomes_ans = sets_ans(entries_[i]);
            if (becomes_ans && (ans_is_used_after(i) || (chunk.silent && !is_call(expression)))) {
                lines += "ans = " + expression + (chunk.silent ? "" : "\nprint(ans)");
            } else if (chunk.silent && only_looks(chunk)) {
                continue;  // it did nothing
            } else if (is_call(expression) && (chunk.silent || result.values == 0)) {
                lines += expression;
            } else {
                lines += in_call("print", expression);
            }
        }
        text += needs_block(chunk.statements) ? fmt::format("do\n{}\nend\n", lines) : lines + "\n";
    }
    return text;
}

}  // namespace dinal::prompt
