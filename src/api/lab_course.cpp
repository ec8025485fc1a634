#include "api/lab_course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>

#include "api/classes.hpp"
#include "api/data.hpp"
#include "files/file.hpp"
#include "lua/interrupt.hpp"
#include "lua/standard_globals.hpp"
#include "lua/vector.hpp"

namespace dinal::api {
namespace {

// Written by CMakeLists.txt out of src/lab: each byte with its two halves exchanged.
constexpr unsigned char scrambled_course[] = {
#include <lab_course.inc>
};

constexpr int deepest_table = 8;

/// What the course can use: of Lua what computes, of us what it asks for.
void open_course_libraries(lua_State* course) {
    constexpr std::array<luaL_Reg, 4> libraries = {{{LUA_GNAME, luaopen_base},
                                                    {LUA_MATHLIBNAME, luaopen_math},
                                                    {LUA_STRLIBNAME, luaopen_string},
                                                    {LUA_TABLIBNAME, luaopen_table}}};
    for (const luaL_Reg& library : libraries) {
        luaL_requiref(course, library.name, library.func, 1);
        lua_pop(course, 1);
    }
    lua::make_dinal_table(course);
    for (const auto add : {register_system, register_friction, register_excitation, register_integrator, register_run,
                           register_energy, register_load, register_theory, register_vector, register_data,
                           register_steady, register_identify, register_bodies}) {
        add(course);
    }
    lua_pushglobaltable(course);
    lua::copy_fields(course);
    lua_pop(course, 2);
}

std::vector<LabSheet> added_sheets;  // set once, before any script runs

void run_in(lua_State* course, const std::string& text, const std::string& name) {
    if (luaL_loadbufferx(course, text.data(), text.size(), name.c_str(), "t") != LUA_OK) {
        lua_error(course);
    }
    lua_call(course, 0, 0);
}

int open_course(lua_State* course) {
    open_course_libraries(course);
    run_in(course, lab_course_text(), "=course");
    run_in(course, "course.added = {}", "=course");
    for (const LabSheet& sheet : added_sheets) {
        run_in(course, sheet.text, "=" + sheet.name);
    }
    return 0;
}

void copy_value(lua_State* from, int index, lua_State* to, int depth);

void copy_table(lua_State* from, int index, lua_State* to, int depth) {
    luaL_checkstack(from, 3, "too many values");
    luaL_checkstack(to, 3, "too many values");
    index = lua_absindex(from, index);
    lua_newtable(to);
    lua_pushnil(from);
    while (lua_next(from, index) != 0) {
        copy_value(from, -2, to, depth);
        copy_value(from, -1, to, depth);
        lua_rawset(to, -3);
        lua_pop(from, 1);
    }
}

/// The value at the index of one state on the top of the other; nil for what has no meaning there.
void copy_value(lua_State* from, int index, lua_State* to, int depth) {
    switch (lua_type(from, index)) {
        case LUA_TBOOLEAN:
            lua_pushboolean(to, lua_toboolean(from, index));
            return;
        case LUA_TNUMBER:
            lua_isinteger(from, index) != 0 ? lua_pushinteger(to, lua_tointeger(from, index))
                                            : lua_pushnumber(to, lua_tonumber(from, index));
            return;
        case LUA_TSTRING: {
            std::size_t size = 0;
            const char* text = lua_tolstring(from, index, &size);
            lua_pushlstring(to, text, size);
            return;
        }
        case LUA_TTABLE:
            depth < deepest_table ? copy_table(from, index, to, depth + 1) : lua_pushnil(to);
            return;
        default:
            break;
    }
    if (const auto* vector = lua::test<lua::Vector>(from, index)) {
        lua::push(to, *vector);  // its numbers are shared: nobody changes them
    } else if (const auto* data = lua::test<DataHandle>(from, index)) {
        lua::push(to, *data);
    } else {
        lua_pushnil(to);
    }
}

lua_State* new_state() {
    lua_State* course = luaL_newstate();
    if (course == nullptr) {
        throw std::bad_alloc();
    }
    return course;
}

/// The message of the error on the top of the course, which is taken.
std::string take_message(lua_State* course) {
    std::string message = lua_type(course, -1) == LUA_TSTRING ? lua_tostring(course, -1) : "the course fails";
    lua_settop(course, 0);
    return message;
}

/// course.FUNCTION(argument) in a course of its own, which returns text.
text::Expected<std::string> text_of_course(const char* function, std::int64_t argument = 0) {
    const std::unique_ptr<lua_State, void (*)(lua_State*)> state(new_state(), lua_close);
    lua_State* course = state.get();
    lua_pushcfunction(course, open_course);
    const bool opened = lua_pcall(course, 0, 0, 0) == LUA_OK;
    if (opened) {
        lua_getglobal(course, "course");
        lua_getfield(course, -1, function);
        lua_pushinteger(course, argument);
    }
    if (!opened || lua_pcall(course, 1, 1, 0) != LUA_OK) {
        return text::Error{take_message(course)};
    }
    return std::string(lua_tostring(course, -1));
}

}  // namespace

std::string lab_course_text() {
    std::string text;
    text.reserve(sizeof scrambled_course);
    for (const unsigned int byte : scrambled_course) {
        text += static_cast<char>((byte >> 4U | byte << 4U) & 0xFFU);
    }
    return text;
}

bool is_student_number(std::int64_t number) noexcept {
    return number >= 1 && number <= greatest_student_number;
}

LabCourse::LabCourse(lua_State* L) : state_(new_state(), lua_close) {
    lua_State* course = state_.get();
    const lua::RunningThread note(L, course);
    lua_pushcfunction(course, open_course);
    if (lua_pcall(course, 0, 0, 0) != LUA_OK) {
        lua::raise(L, "the lab course cannot be loaded: " + take_message(course));
    }
    charge_ = lua::MemoryCharge(static_cast<std::size_t>(lua_gc(course, LUA_GCCOUNT)) << 10U);
}

text::Expected<int> LabCourse::call(lua_State* L, const char* function, int arguments) {
    lua_State* course = state_.get();
    lua_settop(course, 0);
    luaL_checkstack(course, arguments + 4, "too many values");
    lua_getglobal(course, "course");
    lua_getfield(course, 1, function);
    lua_remove(course, 1);
    for (int i = -arguments; i < 0; ++i) {
        copy_value(L, i, course, 0);
    }
    lua_pop(L, arguments);
    int status = LUA_OK;
    {
        const lua::RunningThread note(L, course);
        status = lua_pcall(course, arguments, LUA_MULTRET, 0);
    }
    if (lua::interrupt_requested()) {
        lua::raise_interrupted(L);
    }
    if (status != LUA_OK) {
        return text::Error{take_message(course)};
    }
    const int results = lua_gettop(course);
    for (int i = 1; i <= results; ++i) {
        copy_value(course, i, L, 0);
    }
    lua_settop(course, 0);
    return results;
}

void add_lab_sheets(std::vector<LabSheet> sheets) {
    added_sheets = std::move(sheets);
}

text::Expected<std::string> lab_solutions(std::string_view number) {
    std::int64_t value = 0;
    const auto parsed = std::from_chars(number.data(), number.data() + number.size(), value);
    if (parsed.ec != std::errc() || parsed.ptr != number.data() + number.size() || !is_student_number(value)) {
        return text::Error{
            fmt::format("option --lab-solutions needs a student number after it, a whole one from 1 to {}, for example "
                        "--lab-solutions 4711{}",
                        greatest_student_number, number.empty() ? "" : fmt::format("; '{}' is not one", number))};
    }
    return text_of_course("solutions", value);
}

text::Expected<std::string> lab_sheet_test() {
    return text_of_course("test_last");
}

text::Expected<std::string> lab_question_names() {
    return text_of_course("question_names");
}

// The verdicts on answers, kept where no script can touch them: in the file of --lab-marks for the instructor, in a
// file of the user so that wrong values count in the next session, and in memory for --report.

namespace {

struct LabJournal {
    files::Journal file;
    std::string script;
};

std::optional<LabJournal> journal;      // set once, before any script runs
std::string (*tries_file)() = nullptr;  // the same
std::optional<text::Error> lost_mark;   // the first line that could not be written
std::vector<LabMark> session_answers;

constexpr const char* trial_question = "0";  // for trying check out: never kept

/// A field of CSV: in quotes, with quotes doubled and without an end of line, so that no file name breaks a line.
std::string quoted_field(std::string_view text) {
    std::string field = "\"";
    for (const char c : text) {
        field += c == '"' ? "\"\"" : std::string(1, c == '\n' || c == '\r' ? ' ' : c);
    }
    return field + '"';
}

std::string beginning_of(std::int64_t number, std::string_view question) {
    return fmt::format("{},{},", number, question);
}

void keep_wrong_value(const LabMark& mark) {
    const auto file = tries_file != nullptr ? files::Journal::open(tries_file()) : text::Error{};
    if (file) static_cast<void>(file->add(fmt::format("{}{}", beginning_of(mark.number, mark.question), mark.value)));
}

void remember(const LabMark& mark) {
    const auto found = std::find_if(session_answers.begin(), session_answers.end(), [&](const LabMark& answer) {
        return answer.number == mark.number && answer.question == mark.question;
    });
    found != session_answers.end() ? * found = mark : session_answers.emplace_back(mark);
}

}  // namespace

std::optional<text::Error> note_lab_answers(const std::string& file, const std::string& script) {
    auto opened = files::Journal::open(file);
    if (!opened) {
        return opened.error();
    }
    journal = LabJournal{std::move(opened).value(), script};
    note_lab_mark({.verdict = "begun"});
    return lost_mark;
}

void keep_lab_tries(std::string (*file)()) {
    tries_file = file;
}

std::optional<text::Error> lost_lab_mark() {
    return lost_mark;
}

void note_lab_mark(const LabMark& mark) {
    if (mark.verdict != "begun") remember(mark);
    if (mark.verdict == "wrong" && mark.question != trial_question) keep_wrong_value(mark);
    if (journal) {
        const auto wrong = journal->file.add(fmt::format("{},{},{},{},{},{},{}", quoted_field(journal->script),
                                                         mark.number, mark.question, mark.verdict, mark.tries,
                                                         mark.value, quoted_field(mark.said)));
        if (!lost_mark) lost_mark = wrong;  // the script goes on: the fault is not its own
    }
}

const std::vector<LabMark>& lab_answers() {
    return session_answers;
}

std::vector<double> earlier_wrong_values(std::int64_t number, const std::string& question) {
    std::vector<double> values;
    std::ifstream lines(tries_file != nullptr ? tries_file() : "");  // outside of what a confined script can read
    const std::string beginning = beginning_of(number, question);
    for (std::string line; std::getline(lines, line);) {
        double value = 0;
        if (!line.starts_with(beginning)) continue;
        const auto parsed = std::from_chars(line.data() + beginning.size(), line.data() + line.size(), value);
        if (parsed.ec == std::errc()) values.push_back(value);
    }
    return values;
}

}  // namespace dinal::api
