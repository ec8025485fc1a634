// lab.NAME and check(question, value): the lab course as students see it. docs/lab has its sheets.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/lab_course.hpp"
#include "lua/worker_state.hpp"
#include "terminal/progress.hpp"

namespace dinal::api {
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
        lua::raise(
            L, {.sentence = fmt::format("{}: first set your own student number, for example lab.number(4711)", call),
                .call = call});
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
        lua::raise(
            L, {.sentence = fmt::format("{}: expects {}; after that comes {}", call, wanted, lua::written(L, most + 1)),
                .call = call,
                .culprit = lua::written(L, most + 1)});
    }
}

int lab_number(lua_State* L) {
    LabDesk& desk = desk_of(L, "lab.number");
    refuse_more(L, "lab.number", "one number", 1);
    if (lua_gettop(L) > 0) {
        int is_whole = 0;
        const lua_Integer number = lua_tointegerx(L, 1, &is_whole);
        if (lua_type(L, 1) != LUA_TNUMBER || is_whole == 0 || !is_student_number(number)) {
            lua::raise_got(
                L, 1, "lab.number",
                fmt::format("lab.number: a student number is a whole number from 1 to {}", greatest_student_number),
                lua_isnumber(L, 1) != 0 && lua_type(L, 1) == LUA_TSTRING ? "; write it without quotes" : "");
        }
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

/// Lets the course judge, notes the verdict, and returns what to print.
std::string judged(lua_State* L, LabDesk& desk, const std::string& question, double value) {
    if (!is_judged(answer_of(desk, question), value)) {
        return fmt::format(
            "{}: not judged, because {} different values were wrong for number {}. Do the task again, or ask your "
            "instructor",
            question, most_wrong, desk.number);
    }
    lua_pushinteger(L, desk.number);
    lua::push_text(L, question);
    lua_pushnumber(L, value);
    ask_course(L, desk, "check", "judge", 3, question);
    const bool right = lua_toboolean(L, -2) != 0;
    LabAnswer& answer = answer_of(desk, question);
    answer.said = lua_tostring(L, -1);
    if (answer.right) {
        if (!right) answer.said += " (an earlier answer was right, and counts)";
        return answer.said;
    }
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
    std::vector<std::string> questions, verdicts, said;
    std::vector<double> tries;
    for (const LabAnswer& answer : answers) {
        questions.push_back(answer.question);
        verdicts.emplace_back(answer.right ? "right" : "wrong");
        tries.push_back(answer.tries);
        said.push_back(answer.said);
    }
    const auto right = std::count_if(answers.begin(), answers.end(), [](const LabAnswer& a) { return a.right; });
    Data data;
    data.columns = {column_of("question", std::move(questions)), column_of("verdict", std::move(verdicts)),
                    column_of("tries", std::move(tries)), column_of("said", std::move(said))};
    data.heading = fmt::format("number {}: {} of {} right", desk.number, right, answers.size());
    push_data(L, std::move(data));
    return 1;
}

constexpr lua::Member lab_module_members[] = {
    {lua::a_function<lab_number>,
     {"lab.number(n) -> number",
      "Sets the student number, a whole number from 1 to 999999999. The systems of the sheets "
      "and the right answers depend on it. lab.number() returns it, nil if none was set.",
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
     {"lab.marks() -> data", "Your answers so far: question, verdict, number of tries, and the last message.",
      "lab.number(4711)\ncheck(\"0\", 42)\nprint(lab.marks().verdict[1])  --> right"}},
};

constexpr lua::Member check_members[] = {
    {lua::a_function<check_answer>,
     {"check(question, value)",
      "Prints whether an answer in the lab is right, or the probable mistake; never the answer. "
      "The tolerance depends on the method. After twelve different wrong values a question is no "
      "longer judged; they are kept from session to session. Question \"0\" is for trying it "
      "out: six times seven.",
      "lab.number(4711)\ncheck(\"0\", 42)"}},
};

}  // namespace

const lua::Class lab_module = {
    "lab",
    {"lab.NAME(...)",
     "The lab course: seven sheets of two hours each, in docs/lab. Systems differ by student "
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

}  // namespace dinal::api
