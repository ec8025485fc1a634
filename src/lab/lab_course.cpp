#include "lab/lab_course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <optional>

#include "api/classes.hpp"
#include "api/data.hpp"
#include "files/file.hpp"
#include "lua/interrupt.hpp"
#include "lua/standard_globals.hpp"
#include "lua/vector.hpp"
#include "lua/worker_state.hpp"
#include "terminal/progress.hpp"

namespace dinal::lab {

using namespace api;

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
    for (const auto add :
         {register_system, register_friction, register_excitation, register_integrator, register_run, register_energy,
          register_load, register_theory, register_vector, register_data, register_steady, register_identify}) {
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

/// course.FUNCTION(name, argument), or without the name if it is empty, in a course of its own: the texts it returns.
template <std::size_t count = 1>
text::Expected<std::array<std::string, count>> texts_of_course(const char* function, std::int64_t argument = 0,
                                                               const std::string& name = "") {
    const std::unique_ptr<lua_State, void (*)(lua_State*)> state(new_state(), lua_close);
    lua_State* course = state.get();
    lua_pushcfunction(course, open_course);
    const bool opened = lua_pcall(course, 0, 0, 0) == LUA_OK;
    if (opened) {
        lua_getglobal(course, "course");
        lua_getfield(course, -1, function);
        if (!name.empty()) lua::push_text(course, name);
        lua_pushinteger(course, argument);
    }
    if (!opened || lua_pcall(course, name.empty() ? 1 : 2, count, 0) != LUA_OK) {
        return text::Error{take_message(course)};
    }
    std::array<std::string, count> texts;
    for (std::size_t i = 0; i < count; ++i)
        texts[i] = lua_tostring(course, static_cast<int>(i) - static_cast<int>(count));
    return texts;
}

text::Expected<std::string> text_of_course(const char* function, std::int64_t argument = 0) {
    auto texts = texts_of_course(function, argument);
    if (!texts) return texts.error();
    return std::move(texts).value()[0];
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
    void* of_allocator = nullptr;
    lua_Alloc allocator = lua_getallocf(L, &of_allocator);  // the one that counts, where memory is limited
    lua_setallocf(course, allocator, of_allocator);
    const lua::RunningThread note(L, course);
    lua_pushcfunction(course, open_course);
    if (lua_pcall(course, 0, 0, 0) != LUA_OK) {
        if (lua::interrupt_requested()) lua::raise_interrupted(L);
        lua::raise(L, "the lab course cannot be loaded: " + take_message(course));
    }
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

namespace {

/// The student number that the word is, for an option that is used as in the example.
text::Expected<std::int64_t> student_number(std::string_view number, std::string_view option,
                                            std::string_view example) {
    std::int64_t value = 0;
    const auto parsed = std::from_chars(number.data(), number.data() + number.size(), value);
    if (parsed.ec != std::errc() || parsed.ptr != number.data() + number.size() || !is_student_number(value)) {
        return text::Error{fmt::format(
            "option {} needs a student number after it, a whole one from 1 to {}, for example {}{}", option,
            greatest_student_number, example, number.empty() ? "" : fmt::format("; '{}' is not one", number))};
    }
    return value;
}

}  // namespace

text::Expected<std::string> lab_solutions(std::string_view number) {
    const auto value = student_number(number, "--lab-solutions", "--lab-solutions 4711");
    if (!value) return value.error();
    return text_of_course("solutions", *value);
}

text::Expected<LabStart> lab_start(const std::string& sheet, std::string_view number) {
    const auto value = student_number(number, "--lab", "--lab 1 4711 or --lab hoja-1 4711");
    if (!value) return value.error();
    auto texts = texts_of_course<3>("start", *value, sheet);
    if (!texts) return texts.error();
    return LabStart{(*texts)[0], (*texts)[1], (*texts)[2]};
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
Tries use_of_tries = Tries::read;       // the same
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
    if (tries_file == nullptr || use_of_tries == Tries::read) return;
    const auto file = files::Journal::open(tries_file());
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

void keep_lab_tries(std::string (*file)(), Tries use) {
    tries_file = file;
    use_of_tries = use;
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

// lab.NAME and check(question, value): the lab course as students see it. docs/lab has its sheets.

namespace {

constexpr std::size_t most_wrong = 12;  // so that no loop finds an answer that nobody has worked out

/// The answers to one question so far.
struct LabAnswer {
    lua_Integer number;  ///< of the student
    std::string question;
    bool right = false;
    int tries = 0;
    std::string said = {};
    std::vector<double> wrong = {};  ///< different values, those of earlier sessions among them
};

/// The place of a student: one for each Lua state, in its registry.
struct LabDesk {
    std::unique_ptr<LabCourse> course;
    lua_Integer number = 0;  // 0: not said yet
    std::vector<LabAnswer> answers;
};

const char desk_key = 0;

const lua::Class desk_class = {"lab desk", {"lab", "The place of a student.", ""}, {}};

LabDesk& desk_of(lua_State* L, const char* call) {
    lua::refuse_in_worker(L, call);  // each worker would have a desk of its own, and with it all tries again
    lua_rawgetp(L, LUA_REGISTRYINDEX, &desk_key);
    auto& desk = *lua::test<LabDesk>(L, -1);
    lua_pop(L, 1);  // the registry holds it
    if (desk.course == nullptr) {
        desk.course = std::make_unique<LabCourse>(L);
    }
    return desk;
}

/// The desk of a student who has given a number.
LabDesk& desk_with_number(lua_State* L, const char* call) {
    LabDesk& desk = desk_of(L, call);
    if (desk.number == 0) {
        lua::fail(L, call, {"first set your own student number, for example lab.number(4711)"});
    }
    return desk;
}

/// course.FUNCTION with so many arguments from the top of the stack, called for `call`. What it refuses is `culprit`.
int ask_course(lua_State* L, LabDesk& desk, const char* call, const char* function, int arguments,
               const std::string& culprit) {
    const auto results = desk.course->call(L, function, arguments);
    if (!results) {
        text::Error error = text::in_call(call, results.error());
        error.culprit = culprit;
        lua::raise(L, error);
    }
    return *results;
}

/// Who types a decimal comma gives one argument too many, and would not see that it is not looked at.
void refuse_more(lua_State* L, const char* call, const char* wanted, int most) {
    if (lua_gettop(L) > most) {
        lua::fail(L, call,
                  {.sentence = fmt::format("expects {}; after that comes {}", wanted, lua::written(L, most + 1)),
                   .culprit = lua::written(L, most + 1)});
    }
}

int lab_number(lua_State* L) {
    LabDesk& desk = desk_of(L, "lab.number");
    refuse_more(L, "lab.number", "a number and a language", 2);
    if (lua_gettop(L) > 0) {
        int is_whole = 0;
        const lua_Integer number = lua_tointegerx(L, 1, &is_whole);
        if (lua_type(L, 1) != LUA_TNUMBER || is_whole == 0 || !is_student_number(number)) {
            lua::raise_got(
                L, 1, "lab.number",
                fmt::format("lab.number: a student number is a whole number from 1 to {}", greatest_student_number),
                lua_isnumber(L, 1) != 0 && lua_type(L, 1) == LUA_TSTRING ? "; write it without quotes" : "");
        }
        if (lua_type(L, 2) != LUA_TSTRING && !lua_isnoneornil(L, 2)) {
            lua::raise_got(L, 2, "lab.number", "lab.number: the language is a word, such as \"es\"");
        }
        lua_settop(L, 2);
        lua_pushvalue(L, 2);
        ask_course(L, desk, "lab.number", "speak", 1, lua_isnil(L, 2) ? "" : lua_tostring(L, 2));
        desk.number = number;
    }
    desk.number == 0 ? lua_pushnil(L) : lua_pushinteger(L, desk.number);
    return 1;
}

/// course.FUNCTION(number, sheet, ...) with the sheet that stands at 1.
int of_sheet(lua_State* L, const char* call, const char* function, int arguments) {
    LabDesk& desk = desk_with_number(L, call);
    int is_whole = 0;
    const lua_Integer sheet = lua_tointegerx(L, 1, &is_whole);
    if (lua_type(L, 1) != LUA_TNUMBER || is_whole == 0) {
        lua::raise_got(L, 1, call, fmt::format("{}: the first argument is the number of a sheet", call),
                       fmt::format("; for example {}(1)", call));
    }
    lua_settop(L, arguments);
    lua_pushinteger(L, sheet);  // an integer: 1.0 is sheet 1, too
    lua_replace(L, 1);
    lua_pushinteger(L, desk.number);
    lua_insert(L, 1);
    return ask_course(L, desk, call, function, arguments + 1, std::to_string(sheet));
}

int lab_given(lua_State* L) {
    return of_sheet(L, "lab.given", "given", 1);
}

int lab_experiment(lua_State* L) {
    refuse_more(L, "lab.experiment", "a sheet and one number", 2);
    if (!lua_isnoneornil(L, 2)) {
        static_cast<void>(lua::finite_argument(L, 2, "lab.experiment(2, x): x"));
    }
    return of_sheet(L, "lab.experiment", "experiment", 2);
}

/// Adds a value to those that were wrong. False if it is already among them: trying it again tells nothing new.
bool add_wrong(LabAnswer& answer, double value) {
    if (std::find(answer.wrong.begin(), answer.wrong.end(), value) != answer.wrong.end()) return false;
    answer.wrong.push_back(value);
    return true;
}

LabAnswer& answer_of(LabDesk& desk, const std::string& question) {
    const auto found = std::find_if(desk.answers.begin(), desk.answers.end(), [&](const LabAnswer& answer) {
        return answer.number == desk.number && answer.question == question;
    });
    if (found != desk.answers.end()) return *found;
    LabAnswer& answer = desk.answers.emplace_back(LabAnswer{.number = desk.number, .question = question});
    for (const double value : earlier_wrong_values(desk.number, question)) add_wrong(answer, value);
    return answer;
}

/// The name of the question at 1 as the course writes it. Raises when there is none.
std::string question_at_1(lua_State* L, LabDesk& desk) {
    if (lua_type(L, 1) != LUA_TSTRING) {
        lua::raise_got(L, 1, "check", "check: the first argument is the name of a question",
                       "; for example check(\"1a\", 3.2)");
    }
    lua_pushinteger(L, desk.number);
    lua_pushvalue(L, 1);
    ask_course(L, desk, "check", "name", 2, lua_tostring(L, 1));
    std::string name = lua_tostring(L, -1);
    lua_pop(L, 1);
    return name;
}

double value_at_2(lua_State* L) {
    if (lua_type(L, 2) != LUA_TNUMBER) {
        lua::raise_got(L, 2, "check", "check: the answer is a number",
                       lua_isnumber(L, 2) != 0 ? "; write it without quotes" : "; for example check(\"1a\", 3.2)");
    }
    return lua::finite_argument(L, 2, "check: the answer");
}

bool is_judged(const LabAnswer& answer, double value) {
    return answer.right || answer.wrong.size() < most_wrong ||
           std::find(answer.wrong.begin(), answer.wrong.end(), value) != answer.wrong.end();
}

/// The sentence of the course about a question, in the language of the student: a format with the values on the top of
/// the stack, the first of which is the name of the question.
std::string said_by_course(lua_State* L, LabDesk& desk, const std::string& question, const char* sentence, int values) {
    const int first = lua_gettop(L) - values + 1;
    lua_pushinteger(L, std::strtoll(question.c_str(), nullptr, 10));
    lua_insert(L, first);
    lua_pushstring(L, sentence);
    lua_insert(L, first + 1);
    ask_course(L, desk, "check", "say", values + 2, question);
    std::string said = lua_tostring(L, -1);
    lua_pop(L, 1);
    return said;
}

/// Lets the course judge, notes the verdict, and returns what to print.
std::string judged(lua_State* L, LabDesk& desk, const std::string& question, double value) {
    if (!is_judged(answer_of(desk, question), value)) {
        lua::push_text(L, question);
        lua_pushinteger(L, most_wrong);
        lua_pushinteger(L, desk.number);
        return said_by_course(
            L, desk, question,
            "%s: not judged, because %d different values were wrong for number %d. Do the task again, "
            "or ask your instructor",
            3);
    }
    lua_pushinteger(L, desk.number);
    lua::push_text(L, question);
    lua_pushnumber(L, value);
    ask_course(L, desk, "check", "judge", 3, question);
    const bool right = lua_toboolean(L, -2) != 0;
    LabAnswer& answer = answer_of(desk, question);
    const std::string said = lua_tostring(L, -1);
    if (answer.right) {  // what lab.marks() shows stays that of the answer that counts
        if (right) return said;
        lua_pushvalue(L, -1);
        return said_by_course(L, desk, question, "%s (an earlier answer was right, and counts)", 1);
    }
    answer.said = said;
    answer.right = right;
    if (right || add_wrong(answer, value) || answer.tries == 0) {
        ++answer.tries;
        note_lab_mark({desk.number, question, right ? "right" : "wrong", answer.tries, value, answer.said});
    }
    return answer.said;
}

int check_answer(lua_State* L) {
    LabDesk& desk = desk_with_number(L, "check");
    refuse_more(L, "check", "a question and one value", 2);
    lua_settop(L, 2);
    const std::string question = question_at_1(L, desk);
    const std::string said = judged(L, desk, question, value_at_2(L)) + "\n";
    terminal::make_way_for_output(true);
    lua_writestring(said.data(), said.size());  // as print() does
    return 0;
}

int lab_marks(lua_State* L) {
    LabDesk& desk = desk_with_number(L, "lab.marks");
    std::vector<LabAnswer> answers = desk.answers;
    std::erase_if(answers, [&](const LabAnswer& a) { return a.tries == 0 || a.number != desk.number; });
    std::sort(answers.begin(), answers.end(),
              [](const LabAnswer& a, const LabAnswer& b) { return a.question < b.question; });
    const auto right = std::count_if(answers.begin(), answers.end(), [](const LabAnswer& a) { return a.right; });
    Data data = table_of(answers, ListColumn{"question", &LabAnswer::question},
                         ListColumn{"verdict", [](const LabAnswer& a) { return a.right ? "right" : "wrong"; }},
                         ListColumn{"tries", &LabAnswer::tries}, ListColumn{"said", &LabAnswer::said});
    data.heading = fmt::format("number {}: {} of {} right", desk.number, right, answers.size());
    return push_data(L, std::move(data));
}

constexpr lua::Member lab_module_members[] = {
    {lua::a_function<lab_number>,
     {"lab.number(n, language) -> number",
      "Sets the student number, a whole number from 1 to 999999999. The systems of the sheets "
      "and the right answers depend on it. With a language, such as \"es\", verdicts and hints are in that language. "
      "lab.number() returns the number, nil if none was set.",
      "lab.number(4711)\nprint(lab.number())  --> 4711"}},
    {lua::a_function<lab_given>,
     {"lab.given(sheet) -> table", "The data of that sheet for this student; the sheet explains them.",
      "lab.number(4711)\nprint(system(lab.given(1).viscous).Rd)  --> 0.0"}},
    {lua::a_function<lab_experiment>,
     {"lab.experiment(sheet, x) -> data",
      "Performs the experiment of the sheet and returns its record. x, a number, is the setting "
      "of the bench; the sheet explains it, if there is one.",
      "lab.number(4711)\nprint(table.concat(lab.experiment(1).names, \" \"))  --> t theta"}},
    {lua::a_function<lab_marks>,
     {"lab.marks() -> data",
      "Your answers so far: question, verdict, number of tries, and what was said about the answer that counts.",
      "lab.number(4711)\ncheck(\"0\", 42)\nprint(lab.marks().verdict[1])  --> right"}},
};

constexpr lua::Member check_members[] = {
    {lua::a_function<check_answer>,
     {"check(question, value)",
      "Prints whether an answer in the lab is right, or the probable mistake; never the answer. "
      "The tolerance depends on the method. After twelve different wrong values a question is no "
      "longer judged; they are kept from session to session, except in safe mode. Question \"0\" is for trying it "
      "out: six times seven.",
      "lab.number(4711)\ncheck(\"0\", 42)"}},
};

}  // namespace

const lua::Class lab_module = {
    "lab",
    {"lab.NAME(...)",
     "The lab course: seven sheets of two hours each, in docs/lab and, in Spanish, docs/es. Systems differ by student "
     "number, and check(question, value) judges answers.",
     "lab.number(4711)\nprint(lab.given(1).theta0 > 0)  --> true"},
    lab_module_members};

const lua::Class check_functions = {
    "check",
    {"check(question, value)", "Judges an answer in the lab.", "lab.number(4711)\ncheck(\"0\", 42)"},
    check_members};

std::int64_t lab_number_of(lua_State* L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &desk_key);
    const auto* desk = lua::test<LabDesk>(L, -1);
    lua_pop(L, 1);
    return desk == nullptr ? 0 : desk->number;
}

void register_lab(lua_State* L) {
    lua::add_class<LabDesk>(L, desk_class);
    lua::push(L, LabDesk{});
    lua_rawsetp(L, LUA_REGISTRYINDEX, &desk_key);
    lua::add_module(L, lab_module);
    lua::add_functions(L, check_functions);
}

}  // namespace dinal::lab
