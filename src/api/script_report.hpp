// --report: what a script prints and draws becomes a page to hand in.
#pragma once

#include <string>

#include "api/report.hpp"
#include "text/expected.hpp"

namespace dinal::api {

/// While it lives, what is printed on standard output and the pictures that are shown go into a report, in their order.
class ScriptReport {
public:
    /// The script, and what it says on standard error, which is collected elsewhere meanwhile.
    ScriptReport(std::string script, const std::string& errors);
    ~ScriptReport();
    ScriptReport(const ScriptReport&) = delete;
    ScriptReport& operator=(const ScriptReport&) = delete;

    /// Writes it into the current folder: lab.html for ../lab.lua, with the script and what went wrong, if anything, at
    /// its end. Returns the name. Standard output is what it was from then on.
    text::Expected<std::string> save();

private:
    void take_printed();
    void give_back();

    Report report_;
    std::string script_;
    const std::string& errors_;
    int output_;   // the standard output of before
    int printed_;  // a file without a name
    std::size_t taken_ = 0;
};

}  // namespace dinal::api
