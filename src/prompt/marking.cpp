#include "prompt/marking.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "files/file.hpp"
#include "lab/lab_course.hpp"
#include "lua/lua_text.hpp"
#include "lua/safe_mode.hpp"
#include "prompt/output.hpp"
#include "prompt/script.hpp"
#include "prompt/user_files.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::prompt {
namespace {

namespace fs = std::filesystem;

constexpr double grace = 5;                          // seconds for a stopped script to write its page
constexpr rlim_t largest_file = 10'000'000;          // bytes: limits the output of a hand-in
constexpr std::uintmax_t largest_desk = 50'000'000;  // limits its files
constexpr std::uintmax_t largest_script = 1'000'000;
constexpr std::size_t longest_name = 60;
constexpr int deepest_folder = 3;

struct Answer {
    bool right = false;
    int tries = 0;
    std::string said;  ///< the remark on the first wrong value
};

struct HandIn {
    fs::path file;
    std::string name;                                               ///< as shown in the table
    std::string text;                                               ///< the script
    std::map<std::int64_t, std::map<std::string, Answer>> answers;  ///< by student number and question
    std::int64_t number = 0;                                        ///< the number whose answers count; 0: none
    std::vector<std::string> remarks;
};

// ---- running the scripts

/// A file name without special characters.
std::string safe_name(const std::string& name) {
    std::string plain;
    for (const char c : name.substr(0, longest_name)) {
        plain += text::is_name_char(c) || c == '-' || c == '.' ? c : '_';
    }
    return plain;
}

/// All scripts in the folder and its subfolders, sorted by name. Does not follow links.
std::vector<HandIn> hand_ins_of(const fs::path& folder) {
    std::vector<HandIn> all;
    std::error_code wrong;
    fs::recursive_directory_iterator place(folder, fs::directory_options::skip_permission_denied, wrong);
    for (; !wrong && place != fs::recursive_directory_iterator(); place.increment(wrong)) {
        if (place.depth() >= deepest_folder) place.disable_recursion_pending();
        if (text::ending_of(place->path().string()) != ".lua") continue;
        if (place->path().filename().string().starts_with("._")) continue;  // archives made by macOS have them
        HandIn& hand_in = all.emplace_back();
        hand_in.file = place->path();
        hand_in.name = text::displayable(place->path().lexically_relative(folder).string());
    }
    std::ranges::sort(all, {}, &HandIn::file);
    return all;
}

/// Runs in the child: sets limits, streams and folder of a hand-in, then executes the program.
[[noreturn]] void become_hand_in(const std::string& desk, std::vector<std::string>& words) {
    ::setpgid(0, 0);
    const rlimit file_size{largest_file, largest_file};
    ::setrlimit(RLIMIT_FSIZE, &file_size);
    const int input = ::open("/dev/null", O_RDONLY);
    const int output = ::chdir(desk.c_str()) == 0 ? ::open("output.txt", O_WRONLY | O_CREAT | O_TRUNC, 0644) : -1;
    if (input < 0 || output < 0) ::_exit(exit_code::usage);
    ::dup2(input, STDIN_FILENO);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    ::execv("/proc/self/exe", pointers.data());
    ::_exit(exit_code::usage);
}

std::uintmax_t size_of_files(const fs::path& folder) {
    std::uintmax_t sum = 0;
    std::error_code wrong;
    for (fs::recursive_directory_iterator place(folder, wrong); !wrong && place != fs::recursive_directory_iterator();
         place.increment(wrong)) {
        std::error_code vanished;
        const std::uintmax_t size = place->is_regular_file(vanished) ? place->file_size(vanished) : 0;
        sum += vanished ? 0 : size;
    }
    return sum;
}

struct Ending {
    std::optional<int> status;  ///< exit status of the child; none if killed
    bool filled = false;        ///< whether it was killed because of the size of its folder
};

Ending wait_for(pid_t child, double seconds, const fs::path& desk) {
    constexpr int checks_a_second = 500, checks_between_sizes = 50;
    const auto latest = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    int status = 0;
    Ending ending;
    for (int check = 1; !ending.status && !ending.filled && std::chrono::steady_clock::now() < latest; ++check) {
        if (::waitpid(child, &status, WNOHANG) == child) {
            ending.status = status;
        } else {
            std::this_thread::sleep_for(std::chrono::seconds(1) / checks_a_second);
            ending.filled = check % checks_between_sizes == 0 && size_of_files(desk) > largest_desk;
        }
    }
    ::kill(-child, SIGKILL);  // with all processes it has started
    if (!ending.status) ::waitpid(child, &status, 0);
    return ending;
}

std::string first_error(const std::string& desk) {
    const auto output = files::read_file(desk + "/output.txt");
    const std::string text = output ? *output : "";
    const std::size_t at = text.rfind("\ndinal: ");
    const std::string line = at != std::string::npos       ? text.substr(at + 8)
                             : text.starts_with("dinal: ") ? text.substr(7)
                                                           : "ended with an error";
    constexpr std::size_t longest_line = 100;
    const std::string shown = text::displayable(text::cut_to_columns(line.substr(0, line.find('\n')), longest_line));
    return shown.ends_with("File too large") ? shown + " (a file may have 10 MB)" : shown;
}

std::optional<std::string> fault_of(const Ending& ending, const std::string& desk) {
    const std::optional<int> status = ending.status;
    if (ending.filled) return "wrote more than 50 MB in all and was killed";
    if (!status) return "did not end and was killed";
    if (WIFSIGNALED(*status)) return WTERMSIG(*status) == SIGXFSZ ? "wrote more than 10 MB" : "was ended by the system";
    return WEXITSTATUS(*status) == exit_code::ok ? std::nullopt : std::optional(first_error(desk));
}

// ---- reading the marks

/// The words of a line of --lab-marks after the script's name, which contains no quotes: number, question, verdict,
/// tries, value, hint.
std::vector<std::string> words_of(std::string_view line) {
    std::vector<std::string> words;
    std::size_t at = line.find("\",");
    at = at == std::string::npos ? line.size() : at + 2;
    for (int i = 0; i < 5 && at < line.size(); ++i) {
        const std::size_t end = std::min(line.find(',', at), line.size());
        words.emplace_back(line.substr(at, end - at));
        at = end + 1;
    }
    if (at < line.size()) words.emplace_back(text::trimmed(line.substr(at), "\""));
    return words;
}

void read_marks(HandIn& hand_in, const std::string& file) {
    const auto lines = files::read_file(file);
    const std::string text = lines ? *lines : "";
    for (const std::string_view line : text::split(text, '\n')) {
        const auto words = words_of(line);
        if (words.size() < 6 || words[2] == "begun" || words[1] == "0") continue;
        Answer& answer = hand_in.answers[std::strtoll(words[0].c_str(), nullptr, 10)][words[1]];
        answer.right = words[2] == "right";
        answer.tries = static_cast<int>(std::strtol(words[3].c_str(), nullptr, 10));
        if (!answer.right && answer.said.empty()) {
            answer.said = words[5].substr(std::min(words[5].find(": ") + 2, words[5].size()));
        }
    }
}

/// The numbers of four or more digits in a file name, one of which is probably the student's.
std::set<std::int64_t> numbers_in(const std::string& name) {
    std::set<std::int64_t> numbers;
    for (std::size_t at = 0; at < name.size();) {
        std::size_t end = at;
        while (end < name.size() && text::is_digit(name[end])) ++end;
        std::int64_t number = 0;
        if (end - at >= 4 && end - at <= 9) std::from_chars(name.data() + at, name.data() + end, number);
        if (number > 0) numbers.insert(number);
        at = end + 1;
    }
    return numbers;
}

/// Chooses the student number: the one in the file name, otherwise the one with most answers.
void choose_number(HandIn& hand_in) {
    const auto named = numbers_in(hand_in.name);
    std::size_t most = 0;
    for (const auto& [number, answers] : hand_in.answers) {
        const std::size_t weight = answers.size() + (named.contains(number) ? 1000 : 0);
        if (weight > most) hand_in.number = number;
        most = std::max(most, weight);
    }
    if (hand_in.number == 0) {
        hand_in.remarks.emplace_back("no answer was checked");
    } else if (const auto in_name = numbers_in(hand_in.file.filename().string());
               !in_name.empty() && !named.contains(hand_in.number)) {
        hand_in.remarks.push_back(
            fmt::format("uses number {}, but its name says {}", hand_in.number, *in_name.begin()));
    }
    for (const auto& [number, answers] : hand_in.answers) {
        if (number != hand_in.number)
            hand_in.remarks.push_back(fmt::format("also uses number {}, which is not counted", number));
    }
}

std::string sheet_of(std::string_view question) {
    return std::string(question.substr(0, question.find_first_not_of("0123456789")));
}

std::set<std::string> sheets_of(const HandIn& hand_in) {
    std::set<std::string> sheets;
    const auto found = hand_in.answers.find(hand_in.number);
    if (found != hand_in.answers.end()) {
        for (const auto& [question, answer] : found->second) sheets.insert(sheet_of(question));
    }
    return sheets;
}

/// The parts of a script by which copies are recognised.
struct Essence {
    std::string code;                     ///< without comments, blanks, number, author and prose
    std::vector<std::string> paragraphs;  ///< paragraphs of prose, as words without punctuation and capitals
};

/// Adds the paragraphs of a string that have enough words to be recognised and are not a question of the handout.
void add_paragraphs(std::string_view text, std::vector<std::string>& paragraphs) {
    constexpr std::ptrdiff_t fewest_words = 8;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find("\n\n"), text.size());
        std::string words;
        for (const char c : text.substr(0, end)) {
            const bool letter = text::is_name_char(c) || static_cast<unsigned char>(c) > 127;
            if (letter) words += text::lower(c);
            if (!letter && !words.empty() && words.back() != ' ') words += ' ';
        }
        const bool asks = text::trimmed(text.substr(0, end)).ends_with('?');
        if (!asks && std::ranges::count(words, ' ') >= fewest_words) paragraphs.push_back(words);
        text.remove_prefix(std::min(end + 2, text.size()));
    }
}

Essence essence_of(const HandIn& hand_in) {
    const lua::Tokens all = lua::tokens(hand_in.text);
    Essence essence;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool number = i > 1 && all[i - 2].is("number") && all[i - 1].is("(");
        const bool author = i > 1 && all[i - 2].is("author") && all[i - 1].is("=");
        if (all[i].kind == lua::TokenKind::comment || number || author) continue;
        const bool prose = all[i].kind == lua::TokenKind::string && all[i].text.starts_with('[');
        if (prose) add_paragraphs(all[i].text, essence.paragraphs);
        if (!prose) essence.code += fmt::format("{}\n", all[i].text);
    }
    return essence;
}

/// Reports code and paragraphs that an earlier hand-in has as well.
void compare_texts(std::vector<HandIn>& all) {
    std::map<std::string, const HandIn*> codes, paragraphs;
    for (HandIn& hand_in : all) {
        const Essence essence = essence_of(hand_in);
        const auto [same, is_new] = codes.emplace(essence.code, &hand_in);
        if (!is_new && !essence.code.empty()) {
            hand_in.remarks.push_back("the same lines of Lua as " + same->second->name);
        }
        std::set<std::string> others;
        for (const std::string& paragraph : essence.paragraphs) {
            const HandIn* const other = paragraphs.emplace(paragraph, &hand_in).first->second;
            if (other != &hand_in) others.insert(other->name);
        }
        for (const std::string& other : others) hand_in.remarks.push_back("prose in the same words as " + other);
    }
}

/// Reports sheets that one student has handed in twice.
void compare_sheets(std::vector<HandIn>& all) {
    std::map<std::string, const HandIn*> first;  // by number and sheet
    for (HandIn& hand_in : all) {
        for (const std::string& sheet : sheets_of(hand_in)) {
            const auto [other, is_new] = first.emplace(fmt::format("{}/{}", hand_in.number, sheet), &hand_in);
            if (!is_new)
                hand_in.remarks.push_back(
                    fmt::format("sheet {} of this number is also in {}", sheet, other->second->name));
        }
    }
}

// ---- the table

using Rows = std::vector<std::vector<std::string>>;

/// "+": right at once; a number: right after this number of tries; "-": wrong; ".": not tried; "": on another sheet.
std::string sign_of(const HandIn& hand_in, const std::string& question) {
    const auto answers = hand_in.answers.find(hand_in.number);
    if (answers == hand_in.answers.end()) return "";
    const auto found = answers->second.find(question);
    if (found == answers->second.end()) return sheets_of(hand_in).contains(sheet_of(question)) ? "." : "";
    if (!found->second.right) return "-";
    return found->second.tries == 1 ? "+" : fmt::format("{}", found->second.tries);
}

/// The questions of all sheets that anybody has tried.
std::vector<std::string> questions_of(const std::vector<HandIn>& all, const std::string& names) {
    std::set<std::string> tried;
    for (const HandIn& hand_in : all) tried.merge(sheets_of(hand_in));
    std::vector<std::string> questions;
    for (const std::string_view name : text::split(names, ' ')) {
        if (tried.contains(sheet_of(name))) questions.emplace_back(name);
    }
    return questions;
}

Rows table_of(const std::vector<HandIn>& all, const std::vector<std::string>& questions) {
    Rows rows{{"hand-in", "number"}};
    rows[0].insert(rows[0].end(), questions.begin(), questions.end());
    rows[0].insert(rows[0].end(), {"right", "remark"});
    for (const HandIn& hand_in : all) {
        std::vector<std::string> row{hand_in.name, hand_in.number == 0 ? "none" : fmt::format("{}", hand_in.number)};
        int right = 0, asked = 0;
        for (const std::string& question : questions) {
            row.push_back(sign_of(hand_in, question));
            asked += row.back().empty() ? 0 : 1;
            right += row.back().empty() || row.back() == "." || row.back() == "-" ? 0 : 1;
        }
        row.push_back(asked == 0 ? "" : fmt::format("{} of {}", right, asked));
        row.push_back(fmt::format("{}", fmt::join(hand_in.remarks, "; ")));
        rows.push_back(std::move(row));
    }
    return rows;
}

/// The summary: the success of each question, and its most frequent hint.
Rows summary_of(const std::vector<HandIn>& all, const std::vector<std::string>& questions) {
    Rows rows{{"question", "tried", "right", "at once", "most frequent hint"}};
    for (const std::string& question : questions) {
        int tried = 0, right = 0, at_once = 0;
        std::map<std::string, int> hints;
        for (const HandIn& hand_in : all) {
            const auto answers = hand_in.answers.find(hand_in.number);
            if (answers == hand_in.answers.end() || !answers->second.contains(question)) continue;
            const Answer& answer = answers->second.at(question);
            ++tried;
            right += answer.right ? 1 : 0;
            at_once += answer.right && answer.tries == 1 ? 1 : 0;
            if (!answer.said.empty()) ++hints[answer.said];
        }
        const auto most =
            std::ranges::max_element(hints, [](const auto& a, const auto& b) { return a.second < b.second; });
        rows.push_back({question, fmt::format("{}", tried), fmt::format("{}", right), fmt::format("{}", at_once),
                        most == hints.end() ? "" : fmt::format("{}x {}", most->second, most->first)});
    }
    return rows;
}

/// The rows as aligned columns.
std::string aligned(const Rows& rows) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], text::columns(row[i]));
    }
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            line += row[i];
            if (i + 1 < row.size()) line += std::string(widths[i] - text::columns(row[i]) + 2, ' ');
        }
        text += std::string(text::trimmed(line, "", " ")) + "\n";
    }
    return text;
}

std::string csv_of(const Rows& rows) {
    std::string text;
    for (const auto& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            // Spreadsheets interpret such a text as a formula, and students choose the names of hand-ins.
            const bool formula =
                row[i].size() > 1 && std::string_view("=+-@").find(row[i][0]) != std::string_view::npos;
            std::string field = (formula ? "'" : "") + row[i];
            for (std::size_t at = field.find('"'); at != std::string::npos; at = field.find('"', at + 2))
                field.insert(at, 1, '"');
            text += (i == 0 ? "\"" : ",\"") + field + "\"";
        }
        text += "\n";
    }
    return text;
}

// ---- the whole marking

struct Marking {
    fs::path folder;  ///< hand-ins, absolute path
    fs::path marked;  ///< FOLDER-marked
    fs::path sheets;  ///< --sheets
    double seconds;   ///< time limit of a script
};

void run_hand_in(const Marking& marking, HandIn& hand_in, std::size_t index) {
    std::error_code wrong;
    if (fs::symlink_status(hand_in.file, wrong).type() != fs::file_type::regular ||
        fs::file_size(hand_in.file, wrong) > largest_script) {
        hand_in.remarks.emplace_back("not run: it is not a file of at most 1 MB");
        return;
    }
    if (const auto text = files::read_file(hand_in.file.string())) hand_in.text = *text;
    const std::string stem = safe_name(hand_in.file.stem().string());
    const fs::path desk = marking.marked / fmt::format("{:03}-{}", index, stem);
    const std::string marks = (marking.marked / "marks.tmp").string(), script = stem + ".lua";
    fs::create_directory(desk, wrong);
    fs::copy_file(hand_in.file, desk / script, wrong);
    if (wrong) {
        hand_in.remarks.push_back("not run: " + wrong.message());
        return;
    }
    std::vector<std::string> words{"dinal", "--report", fmt::format("--max-time={}", marking.seconds),
                                   "--lab-marks=" + marks};
    if (!marking.sheets.empty()) words.push_back("--sheets=" + marking.sheets.string());
    words.insert(words.end(), {"--", script});
    const pid_t child = ::fork();
    if (child == 0) become_hand_in(desk.string(), words);
    const auto ending = child < 0 ? Ending{} : wait_for(child, lua::longest_wait * marking.seconds + grace, desk);
    if (auto fault = fault_of(ending, desk.string())) hand_in.remarks.push_back(std::move(*fault));
    read_marks(hand_in, marks);
    fs::remove(marks, wrong);
}

/// Makes FOLDER-marked empty; returns an error if that fails.
std::optional<std::string> empty_folder(const fs::path& marked) {
    std::error_code wrong;
    const bool there = fs::exists(fs::symlink_status(marked, wrong));
    if (there && !fs::exists(marked / "marks.csv") && !fs::is_empty(marked, wrong)) {
        return "it exists and is not the result of an earlier marking: move it away";
    }
    fs::remove_all(marked, wrong);
    fs::create_directory(marked, wrong);
    return wrong ? std::optional(wrong.message()) : std::nullopt;
}

int fail(const std::string& sentence) {
    complain("--mark: " + sentence);
    return exit_code::script_error;
}

}  // namespace

std::string other_number(const std::string& file, std::int64_t used) {
    const std::string name = std::filesystem::path(file).filename().string();
    const std::set<std::int64_t> named = numbers_in(name);
    return used == 0 || named.empty() || named.contains(used)
               ? ""
               : fmt::format("{} uses number {}, but its name says {}", name, used, *named.begin());
}

int mark(const Arguments& arguments) {
    std::error_code wrong;
    const std::string shown = text::displayable(arguments.student);
    if (arguments.student.empty() || !fs::is_directory(arguments.student, wrong)) {
        return fail(fmt::format("'{}' is not a folder; for example dinal --mark hand-ins", shown));
    }
    const auto names = lab::lab_question_names();
    if (!names) return fail(names.error().message());
    fs::path folder = fs::absolute(arguments.student).lexically_normal();
    if (!folder.has_filename()) folder = folder.parent_path();
    const Marking marking{folder, folder.string() + "-marked",
                          arguments.sheets.empty() ? fs::path() : fs::absolute(arguments.sheets),
                          arguments.limits.seconds > 0 ? arguments.limits.seconds : lua::safe_limits.seconds};
    std::vector<HandIn> all = hand_ins_of(folder);
    if (all.empty()) return fail(fmt::format("there is no .lua file in '{}'", shown));
    if (const auto reason = empty_folder(marking.marked)) {
        return fail(fmt::format("cannot use '{}': {}", text::displayable(marking.marked.string()), *reason));
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
        run_hand_in(marking, all[i], i + 1);
        choose_number(all[i]);
    }
    compare_texts(all);
    compare_sheets(all);
    const auto questions = questions_of(all, *names);
    const Rows table = table_of(all, questions);
    say(aligned(table));
    std::set<std::int64_t> students;
    std::size_t remarks = 0;
    for (const HandIn& hand_in : all) {
        if (hand_in.number > 0) students.insert(hand_in.number);
        remarks += hand_in.remarks.empty() ? 0 : 1;
    }
    say(fmt::format("\n{} of {}, {} with a remark\n", text::counted(all.size(), "hand-in"),
                    text::counted(students.size(), "student"), remarks));
    if (!questions.empty()) say("\n" + aligned(summary_of(all, questions)));
    if (const auto written = files::write_file((marking.marked / "marks.csv").string(), csv_of(table)); !written) {
        return fail(written.error().message());
    }
    say(fmt::format("\nmarks.csv and the pages are in {}\n", text::displayable(marking.marked.string())));
    return exit_code::ok;
}

// NOTE: the instructor's file is the built-in text itself. Its owner can read the answers in it anyway, and nobody else
// can create it.
text::Expected<std::string> solutions_of(const std::string& student) {
    const std::string file = lab_course_file();
    const auto text = files::read_file(file);
    if (!text) {
        return text::Error{"--lab-solutions is for instructors: it needs their file " +
                           (file.empty() ? "~/.config/dinal/lab-course.lua" : file) + " (docs/lab/instructor.md)"};
    }
    if (*text != lab::lab_course_text()) {
        return text::Error{file + " is not the course of this program: make it again, as docs/lab/instructor.md says"};
    }
    return lab::lab_solutions(student);
}

text::Expected<std::string> start_script(const Arguments& arguments) {
    const auto start =
        lab::lab_start(arguments.student, arguments.has_script() ? arguments.words[arguments.script] : "");
    if (!start) return start.error();
    std::error_code wrong;
    if (fs::exists(fs::symlink_status(start->file, wrong))) {
        return text::error("{} exists already: move it away to begin again", start->file);
    }
    if (const auto written = files::write_file(start->file, start->text); !written) return written.error();
    return start->said + "\n";
}

std::optional<text::Error> add_sheets(const std::string& folder) {
    std::error_code wrong;
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder, wrong)) {
        const std::string name = entry.path().filename();
        if (text::ending_of(name) == ".lua" && name != "template.lua") names.push_back(entry.path());
    }
    if (wrong || names.empty()) {
        return text::Error{"--sheets: there is no sheet in '" + folder + "'" + (wrong ? ": " + wrong.message() : "")};
    }
    std::ranges::sort(names);
    std::vector<lab::LabSheet> sheets;
    for (const std::string& name : names) {
        auto text = files::read_file(name);
        if (!text) return text.error();
        sheets.push_back({name, std::move(text).value()});
    }
    lab::add_lab_sheets(std::move(sheets));
    return std::nullopt;
}

text::Expected<std::string> test_sheet(const std::string& file) {
    auto text = files::read_file(file);
    if (!text) return text.error();
    lab::add_lab_sheets({{file, std::move(text).value()}});
    auto tested = lab::lab_sheet_test();
    if (!tested) return tested.error();
    std::string seen = std::move(tested).value();
    const std::string name = fs::path(file).filename().string();
    const std::string digits = name.substr(0, name.find_first_not_of("0123456789"));
    const std::string number = seen.substr(6, seen.find(':') - 6);  // from "Sheet 8: its title, ..."
    if (!digits.empty() && digits != number) {
        seen +=
            fmt::format("{} holds sheet {}: change the name or the number in sheet({}, ...\n", name, number, number);
    }
    return seen;
}

}  // namespace dinal::prompt
